#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace coppice {

struct ForestNode;

/// The first six levels of a tree, once more, laid out so that three of them are passed at a time: seven
/// thresholds are compared at once, and the results choose among eight exits. A call of a forest goes through
/// all of its nodes, and these are the ones that all calls meet; 640 bytes a tree.
struct alignas(32) TreeTop {
  static constexpr std::size_t kBlocks = 9;  ///< the root's, then those that its exits lead to
  static constexpr std::size_t kExits = 8;

  /// Of three levels, in the order of a heap; infinity where the tree has ended. The eighth is not used.
  std::array<std::array<float, 8>, kBlocks> thresholds;
  std::array<std::array<std::uint8_t, 8>, kBlocks> features;
  std::array<std::uint32_t, kExits * kExits> exits;  ///< nodes of the forest

  friend bool operator==(const TreeTop&, const TreeTop&) = default;
};

/// The top of the tree that has its root there.
TreeTop make_top(const ForestNode* nodes, std::uint32_t root);

/// Sets `places` to the nodes by which a point leaves the tops of `size` trees. `x` are its features, rounded
/// up (see forest.h), in room for 16 at least.
using DescendTops = void (*)(const TreeTop* tops, std::size_t size, const float* x, std::uint64_t* places);

/// The fastest for this processor and points of so many features. See tree_kernels for COPPICE_KERNELS.
DescendTops top_descent(std::size_t features);
/// All that this processor can run for points of so many features.
std::vector<DescendTops> usable_top_descents(std::size_t features);

}  // namespace coppice
