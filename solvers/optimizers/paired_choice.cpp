#include "solvers/optimizers/paired_choice.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "solvers/optimizers/box.h"
#include "solvers/optimizers/generations.h"

namespace coppice {

PairedChoice::PairedChoice(Matrix points, std::int64_t budget, std::uint64_t first_scenario)
    : points_(std::move(points)),
      sums_(points_.rows()),
      counts_(points_.rows()),
      survivors_(points_.rows()),
      left_(budget),
      scenario_(first_scenario) {
  std::iota(survivors_.begin(), survivors_.end(), 0);
}

Candidates PairedChoice::next_round() {
  Candidates round{Matrix(0, points_.columns()), {}};
  round_.clear();
  if (left_ <= 0 || survivors_.empty()) return round;
  const auto competing = static_cast<std::int64_t>(survivors_.size());
  std::int64_t trials = 1;
  if (left_ < competing) {  // not enough for a fair comparison: to know the best better
    round_.push_back(static_cast<std::int64_t>(best()));
    survivors_ = round_;
    trials = left_;
  } else {
    std::int64_t rounds = 1;
    for (std::int64_t n = 2; n < competing; n *= 2) ++rounds;
    round_ = survivors_;
    trials = std::max<std::int64_t>(1, left_ / (rounds * competing));
  }
  const std::size_t width = round_.size();
  round.points = Matrix(static_cast<std::size_t>(trials) * width, points_.columns());
  std::vector<double> x(points_.columns());
  for (std::size_t i = 0; i < round.points.rows(); ++i) {
    points_.row(static_cast<std::size_t>(round_[i % width]), x);
    round.points.set_row(i, x);
    round.scenarios.push_back(scenario_ + i / width);
  }
  scenario_ += static_cast<std::uint64_t>(trials);
  return round;
}

void PairedChoice::learn(std::span<const double> values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto row = static_cast<std::size_t>(round_[i % round_.size()]);
    sums_[row] += values[i];
    ++counts_[row];
  }
  left_ -= static_cast<std::int64_t>(values.size());
  halve();
}

double PairedChoice::mean(std::size_t row) const {
  return comparable(sums_[row] / counts_[row]);
}

void PairedChoice::halve() {
  std::stable_sort(survivors_.begin(), survivors_.end(), [&](std::int64_t a, std::int64_t b) {
    return mean(static_cast<std::size_t>(a)) > mean(static_cast<std::size_t>(b));
  });
  survivors_.resize((survivors_.size() + 1) / 2);
}

std::size_t PairedChoice::best() const {
  if (survivors_.empty()) return 0;
  return static_cast<std::size_t>(
      *std::max_element(survivors_.begin(), survivors_.end(), [&](std::int64_t a, std::int64_t b) {
        return mean(static_cast<std::size_t>(a)) < mean(static_cast<std::size_t>(b));
      }));
}

std::vector<double> PairedChoice::best_point() const {
  std::vector<double> x(points_.columns());
  points_.row(best(), x);
  return x;
}

double PairedChoice::best_value() const {
  if (sums_.empty() || counts_[best()] == 0) return std::numeric_limits<double>::quiet_NaN();
  return mean(best());
}

void PairedChoice::save(Archive& archive) const {
  Archive::Scope scope(archive, "choice");
  save_matrix(archive, "finalists", points_);
  archive.put("sums", sums_);
  archive.put("counts", counts_);
  archive.put("survivors", survivors_);
  archive.put("round", round_);
  save_integer(archive, "left", left_);
  save_integer(archive, "scenario", static_cast<std::int64_t>(scenario_));
}

void PairedChoice::load(Archive& archive, std::size_t columns) {
  Archive::Scope scope(archive, "choice");
  points_ = load_matrix(archive, "finalists", columns);
  sums_ = load_numbers(archive, "sums", points_.rows());
  counts_ = load_numbers(archive, "counts", points_.rows());
  survivors_ = archive.get<std::vector<std::int64_t>>("survivors");
  round_ = archive.get<std::vector<std::int64_t>>("round");
  for (const std::vector<std::int64_t>* rows : {&survivors_, &round_}) {
    for (const std::int64_t row : *rows) {
      if (row >= 0 && static_cast<std::size_t>(row) < points_.rows()) continue;
      throw std::runtime_error("search: the choice names a point that is not there");
    }
  }
  left_ = load_integer(archive, "left");
  scenario_ = static_cast<std::uint64_t>(load_integer(archive, "scenario"));
}

}  // namespace coppice
