#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/vocabulary/approximator.h"
#include "solvers/approximators/forest.h"

namespace coppice {

// Operations on regression trees (thesis, 2.1.6 to 2.1.9 and Algorithm 14). Results go to trees that the
// caller holds, whose memory is used again: in a loop nothing is allocated.
//
// Oblique splits are projected and averaged as exactly as others are. What needs the leaves' parts of the box
// (pruning, best leaves) throws std::invalid_argument where these are no boxes.

/// The hyperrectangle that a tree is looked at in: low <= x <= high. Sides may be infinite, except for
/// pruning.
struct Box {
  std::vector<double> low;
  std::vector<double> high;

  /// All of R^n.
  static Box everything(std::size_t inputs);
};

/// A forest's tree as a function of its last inputs, the first ones fixed to `prefix` (Algorithm 8), without
/// the parts that cannot be reached in `box` (a box of the last inputs). Exact. Oblique splits of which one
/// input is left become splits of that input.
void project(const ForestTree& tree, std::span<const double> prefix, const Box& box, Tree& out);

/// (w1 t1 + w2 t2) / (w1 + w2) in `box`, of two trees over the same inputs (Algorithm 9); exact. Leaves of
/// different kinds give linear ones (Eqs. 2.6 to 2.8). Where both have oblique splits, some leaves may have
/// no point in the box. With `shares`: of each split also the part of its volume that its low side has.
void weighted_average(const Tree& t1, const Tree& t2, double w1, double w2, const Box& box, Tree& out);
void weighted_average(const Tree& t1, const Tree& t2, double w1, double w2, const Box& box, Tree& out,
                      std::vector<double>& shares);

/// Makes leaves of preleaves, the one with the least loss first, until at most `max_leaves` (at least 1) are
/// left (Algorithms 10 and 11). A new leaf is the mean of the old two by volume; the loss is the integral of
/// the absolute difference over the preleaf's part of the box (Eq. 2.9). Sides of the box without width do
/// not count in volumes.
void prune(Tree& tree, const Box& box, std::size_t max_leaves);
/// The same; `shares` are those of a weighted average that `tree` is.
void prune(Tree& tree, const Box& box, std::size_t max_leaves, std::span<const double> shares);

/// Throws std::invalid_argument unless the leaves' parts of a box are boxes: for trees with oblique splits.
void check_boxes(const Tree& tree);

/// Removes the nodes and models that pruning has cut off.
void drop_unused(Tree& tree);

/// One tree for the mean of several, of at most `max_leaves` leaves (Algorithm 12).
void merge(std::span<const Tree> trees, const Box& box, std::size_t max_leaves, Tree& out);

/// The leaf with the largest value in the box: of a constant the centre of its part of the box, of a linear
/// model the corner where it is largest (Algorithm 14, line 9), just inside where a split excludes it. Of
/// equal leaves the first from the low side.
Maximum best_leaf(const Tree& tree, const Box& box);

std::size_t count_leaves(const Tree& tree);  ///< Algorithm 3; 1 for a single leaf

}  // namespace coppice
