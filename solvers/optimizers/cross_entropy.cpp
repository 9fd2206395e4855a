#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "engine/vocabulary/elementary.h"
#include "solvers/optimizers/box.h"
#include "solvers/optimizers/generations.h"

namespace coppice {
namespace {

/// The cross-entropy method for continuous inputs (Rubinstein 1999; Kroese, Porotsky and Rubinstein 2006):
/// draw from a normal distribution, fit it to the best samples, smoothly. The thesis's fit is that without
/// smoothing (smoothing = 1, decay = 0).
class CrossEntropy : public Optimizer {
 public:
  enum class Shape { full, diagonal };
  std::optional<int> population;
  double elite_share = 0.25;
  double deviation = 0.3;
  Shape shape = Shape::full;
  double mean_smoothing = 1;
  double smoothing = 0.4;
  double decay = 0;
  double tolerance = 1e-12;

  std::int64_t samples(std::size_t dimension, std::int64_t budget) const {
    const auto n = static_cast<std::int64_t>(dimension);
    return population ? *population : std::max<std::int64_t>(4, std::clamp(budget / 50, 4 * n, 10 * n));
  }
  std::unique_ptr<Search> start(const SearchTask& task) const override;
  std::vector<std::string> measures() const override { return {"sigma"}; }

  static Parameters<CrossEntropy> parameters() {
    return Parameters<CrossEntropy>()
        .automatic("population", &CrossEntropy::population, "",
                   "Samples of a generation; auto: a fiftieth of the budget, but 4 to 10 for each axis. (The "
                   "generations share the budget evenly, so that one may have some more.)",
                   at_least(4))
        .add("elite_share", &CrossEntropy::elite_share, "",
             "Part of them, the best, that the distribution is fitted to (2 at least).", between(0.01, 1))
        .add("deviation", &CrossEntropy::deviation, "",
             "Standard deviation of the first generation, as part of a side of the box.", above(0))
        .choice("shape", &CrossEntropy::shape, {"full", "diagonal"}, "Covariances that are fitted.")
        .add("mean_smoothing", &CrossEntropy::mean_smoothing, "",
             "Weight of the fitted mean against the one before.", between(0.01, 1))
        .add("smoothing", &CrossEntropy::smoothing, "",
             "Weight of the fitted covariance against the one before.", between(0.01, 1))
        .add("decay", &CrossEntropy::decay, "",
             "Above 0 that weight is, in generation t, smoothing * (1 - (1 - 1 / t)^decay): dynamic "
             "smoothing.",
             between(0, 100))
        .add("tolerance", &CrossEntropy::tolerance, "",
             "The search ends when no deviation is above this part of its side.", at_least(0));
  }
};

/// The lower factor L of a symmetric matrix, L L' = A, both by rows. Where A is not definite (an axis along
/// which all elites agree) the column is zero: nothing is drawn along it.
std::vector<double> cholesky(const std::vector<double>& a, std::size_t n) {
  std::vector<double> l(n * n);
  for (std::size_t j = 0; j < n; ++j) {
    double pivot = a[j * n + j];
    for (std::size_t k = 0; k < j; ++k) pivot -= l[j * n + k] * l[j * n + k];
    if (!(pivot > 1e-14 * a[j * n + j])) continue;
    l[j * n + j] = std::sqrt(pivot);
    for (std::size_t i = j + 1; i < n; ++i) {
      double sum = a[i * n + j];
      for (std::size_t k = 0; k < j; ++k) sum -= l[i * n + k] * l[j * n + k];
      l[i * n + j] = sum / l[j * n + j];
    }
  }
  return l;
}

/// Means and covariances are those of coordinates in units of the box's sides.
class CrossEntropySearch : public Generations {
 public:
  CrossEntropySearch(const CrossEntropy& method, const SearchTask& task)
      : Generations(task),
        method_(method),
        mean_(first_point(task)),
        covariance_(mean_.size() * mean_.size()) {
    const std::size_t n = dimension();
    for (std::size_t i = 0; i < n; ++i) {
      const Axis& axis = task.box[i];
      side_.push_back(axis.high - axis.low);
      covariance_[i * n + i] = side_[i] > 0 ? method.deviation * method.deviation : 0;
      mean_[i] = side_[i] > 0 ? (mean_[i] - axis.low) / side_[i] : 0;
    }
  }

  std::vector<double> best() const override { return task().noisy || best_.empty() ? centre() : best_; }
  double best_value() const override { return best_value_; }
  std::vector<double> measures() const override { return {std::sqrt(mean_variance())}; }

 protected:
  Candidates next_generation(std::int64_t left) override {
    // The mean of the last distribution is better than any sample; without noise one evaluation tells its
    // value.
    const std::int64_t last = task().noisy ? 0 : 1;
    if (left <= last) return one(centre());
    const std::int64_t generations =
        std::max<std::int64_t>(1, (left - last) / method_.samples(dimension(), task().budget));
    return sample(static_cast<std::size_t>((left - last) / generations));
  }

  void learn(const Candidates& generation, std::span<const double> values) override {
    ++generation_;
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return values[a] > values[b]; });
    remember(generation, order.front(), values);
    const auto share = static_cast<std::size_t>(method_.elite_share * static_cast<double>(values.size()));
    order.resize(std::min(values.size(), std::max<std::size_t>(2, share)));
    std::erase_if(order,
                  [&](std::size_t row) { return values[row] == -std::numeric_limits<double>::infinity(); });
    if (order.size() < 2) return;  // nothing to fit to
    fit(generation.points, order);
    if (std::sqrt(largest_variance()) <= method_.tolerance) stop("tolerance");
  }

  void save_method(Archive& archive) const override {
    save_integer(archive, "generation", generation_);
    archive.put("mean", mean_);
    archive.put("covariance", covariance_);
    archive.put("best", best_);
    save_number(archive, "best_value", best_value_);
  }
  void load_method(Archive& archive) override {
    generation_ = load_integer(archive, "generation");
    mean_ = load_numbers(archive, "mean", dimension());
    covariance_ = load_numbers(archive, "covariance", dimension() * dimension());
    best_ = archive.get<std::vector<double>>("best");
    best_value_ = load_number(archive, "best_value");
  }

 private:
  std::vector<double> to_box(std::span<const double> unit) const {
    std::vector<double> x(unit.size());
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = task().box[i].low + side_[i] * unit[i];
    clip(task().box, x);
    return x;
  }
  std::vector<double> centre() const { return to_box(mean_); }
  Candidates one(const std::vector<double>& x) const {
    Candidates candidates{Matrix(1, dimension()), {static_cast<std::uint64_t>(generation_)}};
    candidates.points.set_row(0, x);
    return candidates;
  }

  Candidates sample(std::size_t size) const {
    const std::size_t n = dimension();
    const std::vector<double> factor = cholesky(covariance_, n);
    Candidates candidates{Matrix(size, n), {}};
    candidates.scenarios.assign(size, static_cast<std::uint64_t>(generation_));
    Stream stream = task().draws.stream("cross_entropy", static_cast<std::uint64_t>(generation_));
    std::vector<double> normal(n), x(n);
    for (std::size_t row = 0; row < size; ++row) {
      for (double& z : normal) z = stream.normal();
      for (std::size_t i = 0; i < n; ++i) {
        x[i] = mean_[i];
        for (std::size_t k = 0; k <= i; ++k) x[i] += factor[i * n + k] * normal[k];
      }
      candidates.points.set_row(row, to_box(x));
    }
    return candidates;
  }

  /// Without noise the best point of all; under noise the mean is returned, and its value estimated by that
  /// of the last generation.
  void remember(const Candidates& generation, std::size_t row, std::span<const double> values) {
    if (task().noisy) {
      best_value_ =
          comparable(std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size()));
    } else if (best_.empty() || values[row] > best_value_) {
      best_.resize(dimension());
      generation.points.row(row, best_);
      best_value_ = values[row];
    }
  }

  void fit(const Matrix& points, const std::vector<std::size_t>& elites) {
    const std::size_t n = dimension();
    const auto count = static_cast<double>(elites.size());
    std::vector<double> unit(elites.size() * n), mean(n);
    for (std::size_t e = 0; e < elites.size(); ++e) {
      for (std::size_t i = 0; i < n; ++i) {
        const double x = side_[i] > 0 ? (points(elites[e], i) - task().box[i].low) / side_[i] : 0;
        unit[e * n + i] = x;
        mean[i] += x / count;
      }
    }
    const double t = static_cast<double>(generation_);
    const double kept = method_.decay > 0 ? elementary::pow(1 - 1 / t, method_.decay) : 0;
    const double weight = method_.smoothing * (1 - kept);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        double sum = 0;
        if (i == j || method_.shape == CrossEntropy::Shape::full) {
          for (std::size_t e = 0; e < elites.size(); ++e) {
            sum += (unit[e * n + i] - mean[i]) * (unit[e * n + j] - mean[j]);
          }
        }
        double& entry = covariance_[i * n + j];
        entry += weight * (sum / count - entry);
        covariance_[j * n + i] = entry;
      }
      mean_[i] += method_.mean_smoothing * (mean[i] - mean_[i]);
    }
  }

  double mean_variance() const {
    double sum = 0;
    for (std::size_t i = 0; i < dimension(); ++i) sum += covariance_[i * dimension() + i];
    return sum / static_cast<double>(dimension());
  }
  double largest_variance() const {
    double largest = 0;
    for (std::size_t i = 0; i < dimension(); ++i) {
      largest = std::max(largest, covariance_[i * dimension() + i]);
    }
    return largest;
  }

  const CrossEntropy method_;
  std::vector<double> mean_, covariance_;
  std::vector<double> side_;  ///< of the box
  std::int64_t generation_ = 0;
  std::vector<double> best_;  ///< without noise
  double best_value_ = std::numeric_limits<double>::quiet_NaN();
};

std::unique_ptr<Search> CrossEntropy::start(const SearchTask& task) const {
  check_boxed_task(task, "cross_entropy", 4);
  return std::make_unique<CrossEntropySearch>(*this, task);
}

const Component<Optimizer, CrossEntropy> kCrossEntropy(
    "cross_entropy", "Cross-entropy method: fits a normal distribution to the best samples.",
    "L. Hofer's thesis (2017), A.2; Kroese, Porotsky and Rubinstein, Methodol. Comput. Appl. Probab. 8 "
    "(2006)");

}  // namespace
}  // namespace coppice
