#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "solvers/approximators/forest.h"

namespace coppice {

/// One step of a descent; in a leaf it stays.
inline std::uint32_t step_down(const ForestNode* nodes, std::uint32_t at, const float* x) {
  const ForestNode node = nodes[at];
  return at + node.ahead() + (x[node.feature()] > node.value ? 1 : 0);
}

/// Leads kSize descents to their leaves, number i with the inputs point(i). Their loads overlap, where one
/// descent after the other would wait for each.
template <std::size_t kSize, class Point>
void descend(const ForestNode* nodes, std::array<std::uint32_t, kSize>& at, const Point& point) {
  std::uint32_t moved;
  do {
    moved = 0;
    for (std::size_t i = 0; i < kSize; ++i) {
      const std::uint32_t next = step_down(nodes, at[i], point(i));
      moved |= next ^ at[i];
      at[i] = next;
    }
  } while (moved != 0);
}

}  // namespace coppice
