#include "engine/graph/nodes/policy_target.h"

#include <utility>

#include "engine/graph/artifacts.h"

namespace coppice {

PolicyTarget::PolicyTarget(TunedPolicy tuned, std::shared_ptr<const Problem> problem,
                           const PolicyTrial& trial, const Draws& draws)
    : tuned_(std::move(tuned)), problem_(std::move(problem)), trial_(trial), draws_(draws) {
  prepared(tuned_.configured());
}

MadePolicy PolicyTarget::prepared(std::span<const double> numbers) const {
  Diagnostics diagnostics;
  MadePolicy made = make<Policy>(tuned_.at(numbers), diagnostics);
  diagnostics.throw_if_any();
  made.object->prepare(problem_->spaces(), problem_->simulator());
  return made;
}

double PolicyTarget::value(std::span<const double> x, std::uint64_t scenario, Parallel& parallel) const {
  const MadePolicy policy = prepared(x);
  Simulation simulation;
  simulation.policy = policy.object.get();
  simulation.rollouts = static_cast<std::size_t>(trial_.episodes);
  simulation.horizon = trial_.horizon.value_or(problem_->horizon());
  simulation.discount = trial_.discount.value_or(problem_->discount());
  simulation.first_scenario = scenario * static_cast<std::uint64_t>(trial_.episodes);
  return criterion_value(problem_->episodes(simulation, draws_, parallel), trial_.criterion);
}

void PolicyTarget::write(std::span<const double> best, std::int64_t evaluations, NodeContext& context) const {
  context.count("episodes", evaluations * trial_.episodes);
  write_policy(prepared(best), problem_->spaces(), context);
}

}  // namespace coppice
