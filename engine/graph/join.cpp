#include "engine/graph/join.h"

#include <algorithm>

namespace coppice {

const std::string* value_of(const Point& point, std::string_view column) {
  const auto found =
      std::find_if(point.begin(), point.end(), [&](const PointValue& v) { return v.first == column; });
  return found == point.end() ? nullptr : &found->second;
}

JoinIndex::JoinIndex(const std::vector<SweepPoints>& sweeps) {
  for (const SweepPoints& sweep : sweeps) columns_[sweep.id] = sweep.columns;
}

void JoinIndex::add(std::size_t declared, std::size_t node, const Standing& standing) {
  std::vector<Family>& families = families_[declared];
  auto family = std::find_if(families.begin(), families.end(), [&](const Family& f) {
    return f.sweeps == standing.sweeps && f.replicated == standing.replicate.has_value();
  });
  if (family == families.end()) {
    family =
        families.insert(families.end(), Family{standing.sweeps, standing.replicate.has_value(), {}, {}, {}});
  }
  family->nodes.push_back(node);
  family->standings.push_back(standing);
  family->tables.clear();
}

std::vector<std::size_t> JoinIndex::find(std::size_t declared, const Standing& reader) {
  std::vector<std::size_t> found;
  for (Family& family : families_[declared]) {
    std::vector<std::string> shared;
    for (const std::string& sweep : family.sweeps) {
      if (std::find(reader.sweeps.begin(), reader.sweeps.end(), sweep) != reader.sweeps.end())
        shared.push_back(sweep);
    }
    const bool by_replicate = family.replicated && reader.replicate.has_value();
    Table& table = family.tables[{shared, by_replicate}];
    if (table.empty()) {
      for (std::size_t i = 0; i < family.nodes.size(); ++i) {
        table[text(shared, family.standings[i], by_replicate)].push_back(family.nodes[i]);
      }
    }
    const auto match = table.find(text(shared, reader, by_replicate));
    if (match != table.end()) found.insert(found.end(), match->second.begin(), match->second.end());
  }
  std::sort(found.begin(), found.end());  // planned nodes are numbered in the order they were added
  return found;
}

bool JoinIndex::empty(std::size_t declared) const {
  return !families_.contains(declared);
}

std::string JoinIndex::text(const std::vector<std::string>& sweeps, const Standing& standing,
                            bool by_replicate) const {
  std::string result;
  for (const std::string& sweep : sweeps) {
    const auto columns = columns_.find(sweep);
    if (columns == columns_.end()) continue;
    for (const std::string& column : columns->second) {
      const std::string* value = value_of(standing.point, column);
      if (value != nullptr) result.append(*value);
      result += '\x1f';
    }
  }
  if (by_replicate) result += std::to_string(*standing.replicate);
  return result;
}

}  // namespace coppice
