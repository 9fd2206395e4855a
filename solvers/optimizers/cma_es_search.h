#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "solvers/optimizers/cma_es.h"
#include "solvers/optimizers/cma_es_box.h"
#include "solvers/optimizers/cma_es_run.h"
#include "solvers/optimizers/generations.h"
#include "solvers/optimizers/mean_of_means.h"
#include "solvers/optimizers/paired_choice.h"
#include "solvers/optimizers/rank_change_test.h"

namespace coppice {

/// Runs of CMA-ES one after the other, the test for noise, and the final choice under noise.
class CmaSearch : public Generations {
 public:
  CmaSearch(const CmaEs& method, const SearchTask& task);

  std::vector<double> best() const override;
  double best_value() const override;
  std::vector<double> measures() const override;

 protected:
  Candidates next_generation(std::int64_t left) override;
  void learn(const Candidates& generation, std::span<const double> values) override;
  void save_method(Archive& archive) const override;
  void load_method(Archive& archive) override;

 private:
  void begin_run();
  void test_noise(std::span<const double> values);
  void update_run(const Candidates& generation, std::span<const double> values);
  void end_run();
  void restart();
  std::vector<double> point_at(std::span<const double> coordinates) const;
  std::vector<double> estimate() const;
  Candidates begin_choice(std::int64_t left);
  CmaRunSettings first_settings() const;

  const CmaEs method_;
  const BoxMap map_;
  bool testing_;
  std::int64_t generation_ = 0;  ///< of the whole search
  std::int64_t evaluations_ = 0;
  std::int64_t restarts_ = 0, doublings_ = 0;
  std::int64_t large_spent_ = 0, small_spent_ = 0, run_began_ = 0;  ///< evaluations, of BIPOP's two regimes
  bool small_ = false;
  CmaRunSettings settings_;
  std::vector<double> start_;  ///< of the current run, coordinates
  std::unique_ptr<CmaRun> run_;
  RankChangeTest test_;
  MeanOfMeans average_;
  std::vector<double> best_;  ///< point
  double best_value_ = -std::numeric_limits<double>::infinity();
  double noisy_value_ = std::numeric_limits<double>::quiet_NaN();
  Matrix finalists_;
  PairedChoice choice_;
  bool choosing_ = false;
};

}  // namespace coppice
