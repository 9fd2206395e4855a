#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "engine/vocabulary/elementary.h"
#include "solvers/approximators/gaussian_process.h"
#include "solvers/climb.h"
#include "solvers/optimizers/acquisition.h"
#include "solvers/optimizers/box.h"
#include "solvers/optimizers/generations.h"
#include "solvers/optimizers/hedge.h"

namespace coppice {
namespace {

/// Bayesian optimization (thesis, A.4): a Gaussian process is fitted to all evaluations; the next point is
/// where an acquisition is largest, which is drawn from a portfolio by a bandit (Hoffman et al. 2011).
class Bayesian : public Optimizer {
 public:
  enum class Acquisition { portfolio, expected_improvement, upper_bound, improvement_probability };
  static constexpr std::size_t kMaxAxes = 20;
  static constexpr std::int64_t kMaxBudget = 1000;

  int initial = 10;
  Acquisition acquisition = Acquisition::portfolio;
  double delta = 0.1;
  double width = 0.4;
  int probes = 200;

  std::unique_ptr<Search> start(const SearchTask& task) const override;
  std::vector<std::string> measures() const override { return {"deviation", "noise"}; }

  static Parameters<Bayesian> parameters() {
    return Parameters<Bayesian>()
        .add("initial", &Bayesian::initial, "",
             "Evaluations of the initial design, a Latin hypercube (and the guess, where there is one).",
             at_least(2))
        .choice("acquisition", &Bayesian::acquisition,
                {"portfolio", "expected_improvement", "upper_bound", "improvement_probability"},
                "What makes a point worth an evaluation; portfolio: one of the three others, by the bandit "
                "GP-Hedge.")
        .add("delta", &Bayesian::delta, "", "Probability that the upper bound may fail (GP-UCB's schedule).",
             Bounds{.low = 0, .high = 1, .low_open = true})
        .add("width", &Bayesian::width, "",
             "Factor of the upper bound's width; 1 is that of the theory, which explores more than pays.",
             above(0))
        .add("probes", &Bayesian::probes, "",
             "Places compared before the local searches for the acquisition's maximum.", at_least(8));
  }
};

constexpr std::size_t kArms = 3;

/// The process lives in units of the box's sides.
class BayesianSearch : public Generations {
 public:
  BayesianSearch(const Bayesian& method, const SearchTask& task)
      : Generations(task),
        method_(method),
        process_(GaussianKernel{std::vector<double>(task.box.size(), 0.3), task.noisy ? 1e-2 : kNoNoise}),
        hedge_(kArms) {}

  std::vector<double> best() const override {
    return size() == 0 ? first_point(task()) : in_box(process_.place(incumbent_));
  }
  double best_value() const override {
    if (size() == 0) return std::numeric_limits<double>::quiet_NaN();
    return task().noisy ? process_.posterior(process_.place(incumbent_)).mean : values_[incumbent_];
  }
  std::vector<double> measures() const override {
    return {std::sqrt(process_.scale()), std::sqrt(process_.scale() * process_.kernel().noise)};
  }

 protected:
  Candidates next_generation(std::int64_t left) override {
    if (size() == 0) return design(static_cast<std::size_t>(std::min<std::int64_t>(left, method_.initial)));
    const std::vector<Probe> probes = make_probes();
    proposals_.assign(kArms, {});
    const bool all = method_.acquisition == Bayesian::Acquisition::portfolio;
    std::size_t chosen = static_cast<std::size_t>(method_.acquisition) - 1;
    if (all) {
      const Draws draws = task().draws.fork("hedge", size());
      chosen = hedge_.choose(draws.uniform("arm", 0, 1), static_cast<double>(task().budget));
    }
    for (std::size_t arm = 0; arm < kArms; ++arm) {
      if (all || arm == chosen) proposals_[arm] = largest(arm, probes);
    }
    Candidates candidates{Matrix(1, dimension()), {size()}};
    candidates.points.set_row(0, in_box(proposals_[chosen]));
    return candidates;
  }

  void learn(const Candidates& generation, std::span<const double> values) override {
    std::vector<double> x(dimension());
    for (std::size_t row = 0; row < values.size(); ++row) {
      generation.points.row(row, x);
      process_.append(in_unit(x));
      values_.push_back(values[row]);
    }
    process_.set_values(finite_values());
    if (size() >= next_tuning_) tune_kernel();
    find_incumbent();
    reward();
  }

  void save_method(Archive& archive) const override {
    std::vector<double> places;
    for (std::size_t i = 0; i < size(); ++i) {
      places.insert(places.end(), process_.place(i).begin(), process_.place(i).end());
    }
    archive.put("places", places);
    archive.put("told", values_);
    archive.put("lengths", process_.kernel().lengths);
    save_number(archive, "noise", process_.kernel().noise);
    archive.put("gains", hedge_.gains());
    save_integer(archive, "next_tuning", static_cast<std::int64_t>(next_tuning_));
    std::vector<double> proposals;
    std::vector<std::int64_t> proposing;  // acquisitions that made one
    for (std::size_t arm = 0; arm < proposals_.size(); ++arm) {
      if (proposals_[arm].empty()) continue;
      proposing.push_back(static_cast<std::int64_t>(arm));
      proposals.insert(proposals.end(), proposals_[arm].begin(), proposals_[arm].end());
    }
    archive.put("proposals", proposals);
    archive.put("proposing", proposing);
  }
  void load_method(Archive& archive) override {
    values_ = archive.get<std::vector<double>>("told");
    const std::vector<double> places = load_numbers(archive, "places", values_.size() * dimension());
    GaussianKernel kernel{load_numbers(archive, "lengths", dimension()), load_number(archive, "noise")};
    const auto positive = [](double v) { return v > 0 && std::isfinite(v); };
    if (!std::all_of(kernel.lengths.begin(), kernel.lengths.end(), positive) || !positive(kernel.noise)) {
      throw std::runtime_error("search: not a kernel");
    }
    process_ = GaussianProcess(std::move(kernel));
    for (std::size_t i = 0; i < values_.size(); ++i) {
      process_.append(std::span(places).subspan(i * dimension(), dimension()));
    }
    hedge_.set_gains(load_numbers(archive, "gains", kArms));
    next_tuning_ = static_cast<std::size_t>(load_integer(archive, "next_tuning"));
    load_proposals(archive);
    if (values_.empty()) return;
    process_.set_values(finite_values());
    find_incumbent();
  }

 private:
  static constexpr double kNoNoise = 1e-10;  // what the factorization needs for close points
  static constexpr std::size_t kClimbs = 4;
  static constexpr int kClimbEvaluations = 30;
  struct Probe {
    std::vector<double> at;
    GaussianPosterior posterior;
  };

  std::size_t size() const { return process_.size(); }

  void load_proposals(const Archive& archive) {
    const auto& proposing = archive.get<std::vector<std::int64_t>>("proposing");
    const std::vector<double> points = load_numbers(archive, "proposals", proposing.size() * dimension());
    proposals_.assign(proposing.empty() ? 0 : kArms, {});
    for (std::size_t i = 0; i < proposing.size(); ++i) {
      if (proposing[i] < 0 || proposing[i] >= static_cast<std::int64_t>(kArms)) {
        throw std::runtime_error("search: not an acquisition");
      }
      const auto point = points.begin() + static_cast<std::ptrdiff_t>(i * dimension());
      proposals_[static_cast<std::size_t>(proposing[i])].assign(
          point, point + static_cast<std::ptrdiff_t>(dimension()));
    }
  }

  std::vector<double> in_unit(std::span<const double> x) const {
    std::vector<double> unit(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
      const Axis& axis = task().box[i];
      unit[i] = axis.high > axis.low ? (x[i] - axis.low) / (axis.high - axis.low) : 0;
    }
    return unit;
  }
  std::vector<double> in_box(std::span<const double> unit) const {
    std::vector<double> x(unit.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
      const Axis& axis = task().box[i];
      x[i] = axis.low + unit[i] * (axis.high - axis.low);
    }
    clip(task().box, x);
    return x;
  }

  /// A Latin hypercube: of each axis every one of `count` equal parts holds one point (McKay, Beckman and
  /// Conover 1979).
  Candidates design(std::size_t count) const {
    Candidates candidates{Matrix(count, dimension()), {}};
    Stream stream = task().draws.stream("design");
    std::vector<std::size_t> part(count);
    for (std::size_t k = 0; k < dimension(); ++k) {
      for (std::size_t i = 0; i < count; ++i) {
        const std::size_t j = stream.below(i + 1);
        part[i] = part[j];
        part[j] = i;
      }
      for (std::size_t i = 0; i < count; ++i) {
        candidates.points(i, k) =
            (static_cast<double>(part[i]) + stream.uniform()) / static_cast<double>(count);
      }
    }
    std::vector<double> x(dimension());
    for (std::size_t i = 0; i < count; ++i) {
      candidates.points.row(i, x);
      candidates.points.set_row(i, i == 0 && !task().guess.empty() ? first_point(task()) : in_box(x));
      candidates.scenarios.push_back(i);
    }
    return candidates;
  }

  /// What is no number is as bad as the worst that is one; infinity as good as the best.
  std::vector<double> finite_values() const {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const double value : values_) {
      if (!std::isfinite(value)) continue;
      low = std::min(low, value);
      high = std::max(high, value);
    }
    if (low > high) low = high = 0;
    std::vector<double> values = values_;
    for (double& value : values) value = std::clamp(value, low, high);
    return values;
  }

  void tune_kernel() {
    next_tuning_ = size() + std::max<std::size_t>(1, size() / 10);
    if (!(process_.scale() > 0)) return;  // all alike
    GaussianTuning tuning;
    tuning.shortest.assign(dimension(), 0.02);
    tuning.longest.assign(dimension(), 20);
    tuning.noise_low = task().noisy ? 1e-6 : kNoNoise;
    tuning.noise_high = task().noisy ? 10 : kNoNoise;
    tuning.evaluations = 40;
    tune(process_, tuning, 2);
  }

  /// Under noise the told point of largest mean, not the luckiest one.
  void find_incumbent() {
    double most = -std::numeric_limits<double>::infinity();
    incumbent_ = 0;
    for (std::size_t i = 0; i < size(); ++i) {
      const double value = task().noisy ? process_.posterior(process_.place(i)).mean : values_[i];
      if (value > most) {
        most = value;
        incumbent_ = i;
      }
    }
  }
  double incumbent_mean() const { return process_.posterior(process_.place(incumbent_)).mean; }

  /// GP-Hedge's reward of each acquisition is the mean, after the update, where it would have gone; in units
  /// of the process here, so that eta fits functions of any size.
  void reward() {
    if (proposals_.empty() || !(process_.scale() > 0)) return;
    for (std::size_t arm = 0; arm < kArms; ++arm) {
      if (proposals_[arm].empty()) continue;
      const double mean = process_.posterior(proposals_[arm]).mean - process_.constant();
      hedge_.reward(arm, mean / std::sqrt(process_.scale()));
    }
    proposals_.clear();
  }

  /// Half of them anywhere, half about the incumbent at distances of all orders.
  std::vector<Probe> make_probes() const {
    Stream stream = task().draws.fork("probes", size()).stream("probe");
    const auto count = static_cast<std::size_t>(method_.probes);
    const std::span<const double> centre = process_.place(incumbent_);
    std::vector<Probe> probes(count);
    for (std::size_t i = 0; i < count; ++i) {
      std::vector<double>& x = probes[i].at;
      const double radius = elementary::exp(stream.uniform(-9, -1));
      for (std::size_t k = 0; k < dimension(); ++k) {
        x.push_back(i % 2 == 0 ? stream.uniform()
                               : std::clamp(centre[k] + radius * stream.normal(), 0.0, 1.0));
      }
      probes[i].posterior = process_.posterior(x);
    }
    return probes;
  }

  Promise promise(std::size_t arm, double mean, double deviation, double best) const {
    if (arm == 0) return log_expected_improvement(mean, deviation, best);
    if (arm == 2) return log_improvement_probability(mean, deviation, best);
    const double width = bound_width(static_cast<double>(size()), static_cast<double>(dimension()),
                                     method_.delta, method_.width);
    return upper_bound(mean, deviation, width);
  }

  /// Where the acquisition is largest: local searches from the best probes.
  std::vector<double> largest(std::size_t arm, const std::vector<Probe>& probes) const {
    const double best = task().noisy ? incumbent_mean() : finite_values()[incumbent_];
    const double least = 1e-12 * std::max(process_.scale(), 1e-280);
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t i = 0; i < probes.size(); ++i) {
      const GaussianPosterior& at = probes[i].posterior;
      order.emplace_back(promise(arm, at.mean, std::sqrt(std::max(at.variance, least)), best).value, i);
    }
    std::stable_sort(order.begin(), order.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });

    std::vector<double> by_variance(dimension());
    const Hill hill = [&](std::span<const double> x, std::span<double> gradient) {
      const GaussianPosterior at = process_.posterior(x, gradient, by_variance);
      const double deviation = std::sqrt(std::max(at.variance, least));
      const Promise p = promise(arm, at.mean, deviation, best);
      for (std::size_t k = 0; k < gradient.size(); ++k) {
        gradient[k] = p.by_mean * gradient[k];
        if (at.variance > least) gradient[k] += p.by_deviation * by_variance[k] / (2 * deviation);
      }
      return p.value;
    };
    const std::vector<double> low(dimension(), 0.0), high(dimension(), 1.0);
    std::vector<double> found = probes[order[0].second].at;
    double most = order[0].first;
    for (std::size_t s = 0; s < std::min(kClimbs, order.size()); ++s) {
      std::vector<double> at = probes[order[s].second].at;
      const double reached = climb(hill, low, high, at, kClimbEvaluations);
      if (reached > most) {
        most = reached;
        found = at;
      }
    }
    return found;
  }

  const Bayesian method_;
  GaussianProcess process_;
  Hedge hedge_;
  std::vector<double> values_;                  ///< as told; -infinity for NaN
  std::vector<std::vector<double>> proposals_;  ///< of each acquisition for the last point
  std::size_t incumbent_ = 0;
  std::size_t next_tuning_ = 0;
};

std::unique_ptr<Search> Bayesian::start(const SearchTask& task) const {
  check_boxed_task(task, "bayesian", 2);
  if (task.box.size() > kMaxAxes) {
    throw std::invalid_argument(
        fmt::format("<bayesian> searches boxes of at most {} axes (it is made for 10), not {}", kMaxAxes,
                    task.box.size()));
  }
  if (task.budget > kMaxBudget) {
    throw std::invalid_argument(
        fmt::format("<bayesian> makes at most {} evaluations (its time grows with their cube), not {}",
                    kMaxBudget, task.budget));
  }
  return std::make_unique<BayesianSearch>(*this, task);
}

const Component<Optimizer, Bayesian> kBayesian(
    "bayesian", "Bayesian optimization on a Gaussian process, for costly functions of up to about 10 inputs.",
    "Hoffman, Brochu and de Freitas, Portfolio allocation for Bayesian optimization (UAI 2011); L. Hofer's "
    "thesis (2017), A.4");

}  // namespace
}  // namespace coppice
