#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "engine/data/table_file.h"
#include "engine/graph/artifacts.h"
#include "engine/graph/nodes/criterion.h"
#include "engine/graph/nodes/episodes.h"
#include "engine/statistics/estimates.h"

namespace coppice {
namespace {

/// The best of several policies, the replicates of a training for instance, on scenarios that are the same
/// for all of them and that none was made with. Its return there is the largest of several estimates, so it
/// flatters: an evaluation, whose scenarios are others again, says what the policy is worth.
struct SelectNode : Node {
  Reference problem;
  References policies;
  std::int64_t episodes = 0;
  std::optional<int> horizon;
  std::optional<double> discount;
  Criterion criterion = Criterion::returns;

  std::vector<std::string> makes() const override { return {"policy", "selection", "timing"}; }
  bool gathers(std::string_view parameter) const override { return parameter == "policies"; }
  std::optional<InputTable> input_table() const override {
    return InputTable{std::string(kSelectionFile), "policies"};
  }

  void check(const NodeContext& context) const override {
    const auto target = load_problem(context.inputs("problem").front());
    Rules rules;
    for (const InputNode& policy : context.inputs("policies")) {
      rules.check("policies", [&] { load_named(policy, *target); });
      rules.check("policies", [&] { require_other_draws(policy, context); });
    }
    rules.enforce();
  }

  std::shared_ptr<const Spaces> spaces(const NodeContext& context) const override {
    return load_spaces(context.inputs("problem").front());
  }

  void run(NodeContext& context) const override {
    const auto target = load_problem(context.inputs("problem").front());
    std::vector<Returns> played;
    std::vector<double> values;
    for (const InputNode& input : context.inputs("policies")) {
      const MadePolicy policy = load_policy(input, *target);
      played.push_back(play(*target, *policy, context));
      values.push_back(criterion_value(played.back(), criterion));
    }
    const auto best =
        static_cast<std::size_t>(std::max_element(values.begin(), values.end()) - values.begin());
    write_policy(load_policy(context.inputs("policies")[best], *target), target->spaces(), context);
    write_table(context.folder() / kSelectionFile, selection(played, best));
  }

  static Parameters<SelectNode> parameters() {
    using This = SelectNode;
    return node_parameters<This>()
        .reference("problem", &This::problem, "problem", "Where to act.")
        .references("policies", &This::policies, "policy",
                    "Policies to choose from: all replicates of each, and all its sweep points that are not "
                    "this node's.")
        .require("episodes", &This::episodes, "", "Number of episodes of each policy.", at_least(1))
        .automatic("horizon", &This::horizon, "", "Steps of an episode at most; auto: the problem's.",
                   at_least(1))
        .automatic("discount", &This::discount, "",
                   "Discount of a step, for the discounted return; auto: the problem's.", between(0, 1))
        .choice("criterion", &This::criterion, criterion_names(),
                "Of what the mean over episodes decides; of equal ones the first is taken.");
  }

 private:
  /// As load_policy; of several, the message says which it is about.
  static void load_named(const InputNode& policy, const Problem& target) {
    try {
      load_policy(policy, target);
    } catch (const std::invalid_argument& why) {
      const std::string what = why.what();
      const bool named = what.find("'" + policy.id + "'") != std::string::npos;
      throw std::invalid_argument(named ? what : fmt::format("policy '{}': {}", policy.id, what));
    }
  }

  Returns play(const Problem& target, const Policy& policy, NodeContext& context) const {
    Simulation simulation;
    simulation.policy = &policy;
    simulation.rollouts = static_cast<std::size_t>(episodes);
    simulation.horizon = horizon.value_or(target.horizon());
    simulation.discount = discount.value_or(target.discount());
    EpisodeRun run(target, simulation, context, false);
    run.finish();
    std::int64_t steps = 0;
    for (const std::int32_t n : run.returns().steps) steps += n;
    context.count("episodes", episodes);
    context.count("steps", steps);
    return run.returns();
  }

  /// Who the rows stand for is added where the run shows them: the policy must not depend on names.
  static Table selection(const std::vector<Returns>& played, std::size_t best) {
    using Type = ColumnInfo::Type;
    Table table;
    table.columns = {{"episodes", Type::integer, "", "Episodes played."},
                     {"mean_return", Type::number, "", "Mean sum of rewards in them."},
                     {"mean_discounted_return", Type::number, "", "Mean discounted sum of rewards."},
                     {"sd", Type::number, "", "Deviation of an episode's return (n - 1)."},
                     {"selected", Type::boolean, "", "1: the one that was taken."}};
    for (std::size_t i = 0; i < played.size(); ++i) {
      table.rows.push_back({static_cast<std::int64_t>(played[i].total.size()), mean(played[i].total),
                            mean(played[i].discounted), standard_deviation(played[i].total),
                            std::int64_t{i == best}});
    }
    return table;
  }
};

const Component<Node, SelectNode> kSelectNode(
    "select", "Take the best of several policies, judged on scenarios of its own.", "no publication", 2);

}  // namespace
}  // namespace coppice
