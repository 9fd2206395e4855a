#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "engine/data/table_file.h"
#include "engine/graph/artifacts.h"
#include "engine/graph/nodes/action_time.h"
#include "engine/graph/nodes/episodes.h"
#include "engine/graph/nodes/evaluation_table.h"

namespace coppice {
namespace {

/// Keeps the states of one episode, to measure how long actions for them take.
class StateRecorder : public Recorder {
 public:
  void episode(std::size_t, std::uint64_t, const Episode& episode) override { states_ = episode.states; }
  const std::vector<double>& states() const { return states_; }

 private:
  std::vector<double> states_;
};

/// A row for each episode: equal scenarios of different policies are paired.
Table returns_table(const Returns& returns) {
  Table table;
  table.columns = {
      {"scenario", ColumnInfo::Type::integer, "", "Number of the scenario: the same for every policy."},
      {"return", ColumnInfo::Type::number, "", "Sum of rewards."},
      {"discounted_return", ColumnInfo::Type::number, "", "Discounted sum of rewards."},
      {"steps", ColumnInfo::Type::integer, "", "Steps."},
      {"terminal", ColumnInfo::Type::boolean, "", "1: ended in a terminal state."}};
  for (std::size_t i = 0; i < returns.total.size(); ++i) {
    table.rows.push_back({static_cast<std::int64_t>(i), returns.total[i], returns.discounted[i],
                          std::int64_t{returns.steps[i]}, std::int64_t{returns.terminal[i]}});
  }
  return table;
}

/// Plays episodes of a policy from the problem's own starts. Scenario k of replicate r is the same whatever
/// the policy.
struct EvaluateNode : Node {
  Reference problem;
  References policies;
  std::int64_t episodes = 0;
  std::optional<int> horizon;
  std::optional<double> discount;
  bool returns = true;

  std::vector<std::string> makes() const override { return {"evaluation", "score", "timing"}; }
  std::vector<std::string> labelled_tables() const override { return {std::string(kEvaluationFile)}; }

  void check(const NodeContext& context) const override {
    const auto target = load_problem(context.inputs("problem").front());
    const InputNode& policy = context.inputs("policies").front();
    Rules rules;
    rules.check("policies", [&] { load_policy(policy, *target); });
    rules.check("policies", [&] { require_other_draws(policy, context); });
    rules.enforce();
  }

  void run(NodeContext& context) const override {
    const auto target = load_problem(context.inputs("problem").front());
    const MadePolicy policy = load_policy(context.inputs("policies").front(), *target);
    Simulation simulation;
    simulation.policy = policy.object.get();
    simulation.rollouts = static_cast<std::size_t>(episodes);
    simulation.horizon = horizon.value_or(target->horizon());
    simulation.discount = discount.value_or(target->discount());
    EpisodeRun play(*target, simulation, context, true);
    if (play.done() == 0) measure_first(play, *policy, target->spaces().state_size(), context);
    play.finish();
    std::int64_t steps = 0;
    for (const std::int32_t n : play.returns().steps) steps += n;
    context.count("episodes", episodes);
    context.count("steps", steps);
    write_table(context.folder() / kEvaluationFile,
                evaluation_table(play.returns(), simulation.horizon, simulation.discount));
    if (returns) write_table(context.folder() / kReturnsFile, returns_table(play.returns()));
  }

  static Parameters<EvaluateNode> parameters() {
    using This = EvaluateNode;
    return node_parameters<This>()
        .reference("problem", &This::problem, "problem", "Where to act.")
        .references("policies", &This::policies, "policy", "Who acts; each is evaluated on its own.", true,
                    true)
        .require("episodes", &This::episodes, "", "Number of episodes.", at_least(1))
        .automatic("horizon", &This::horizon, "", "Steps of an episode at most; auto: the problem's.",
                   at_least(1))
        .automatic("discount", &This::discount, "",
                   "Discount of a step, for the discounted return; auto: the problem's.", between(0, 1))
        .add("returns", &This::returns, "",
             "Whether to keep the return of each episode (returns.csv), as paired comparisons need it.");
  }

 private:
  /// The first episode runs alone, on this thread, to measure what an episode and an action take.
  static void measure_first(EpisodeRun& play, const Policy& policy, std::size_t state_size,
                            NodeContext& context) {
    StateRecorder recorder;
    Serial serial;
    const double begin = thread_seconds();
    play.advance(1, serial, &recorder);
    context.measure("episode", thread_seconds() - begin);
    context.measure("action", action_time(policy, recorder.states(), state_size, context.draws()));
  }
};

const Component<Node, EvaluateNode> kEvaluateNode("evaluate",
                                                  "Estimate returns and costs of policies on a problem.",
                                                  "no publication", 3);

}  // namespace
}  // namespace coppice
