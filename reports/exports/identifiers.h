#pragma once

#include <string>
#include <vector>

#include "engine/vocabulary/space.h"

namespace coppice {

/// Different C++ identifiers for the axes, as near to their names as can be.
std::vector<std::string> identifiers(const Space& axes);

}  // namespace coppice
