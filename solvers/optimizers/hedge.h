#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "engine/vocabulary/elementary.h"

namespace coppice {

/// The bandit Hedge (Auer et al. 1998) over full information, as GP-Hedge uses it (Hoffman, Brochu and de
/// Freitas 2011, Algorithm 1): an arm is drawn with a probability proportional to exp(eta gain).
class Hedge {
 public:
  explicit Hedge(std::size_t arms) : gains_(arms) {}

  /// `u` uniform in [0, 1); eta = sqrt(8 ln k / rounds), the value of the theory for rewards of range 1.
  std::size_t choose(double u, double rounds) const {
    const double arms = static_cast<double>(gains_.size());
    const double eta = std::sqrt(8 * elementary::log(arms) / std::max(rounds, 1.0));
    const double most = *std::max_element(gains_.begin(), gains_.end());
    double total = 0;
    for (const double gain : gains_) total += elementary::exp(eta * (gain - most));
    double left = u * total;
    for (std::size_t arm = 0; arm + 1 < gains_.size(); ++arm) {
      left -= elementary::exp(eta * (gains_[arm] - most));
      if (left < 0) return arm;
    }
    return gains_.size() - 1;
  }
  void reward(std::size_t arm, double gain) { gains_[arm] += gain; }
  const std::vector<double>& gains() const { return gains_; }
  void set_gains(std::vector<double> gains) { gains_ = std::move(gains); }

 private:
  std::vector<double> gains_;
};

}  // namespace coppice
