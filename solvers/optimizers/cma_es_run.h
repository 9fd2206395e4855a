#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "solvers/optimizers/cma_es_distribution.h"
#include "solvers/optimizers/cma_es_learning_rates.h"

namespace coppice {

/// What a run of CMA-ES is begun with.
struct CmaRunSettings {
  std::size_t population = 0;
  std::size_t refining_population = 0;  ///< that a larger one shrinks to beside one optimum
  double sigma = 0;
  bool active = true;
  bool separable = false;
  double tolerance = 0;  ///< of values: a run ends when they have varied less for a while
};

/// One run from one start, without noise or restarts: ranks what it is told, updates the distribution, and
/// notices when going on makes no sense.
class CmaRun {
 public:
  CmaRun(const CmaRunSettings& settings, std::vector<double> mean);

  const CmaDistribution& distribution() const { return distribution_; }
  const CmaRunSettings& settings() const { return settings_; }
  std::size_t population() const { return rates_.population; }
  const CmaLearningRates* learning_rates() const { return learning_ ? &*learning_ : nullptr; }
  std::int64_t generation() const { return generation_; }
  /// Coordinates (row after row) of the next generation; some may lie outside the box.
  const std::vector<double>& sample(Stream stream, const BoxMap& box);
  /// Values of the points, the larger the better; `best`: the best value of the whole search so far;
  /// `injected`: a point to take the worst one's place (elitism), or none.
  void update(std::span<const double> values, double best, std::span<const double> injected);
  /// From now on learning rates adapt to noise (of a full covariance), and no value ends the run.
  void expect_noise();
  /// Why it ended; empty while it goes on.
  const std::string& stop_reason() const { return stop_reason_; }

  void save(Archive& archive) const;
  void load(Archive& archive);

 private:
  void check_stop(std::span<const double> values, double best);
  const char* check_values(std::span<const double> values, double best);
  std::size_t generations_of(double times) const;
  bool has_chosen_its_optimum(double deviation);
  void refine();

  CmaRunSettings settings_;
  CmaRates rates_;
  CmaDistribution distribution_;
  std::optional<CmaLearningRates> learning_;
  bool noisy_ = false;
  std::int64_t generation_ = 0;
  std::vector<double> steps_, points_;
  std::vector<std::uint32_t> order_;
  std::deque<double> recent_;      ///< best value of each of the last generations
  std::deque<double> deviations_;  ///< largest deviation before each of them
  std::string stop_reason_;
};

/// Ranks, best first: equal values in order, NaN after every number.
std::vector<std::uint32_t> ranked(std::span<const double> values);

}  // namespace coppice
