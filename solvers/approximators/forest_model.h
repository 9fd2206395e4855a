#pragma once

#include "engine/vocabulary/policy_model.h"
#include "solvers/approximators/forest.h"

namespace coppice {

/// The forest as plain arrays: predicts the same bits as Forest::predict.
ForestModel exported_forest(const Forest& forest);

}  // namespace coppice
