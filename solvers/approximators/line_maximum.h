#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/vocabulary/approximator.h"
#include "solvers/approximators/forest.h"

namespace coppice {

/// The exact maximum of a forest's mean (of output 0) along the axis of one input. Along a line each tree
/// is a row of pieces, constant or linear, and so is their mean, with a break wherever a tree has one: it is
/// largest at an end of one of its pieces. All descents go down abreast, splitting up where the line is
/// split; then the pieces of all trees are passed in the order in which they begin.
class LineMaximum {
 public:
  /// The largest value over x[along] in [low, high], which is put into x; the other inputs stay as they are.
  double over(const Forest& forest, std::span<double> x, std::size_t along, double low, double high);

 private:
  /// A part of the line, begin < u <= end, and the node of a tree that a descent has reached on it. In two
  /// words: what is written in pieces and soon read as one is read late.
  struct Part {
    std::uint64_t place;  ///< the node, the tree above
    std::uint64_t range;  ///< the bits of begin, those of end above
    std::uint32_t node() const { return static_cast<std::uint32_t>(place); }
    std::uint32_t tree() const { return static_cast<std::uint32_t>(place >> 32); }
    float begin() const { return std::bit_cast<float>(static_cast<std::uint32_t>(range)); }
    float end() const { return std::bit_cast<float>(static_cast<std::uint32_t>(range >> 32)); }
  };
  /// What a leaf adds on its part: bias + slope u, in the end held in [low, high]. Constants: a bias only.
  struct Piece {
    double bias = 0, slope = 0, low = 0, high = 0;
    std::uint32_t tree = 0;
  };

  void find_parts(const Forest& forest, std::span<const double> x);
  void descend(const ForestNode* nodes);
  void add_pieces(const Forest& forest, std::span<const double> x);
  void sort_breaks();
  template <LeafModel kLeaf>
  double best_place(std::size_t trees);

  std::size_t along_ = 0;
  double low_ = 0, high_ = 0;
  std::vector<float> rounded_;                // the inputs
  std::vector<Part> open_, next_, leaves_;    // splits of a depth, of the next one; of any depth
  std::vector<Piece> pieces_;                 // of the leaves
  std::vector<std::uint64_t> breaks_, kept_;  // where a piece begins, and which
  std::vector<std::uint32_t> ends_;           // of the buckets that they are sorted by
  std::vector<Piece> current_;                // of each tree
  std::vector<double> values_;
};

}  // namespace coppice
