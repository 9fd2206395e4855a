#pragma once

#include "engine/graph/declared.h"
#include "engine/graph/plan.h"

namespace coppice {

/// Lets every planned node check itself with the elements of its inputs, and notes what these tell of its
/// columns and spaces. Mistakes go to `diagnostics`.
void check_nodes(const Declarations& declarations, Plan& plan, Diagnostics& diagnostics);

}  // namespace coppice
