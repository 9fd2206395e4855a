#include <algorithm>
#include <cmath>
#include <limits>

#include "solvers/optimizers/box.h"
#include "solvers/optimizers/generations.h"
#include "solvers/optimizers/paired_choice.h"

namespace coppice {
namespace {

/// Uniform sampling. Without noise all of the budget is one generation, and the best point is returned. Under
/// noise each of several generations meets a scenario of its own and sends its best point to a final choice
/// by paired evaluations.
class RandomSearch : public Optimizer {
 public:
  int finalists = 16;
  double final_share = 0.25;

  std::unique_ptr<Search> start(const SearchTask& task) const override;
  static Parameters<RandomSearch> parameters() {
    return Parameters<RandomSearch>()
        .add("finalists", &RandomSearch::finalists, "",
             "Generations of a noisy search; the best point of each comes into the final choice.",
             between(1, 100000))
        .add("final_share", &RandomSearch::final_share, "",
             "Part of a noisy search's budget for the final choice by paired evaluations.", between(0, 0.9));
  }
};

class RandomSearching : public Generations {
 public:
  RandomSearching(const RandomSearch& method, const SearchTask& task) : Generations(task) {
    if (!task.noisy) return;
    const auto final = static_cast<std::int64_t>(method.final_share * static_cast<double>(task.budget));
    // A generation of one point would compare nothing, a finalist without evaluations neither.
    generations_ = std::clamp<std::int64_t>(method.finalists, 1, std::max<std::int64_t>(1, final / 2));
    final_ = generations_ > 1 ? final : 0;
    finalists_ = Matrix(static_cast<std::size_t>(generations_), dimension());
  }

  std::vector<double> best() const override {
    if (choice_.finalists() > 0) return choice_.best_point();
    return best_.empty() ? first_point(task()) : best_;
  }
  double best_value() const override {
    const double chosen = choice_.best_value();
    return std::isnan(chosen) ? best_value_ : chosen;
  }

 protected:
  Candidates next_generation(std::int64_t left) override {
    if (choice_.finalists() > 0) return choice_.next_round();
    const std::int64_t size = (left - final_) / (generations_ - done_);
    Candidates generation{Matrix(static_cast<std::size_t>(size), dimension()), {}};
    Stream stream = task().draws.stream("random_search", static_cast<std::uint64_t>(done_));
    for (std::size_t i = 0; i < generation.points.rows(); ++i) {
      generation.points.set_row(i, uniform_point(task().box, stream));
    }
    if (done_ == 0) generation.points.set_row(0, first_point(task()));  // never worse than the guess
    generation.scenarios.assign(generation.points.rows(), static_cast<std::uint64_t>(done_));
    return generation;
  }

  void learn(const Candidates& generation, std::span<const double> values) override {
    if (choice_.finalists() > 0) return choice_.learn(values);
    const auto winner =
        static_cast<std::size_t>(std::max_element(values.begin(), values.end()) - values.begin());
    best_.resize(dimension());
    generation.points.row(winner, best_);
    best_value_ = values[winner];
    if (task().noisy) finalists_.set_row(static_cast<std::size_t>(done_), best_);
    if (++done_ == generations_ && final_ > 0) {
      choice_ = PairedChoice(finalists_, final_, static_cast<std::uint64_t>(done_));
    }
  }

  void save_method(Archive& archive) const override {
    save_integer(archive, "done", done_);
    archive.put("best", best_);
    save_number(archive, "best_value", best_value_);
    save_matrix(archive, "winners", finalists_);
    choice_.save(archive);
  }
  void load_method(Archive& archive) override {
    done_ = load_integer(archive, "done");
    best_ = archive.get<std::vector<double>>("best");
    best_value_ = load_number(archive, "best_value");
    finalists_ = load_matrix(archive, "winners", dimension());
    choice_.load(archive, dimension());
  }

 private:
  std::int64_t generations_ = 1;
  std::int64_t final_ = 0;    ///< evaluations for the final choice
  std::int64_t done_ = 0;     ///< generations
  std::vector<double> best_;  ///< of the last generation
  double best_value_ = std::numeric_limits<double>::quiet_NaN();
  Matrix finalists_;
  PairedChoice choice_;
};

std::unique_ptr<Search> RandomSearch::start(const SearchTask& task) const {
  check_boxed_task(task, "random_search");
  return std::make_unique<RandomSearching>(*this, task);
}

const Component<Optimizer, RandomSearch> kRandomSearch(
    "random_search", "Uniform sampling; under noise a final choice of the best.", "no publication");

}  // namespace
}  // namespace coppice
