#pragma once

#include <vector>

#include "engine/cli/policy_inputs.h"

namespace coppice::cli {

/// Wall time of single actions on this machine, over states spread over the state space; s.
struct Latency {
  double median = 0;
  double p99 = 0;
  double worst_state = 0;  ///< the largest over states of each state's median
};
/// Actions of a policy whose state space is bounded. What reading the clock takes is subtracted.
Latency measure_latency(const ReadyPolicy& ready);

/// For each state axis, the part of the actions' variance that is lost on who does not know it: the
/// total-effect index of Homma and Saltelli (1996), by Jansen's estimator (1999), for states uniform over the
/// state space. Variances of the parameters, in units of their boxes' widths, and of which action it is are
/// added. 0: the policy does not depend on the axis; the sum is at least 1. Empty for a constant policy, or
/// where the state space has no limits. Same policy, same numbers. Actions of policies that draw or remember
/// are those of a new episode.
std::vector<double> importance(const ReadyPolicy& ready);

}  // namespace coppice::cli
