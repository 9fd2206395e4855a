#include "solvers/optimizers/cma_es_run.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace coppice {
namespace {

constexpr double kMaxCondition = 1e14;
constexpr double kSmallestStep = 1e-12;  // of the first sigma
constexpr double kLargestStep = 1e6;     // of the first sigma
/// A run that has settled this closely beside a better value will not reach it.
constexpr double kHopeless = 1e-2;

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

const std::vector<double>& CmaRun::sample(Stream stream) {
  distribution_.sample(stream, rates_.population, steps_, points_);
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
  if (deviation < kSmallestStep * settings_.sigma) stop_reason_ = "tolerance";
  if (deviation > kLargestStep * settings_.sigma) stop_reason_ = "diverged";
  if (distribution_.condition() > kMaxCondition) stop_reason_ = "condition";
  if (noisy_) return;
  const double first = values[order_.front()];
  const auto n = static_cast<double>(distribution_.dimension());
  const auto window =
      10 + static_cast<std::size_t>(std::ceil(30 * n / static_cast<double>(rates_.population)));
  recent_.push_back(first);
  if (recent_.size() > window) recent_.pop_front();
  if (recent_.size() < window) return;
  const auto [low, high] = std::minmax_element(recent_.begin(), recent_.end());
  const double range = *high - *low;
  const double worst = values[order_.back()];
  if (range <= settings_.tolerance && first - worst <= settings_.tolerance) stop_reason_ = "tolerance";
  if (best - *high > 0 && std::max(range, first - worst) < kHopeless * (best - *high))
    stop_reason_ = "worse optimum";
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
  stop_reason_ = archive.get<std::string>("stop_reason");
}

}  // namespace coppice
