#pragma once

#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "engine/config/experiment.h"

namespace coppice {

/// Where a node stands: in which sweeps, at which point, which replicate.
struct Standing {
  std::vector<std::string> sweeps;
  Point point;
  std::optional<int> replicate;
};

/// Finds the planned nodes that a reader at some standing joins with: equal in the columns of the sweeps they
/// share, and of the same replicate where both have one. Takes constant time for each node found.
class JoinIndex {
 public:
  explicit JoinIndex(const std::vector<SweepPoints>& sweeps);

  /// Planned node `node` comes from declared node `declared`.
  void add(std::size_t declared, std::size_t node, const Standing& standing);
  /// In the order they were added.
  std::vector<std::size_t> find(std::size_t declared, const Standing& reader);
  /// True when the declared node has no planned nodes at all.
  bool empty(std::size_t declared) const;

 private:
  using Table = std::unordered_map<std::string, std::vector<std::size_t>>;
  /// Planned nodes of one declared node with the same sweeps, all with or all without replicate.
  struct Family {
    std::vector<std::string> sweeps;
    bool replicated = false;
    std::vector<std::size_t> nodes;
    std::vector<Standing> standings;
    std::map<std::pair<std::vector<std::string>, bool>, Table>
        tables;  ///< by shared sweeps, and by replicate or not
  };

  std::string text(const std::vector<std::string>& sweeps, const Standing& standing, bool by_replicate) const;

  std::map<std::string, std::vector<std::string>, std::less<>> columns_;
  std::map<std::size_t, std::vector<Family>> families_;
};

/// The value of a column; null when the point has none.
const std::string* value_of(const Point& point, std::string_view column);

}  // namespace coppice
