#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "engine/graph/artifacts.h"
#include "engine/graph/nodes/episodes.h"

namespace coppice {
namespace {

/// A dataset of transitions: episodes of a policy, or single steps from states and actions drawn uniformly
/// (as for the car on the hill: thesis 2.2.2; Ernst, Geurts and Wehenkel 2005).
struct CollectNode : Node {
  static constexpr const char* kExample =
      "<collect id=\"samples\" problem=\"my_problem\" policy=\"my_policy\" episodes=\"100\"/>";

  using Node::check;

  Reference problem, policy;
  std::int64_t episodes = 0;
  std::int64_t samples = 0;
  std::optional<int> horizon;

  std::vector<std::string> makes() const override { return {"dataset", "timing"}; }

  void check() const {
    if ((episodes > 0) == (samples > 0)) {
      throw std::invalid_argument(
          "give either episodes, with a policy, or samples, a number of uniformly drawn transitions");
    }
    Rules rules;
    if ((episodes > 0) == policy.id.empty()) {
      if (episodes > 0)
        rules.broken("episodes", "episodes need a policy");
      else
        rules.broken("policy", "samples are drawn uniformly, without a policy");
    }
    if (samples > 0 && horizon) rules.broken("horizon", "uniform samples are single steps: no horizon");
    rules.enforce();
  }

  void check(const NodeContext& context) const override {
    const auto target = load_problem(context.inputs("problem").front());
    Rules rules;
    if (episodes > 0) {
      rules.check("policy", [&] { load_policy(context.inputs("policy").front(), *target); });
    } else {
      check_uniform(*target, rules);
    }
    rules.enforce();
  }

  std::vector<std::string> dataset_columns(const NodeContext& context) const override {
    return dataset_column_names(load_problem(context.inputs("problem").front())->spaces());
  }

  std::shared_ptr<const Spaces> spaces(const NodeContext& context) const override {
    return load_spaces(context.inputs("problem").front());
  }

  void run(NodeContext& context) const override {
    const auto target = load_problem(context.inputs("problem").front());
    const Dataset dataset = episodes > 0 ? play(*target, context) : sample(*target, context);
    context.count("steps", static_cast<std::int64_t>(dataset.rows()));
    write_dataset(context.folder() / kDatasetFile, dataset);
  }

  static Parameters<CollectNode> parameters() {
    using This = CollectNode;
    return node_parameters<This>()
        .reference("problem", &This::problem, "problem", "Where to act.")
        .reference("policy", &This::policy, "policy", "Who acts in the episodes.", false)
        .add("episodes", &This::episodes, "", "Number of episodes.", at_least(0))
        .automatic("horizon", &This::horizon, "", "Steps of an episode at most; auto: the problem's.",
                   at_least(1))
        .add("samples", &This::samples, "",
             "Instead of episodes: number of single steps from states and actions drawn uniformly.",
             at_least(0));
  }

 private:
  Dataset play(const Problem& target, NodeContext& context) const {
    const MadePolicy acting = load_policy(context.inputs("policy").front(), target);
    const auto count = static_cast<std::size_t>(episodes);
    DatasetRecorder recorder(target.spaces(), count);
    Simulation simulation;
    simulation.policy = acting.object.get();
    simulation.rollouts = count;
    simulation.horizon = horizon.value_or(target.horizon());
    simulation.recorder = &recorder;
    EpisodeRun(target, simulation, context, false).finish();
    context.count("episodes", episodes);
    return recorder.dataset();
  }

  Dataset sample(const Problem& target, NodeContext& context) const {
    const auto count = static_cast<std::size_t>(samples);
    const Spaces& spaces = target.spaces();
    Matrix states(count, spaces.state_size());
    std::vector<Action> actions(count);
    for (std::size_t i = 0; i < count; ++i) {
      const Draws draws = context.draws().fork("uniform_sample").scenario(i);
      for (std::size_t d = 0; d < spaces.state_size(); ++d)
        states(i, d) = uniform(draws, "state", spaces.states, d);
      actions[i].id = static_cast<int>(draws.below("action", spaces.actions.size()));
      const Space& axes = spaces.actions[static_cast<std::size_t>(actions[i].id)].axes;
      actions[i].values.resize(axes.size());
      for (std::size_t d = 0; d < axes.size(); ++d)
        actions[i].values[d] = uniform(draws, "parameter", axes, d);
    }
    DatasetRecorder recorder(spaces, count);
    Simulation simulation;
    simulation.rollouts = count;
    simulation.horizon = 1;
    simulation.starts = &states;
    simulation.first_actions = actions;
    simulation.recorder = &recorder;
    target.simulator()->simulate(simulation, context.draws(), context.parallel());
    return recorder.dataset();
  }

  static double uniform(const Draws& draws, Purpose purpose, const Space& axes, std::size_t d) {
    return draws.uniform(purpose, axes[d].low, axes[d].high, static_cast<std::uint32_t>(d));
  }

  static void check_uniform(const Problem& target, Rules& rules) {
    if (target.simulator() == nullptr) {
      rules.broken("problem", "the problem only offers episodes: it cannot be set to uniform samples");
    }
    const auto bounded = [&](const Space& axes, std::string_view what) {
      for (const Axis& axis : axes) {
        if (std::isfinite(axis.low) && std::isfinite(axis.high)) continue;
        rules.broken("problem",
                     fmt::format("'{}' of {} has no limits: uniform samples need them", axis.name, what));
      }
    };
    bounded(target.spaces().states, "the state");
    for (const ActionBox& box : target.spaces().actions) bounded(box.axes, "action '" + box.name + "'");
  }
};

const Component<Node, CollectNode> kCollectNode(
    "collect", "Collect transitions: episodes of a policy, or uniform samples.", "no publication");

}  // namespace
}  // namespace coppice
