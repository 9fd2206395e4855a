#include "solvers/optimizers/cma_es_run.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace coppice {
namespace {

constexpr double kMaxCondition = 1e14;
constexpr double kSmallestStep = 1e-12;  // of the first sigma
constexpr double kLargestStep = 1e6;     // of the first sigma
/// A run that has settled this closely beside a better value will not reach it.
constexpr double kHopeless = 1e-2;
/// What is drawn outside the box is drawn again (tutorial, B.5) while the distribution is wide, since there
/// mirrored points tell nothing of their surroundings; when it is narrow they do, and reach optima on the
/// border sooner.
constexpr int kAttempts = 30;
constexpr double kWide = 0.1;  // of the first sigma
/// The deviation falls so far in about n generations only about one optimum, not among many.
constexpr double kConverging = 0.1;

}  // namespace

std::vector<std::uint32_t> ranked(std::span<const double> values) {
  std::vector<std::uint32_t> order(values.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return values[a] > values[b] || (std::isnan(values[b]) && !std::isnan(values[a]));
  });
  return order;
}

CmaRun::CmaRun(const CmaRunSettings& settings, std::vector<double> mean)
    : settings_(settings),
      rates_(cma_rates(mean.size(), settings.population, settings.active, settings.separable)),
      distribution_(std::move(mean), settings.sigma, settings.separable) {}

const std::vector<double>& CmaRun::sample(Stream stream, const BoxMap& box) {
  const bool wide = distribution_.largest_deviation() > kWide * settings_.sigma;
  distribution_.sample(stream, box, wide ? kAttempts : 1, rates_.population, steps_, points_);
  return points_;
}

void CmaRun::update(std::span<const double> values, double best, std::span<const double> injected) {
  const std::size_t n = distribution_.dimension();
  order_ = ranked(values);
  if (!injected.empty()) {  // the elitist takes the worst one's place, and the first rank
    const std::uint32_t worst = order_.back();
    const std::span<double> step(steps_.data() + worst * n, n);
    distribution_.standardize(injected, step);
    double square = 0;
    for (const double z : step) square += z * z;
    // no longer than likely (Hansen, arXiv 1110.4181)
    const double longest =
        std::sqrt(static_cast<double>(n)) + 2.0 * static_cast<double>(n) / (static_cast<double>(n) + 2);
    const double shrink = std::min(1.0, longest / std::sqrt(square));
    for (double& z : step) z *= shrink;
    std::rotate(order_.begin(), order_.end() - 1, order_.end());
  }
  ++generation_;
  bool sound = false;
  if (learning_) {
    const CmaDistribution before = distribution_;
    sound = distribution_.update(rates_, steps_, order_) && learning_->shorten(before, distribution_);
  } else {
    sound = distribution_.update(rates_, steps_, order_);
  }
  if (!sound) {
    stop_reason_ = "condition";
  } else {
    check_stop(values, best);
  }
}

void CmaRun::expect_noise() {
  noisy_ = true;
  if (!settings_.separable) learning_.emplace(distribution_.dimension());
}

void CmaRun::check_stop(std::span<const double> values, double best) {
  const double deviation = distribution_.largest_deviation();
  const char* reason = "";
  if (deviation < kSmallestStep * settings_.sigma) reason = "tolerance";
  if (deviation > kLargestStep * settings_.sigma) reason = "diverged";
  if (distribution_.condition() > kMaxCondition) reason = "condition";
  if (!noisy_) {
    const char* settled = check_values(values, best);
    if (*settled != '\0') reason = settled;
    if (has_chosen_its_optimum(deviation)) refine();
  }
  stop_reason_ = reason;
}

const char* CmaRun::check_values(std::span<const double> values, double best) {
  const double first = values[order_.front()], worst = values[order_.back()];
  const std::size_t window = 10 + generations_of(30);
  recent_.push_back(first);
  if (recent_.size() > window) recent_.pop_front();
  if (recent_.size() < window) return "";
  const auto [low, high] = std::minmax_element(recent_.begin(), recent_.end());
  const double range = std::max(*high - *low, first - worst);
  if (best - *high > 0 && range < kHopeless * (best - *high)) return "worse optimum";
  return range <= settings_.tolerance ? "tolerance" : "";
}

/// The generations in which the run evaluates `times` n candidates.
std::size_t CmaRun::generations_of(double times) const {
  const auto n = static_cast<double>(distribution_.dimension());
  return static_cast<std::size_t>(std::ceil(times * n / static_cast<double>(rates_.population)));
}

bool CmaRun::has_chosen_its_optimum(double deviation) {
  if (rates_.population <= settings_.refining_population) return false;
  const std::size_t window = std::max<std::size_t>(10, distribution_.dimension()) + generations_of(30);
  deviations_.push_back(deviation);
  if (deviations_.size() > window) deviations_.pop_front();
  return deviations_.size() == window && deviation < kConverging * deviations_.front();
}

void CmaRun::refine() {
  rates_ = cma_rates(distribution_.dimension(), settings_.refining_population, settings_.active,
                     settings_.separable);
  recent_.clear();
  deviations_.clear();
}

void CmaRun::save(Archive& archive) const {
  distribution_.save(archive);
  if (learning_) {
    const Archive::Scope scope(archive, "learning_rates");
    learning_->save(archive);
  }
  archive.put("noisy", std::vector<std::int64_t>{noisy_ ? 1 : 0});
  archive.put("run_generation", std::vector<std::int64_t>{generation_});
  archive.put("steps", steps_);
  archive.put("points", points_);
  archive.put("recent", std::vector<double>(recent_.begin(), recent_.end()));
  archive.put("deviations", std::vector<double>(deviations_.begin(), deviations_.end()));
  archive.put("run_population", std::vector<std::int64_t>{static_cast<std::int64_t>(rates_.population)});
  archive.put("stop_reason", stop_reason_);
}

void CmaRun::load(Archive& archive) {
  distribution_.load(archive);
  noisy_ = archive.get<std::vector<std::int64_t>>("noisy").at(0) != 0;
  if (noisy_) expect_noise();
  if (learning_) {
    const Archive::Scope scope(archive, "learning_rates");
    learning_->load(archive);
  }
  generation_ = archive.get<std::vector<std::int64_t>>("run_generation").at(0);
  steps_ = archive.get<std::vector<double>>("steps");
  points_ = archive.get<std::vector<double>>("points");
  const auto& recent = archive.get<std::vector<double>>("recent");
  recent_.assign(recent.begin(), recent.end());
  const auto& deviations = archive.get<std::vector<double>>("deviations");
  deviations_.assign(deviations.begin(), deviations.end());
  const std::int64_t population = archive.get<std::vector<std::int64_t>>("run_population").at(0);
  if (population < 2) throw std::runtime_error("search: a population is damaged");
  if (static_cast<std::size_t>(population) != rates_.population) {
    rates_ = cma_rates(distribution_.dimension(), static_cast<std::size_t>(population), settings_.active,
                       settings_.separable);
  }
  stop_reason_ = archive.get<std::string>("stop_reason");
}

}  // namespace coppice
