#pragma once

#include <span>

#include "engine/vocabulary/policy.h"

namespace coppice {

/// CPU seconds of the calling thread.
double thread_seconds();

/// CPU seconds that a policy takes for an action: the median over rounds of about 0.2 ms, each going through
/// an episode's states (one after the other, at least two, the last being where it ended).
double action_time(const Policy& policy, std::span<const double> states, std::size_t state_size,
                   const Draws& draws);

}  // namespace coppice
