#pragma once

#include <string>
#include <vector>

#include "engine/statistics/estimates.h"
#include "engine/vocabulary/rollout.h"

namespace coppice {

/// Which mean over episodes decides between policies.
enum class Criterion { returns, discounted_return };

/// As users write them, in the order of the enumeration.
inline std::vector<std::string> criterion_names() {
  return {"return", "discounted_return"};
}

inline double criterion_value(const Returns& returns, Criterion criterion) {
  return mean(criterion == Criterion::returns ? returns.total : returns.discounted);
}

}  // namespace coppice
