#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/vocabulary/optimizer.h"

namespace coppice {

/// Covariance matrix adaptation evolution strategy.
class CmaEs : public Optimizer {
 public:
  enum class Restarts { ipop, bipop, none };
  enum class Covariance { automatic, full, separable };
  enum class Noise { automatic, on, off };

  double sigma = 0.3;
  std::optional<int> population;
  bool active = true;
  Covariance covariance = Covariance::automatic;
  Restarts restarts = Restarts::ipop;
  int max_restarts = 1000;
  double growth = 2;
  bool elitist = false;
  double tolerance = 1e-12;
  Noise noise = Noise::automatic;
  double final_share = 0.05;

  std::unique_ptr<Search> start(const SearchTask& task) const override;
  std::vector<std::string> measures() const override {
    return {"sigma", "population", "restarts", "rank_changes", "mean_rate"};
  }
  static Parameters<CmaEs> parameters();
};

}  // namespace coppice
