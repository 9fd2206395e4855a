#pragma once

#include <cstddef>

#include "engine/vocabulary/approximator.h"
#include "engine/vocabulary/dataset.h"

namespace coppice {

/// `count` transitions of a model that is fitted to `samples`, from states and actions drawn uniformly in
/// their boxes (as in Dyna: Sutton 1990). The model holds the change of state, the reward of steps that go on
/// and of those that end, all by state and action, and by the next state whether the episode ends there. It
/// holds means: noise of the problem is averaged out, not reproduced. Only the first kind of action is used.
/// Throws std::invalid_argument when an axis has no finite limits to draw between.
Dataset model_transitions(const Dataset& samples, const Approximator& model, std::size_t count,
                          const Draws& draws, Parallel& parallel);

}  // namespace coppice
