#include "engine/vocabulary/policy.h"

#include <algorithm>

namespace coppice {

void Policy::reset(std::span<double> memory) const {
  std::fill(memory.begin(), memory.end(), 0.0);
}

}  // namespace coppice
