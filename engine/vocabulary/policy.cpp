#include "engine/vocabulary/policy.h"

#include <algorithm>
#include <stdexcept>

namespace coppice {

void Policy::reset(std::span<double> memory) const {
  std::fill(memory.begin(), memory.end(), 0.0);
}

PolicyModel Policy::exported() const {
  throw std::invalid_argument(
      "decides by a program of its own, which is no constant, linear function or forest");
}

}  // namespace coppice
