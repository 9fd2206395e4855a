#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "engine/vocabulary/optimizer.h"

namespace coppice::testing {

/// Tries points of a line from the lower to the upper limits, three at a time under one scenario number,
/// until the budget is spent.
class LineSearch : public Search {
 public:
  explicit LineSearch(SearchTask task) : task_(std::move(task)) {}

  Candidates ask(std::int64_t limit) override {
    const std::int64_t count = std::min({limit, task_.budget - told_, 3 - told_ % 3});
    Candidates candidates{Matrix(static_cast<std::size_t>(count), task_.box.size()), {}};
    for (std::size_t i = 0; i < candidates.points.rows(); ++i) {
      candidates.points.set_row(i, point(told_ + static_cast<std::int64_t>(i)));
      candidates.scenarios.push_back(static_cast<std::uint64_t>(told_ / 3));
    }
    return candidates;
  }
  void tell(std::span<const double> values) override {
    for (const double value : values) {
      if (told_ == 0 || value > best_value_) {
        best_ = point(told_);
        best_value_ = value;
      }
      ++told_;
    }
  }
  std::vector<double> best() const override { return best_; }
  double best_value() const override { return best_value_; }
  std::string stop_reason() const override { return told_ == task_.budget ? "budget" : ""; }
  std::vector<double> measures() const override { return {static_cast<double>(told_)}; }
  void save(Archive& archive) const override {
    archive.put("told", std::vector<std::int64_t>{told_});
    archive.put("best", best_);
    archive.put("best_value", std::vector<double>{best_value_});
  }
  void load(Archive& archive) override {
    told_ = archive.get<std::vector<std::int64_t>>("told").at(0);
    best_ = archive.get<std::vector<double>>("best");
    best_value_ = archive.get<std::vector<double>>("best_value").at(0);
  }

 private:
  std::vector<double> point(std::int64_t i) const {
    std::vector<double> x;
    const double share =
        task_.budget == 1 ? 0 : static_cast<double>(i) / static_cast<double>(task_.budget - 1);
    for (const Axis& axis : task_.box) x.push_back(axis.low + share * (axis.high - axis.low));
    return x;
  }

  const SearchTask task_;
  std::int64_t told_ = 0;
  std::vector<double> best_;
  double best_value_ = 0;
};

struct LineOptimizer : Optimizer {
  std::unique_ptr<Search> start(const SearchTask& task) const override {
    for (const Axis& axis : task.box) {
      if (!std::isfinite(axis.low) || !std::isfinite(axis.high))
        throw std::invalid_argument("the line needs finite limits");
    }
    return std::make_unique<LineSearch>(task);
  }
  std::vector<std::string> measures() const override { return {"told"}; }
  static Parameters<LineOptimizer> parameters() { return {}; }
};

}  // namespace coppice::testing
