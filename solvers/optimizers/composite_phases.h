#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "solvers/optimizers/box.h"
#include "solvers/optimizers/generations.h"
#include "solvers/optimizers/paired_choice.h"

namespace coppice {

// What a composite does after its members, each as a search of its own.

/// The final choice as a search.
class FinalChoice : public Generations {
 public:
  FinalChoice(const SearchTask& task, const Matrix& points, std::uint64_t first_scenario)
      : Generations(task), choice_(points, task.budget, first_scenario) {}
  std::vector<double> best() const override { return choice_.best_point(); }
  double best_value() const override { return choice_.best_value(); }

 protected:
  Candidates next_generation(std::int64_t) override { return choice_.next_round(); }
  void learn(const Candidates&, std::span<const double> values) override { choice_.learn(values); }
  void save_method(Archive& archive) const override { choice_.save(archive); }
  void load_method(Archive& archive) override { choice_.load(archive, dimension()); }

 private:
  PairedChoice choice_;
};

/// Uniform points: what is left over when no member can make use of it.
class Rest : public Generations {
 public:
  explicit Rest(const SearchTask& task) : Generations(task), best_(first_point(task)) {}
  std::vector<double> best() const override { return best_; }
  double best_value() const override { return best_value_; }

 protected:
  Candidates next_generation(std::int64_t left) override {
    Candidates generation{Matrix(static_cast<std::size_t>(left), dimension()), {}};
    Stream stream = task().draws.stream("rest");
    for (std::size_t i = 0; i < generation.points.rows(); ++i) {
      generation.points.set_row(i, uniform_point(task().box, stream));
    }
    generation.scenarios.assign(generation.points.rows(), 0);
    return generation;
  }
  void learn(const Candidates& generation, std::span<const double> values) override {
    const auto row = std::max_element(values.begin(), values.end()) - values.begin();
    generation.points.row(static_cast<std::size_t>(row), best_);
    best_value_ = values[static_cast<std::size_t>(row)];
  }
  void save_method(Archive&) const override {}  // one generation: what it learned ended it
  void load_method(Archive&) override {}

 private:
  std::vector<double> best_;
  double best_value_ = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace coppice
