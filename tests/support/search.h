#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "engine/vocabulary/elementary.h"
#include "engine/vocabulary/optimizer.h"

namespace coppice {

/// All evaluations of a search, in order.
struct SearchRecord {
  std::vector<std::vector<double>> points;
  std::vector<std::uint64_t> scenarios;
  std::vector<double> values;
  std::size_t outside = 0;  ///< candidates outside the box
};

inline bool is_inside(const Space& box, std::span<const double> x) {
  if (x.size() != box.size()) return false;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!(x[i] >= box[i].low && x[i] <= box[i].high)) return false;
  }
  return true;
}

using SearchedFunction = std::function<double(std::span<const double> x, std::uint64_t scenario)>;

/// One ask and tell; false when the search is over.
inline bool run_search_step(Search& search, const SearchTask& task, std::int64_t limit,
                            const SearchedFunction& function, SearchRecord& record) {
  const Candidates candidates = search.ask(limit);
  std::vector<double> x(task.box.size()), values;
  for (std::size_t i = 0; i < candidates.points.rows(); ++i) {
    candidates.points.row(i, x);
    record.outside += is_inside(task.box, x) ? 0 : 1;
    record.points.push_back(x);
    record.scenarios.push_back(candidates.scenarios[i]);
    values.push_back(function(x, candidates.scenarios[i]));
  }
  record.values.insert(record.values.end(), values.begin(), values.end());
  if (values.empty()) return false;
  search.tell(values);
  return true;
}

/// To its end.
inline SearchRecord run_search(Search& search, const SearchTask& task, std::int64_t limit,
                               const SearchedFunction& function) {
  SearchRecord record;
  while (run_search_step(search, task, limit, function, record)) {
  }
  return record;
}

}  // namespace coppice
