#pragma once

#include <memory>
#include <optional>

#include "engine/graph/nodes/criterion.h"
#include "engine/graph/nodes/search_target.h"
#include "engine/graph/nodes/tuned_policy.h"
#include "engine/vocabulary/policy.h"
#include "engine/vocabulary/problem.h"

namespace coppice {

/// How a policy is judged.
struct PolicyTrial {
  std::int64_t episodes = 1;
  std::optional<int> horizon;      ///< none: the problem's
  std::optional<double> discount;  ///< none: the problem's
  Criterion criterion = Criterion::returns;
};

/// How well a policy does with these numbers: a mean over episodes of scenarios of its own.
class PolicyTarget : public SearchTarget {
 public:
  /// Throws std::invalid_argument or ConfigError for a policy that does not suit the problem.
  PolicyTarget(TunedPolicy tuned, std::shared_ptr<const Problem> problem, const PolicyTrial& trial,
               const Draws& draws);

  const Space& box() const override { return tuned_.box(); }
  std::vector<double> guess() const override { return tuned_.configured(); }
  bool noisy() const override { return true; }
  double value(std::span<const double> x, std::uint64_t scenario, Parallel& parallel) const override;
  /// The policy with the best numbers.
  void write(std::span<const double> best, std::int64_t evaluations, NodeContext& context) const override;

 private:
  MadePolicy prepared(std::span<const double> numbers) const;

  const TunedPolicy tuned_;
  const std::shared_ptr<const Problem> problem_;
  const PolicyTrial trial_;
  const Draws draws_;
};

}  // namespace coppice
