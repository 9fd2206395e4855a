#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "engine/data/table_file.h"
#include "engine/graph/artifacts.h"
#include "engine/graph/nodes/action_time.h"
#include "engine/graph/nodes/episodes.h"
#include "engine/statistics/estimates.h"
#include "engine/statistics/intervals.h"

namespace coppice {
namespace {

using Type = ColumnInfo::Type;

/// Keeps the states of one episode, to measure how long actions for them take.
class StateRecorder : public Recorder {
 public:
  void episode(std::size_t, std::uint64_t, const Episode& episode) override { states_ = episode.states; }
  const std::vector<double>& states() const { return states_; }

 private:
  std::vector<double> states_;
};

std::vector<double> numbers(const auto& values) {
  return {values.begin(), values.end()};
}

/// One row about all episodes. The interval is over episodes: those of other training runs are other rows.
Table evaluation_table(const Returns& returns, int horizon, double discount) {
  const double mean_return = mean(returns.total);
  const std::optional<Interval> ci = t_interval(returns.total);
  const auto limit = [&](double Interval::*end) { return ci ? Cell((*ci).*end) : Cell(); };
  Table table;
  std::vector<Cell> row;
  const auto add = [&](std::string name, Type type, Cell cell, std::string doc) {
    table.columns.push_back({std::move(name), type, "", std::move(doc)});
    row.push_back(std::move(cell));
  };
  add("episodes", Type::integer, static_cast<std::int64_t>(returns.total.size()), "Episodes played.");
  add("mean_return", Type::number, mean_return,
      "Mean over the episodes of the sum of rewards, undiscounted.");
  add("mean_cost", Type::number, -mean_return, "Minus mean_return.");
  add("sd", Type::number, standard_deviation(returns.total), "Deviation of an episode's return (n - 1).");
  add("ci95_low", Type::number, limit(&Interval::low),
      "Lower end of Student's 95 % interval of mean_return over the episodes.");
  add("ci95_high", Type::number, limit(&Interval::high), "Upper end of that interval.");
  add("mean_discounted_return", Type::number, mean(returns.discounted),
      "Mean of the discounted sum of rewards.");
  add("mean_steps", Type::number, mean(numbers(returns.steps)), "Mean number of steps of an episode.");
  add("terminal_rate", Type::number, mean(numbers(returns.terminal)),
      "Share of the episodes that ended in a terminal state, before the horizon.");
  add("horizon", Type::integer, static_cast<std::int64_t>(horizon), "Steps of an episode at most.");
  add("discount", Type::number, discount, "Discount of a step, for the discounted return.");
  add("sd_discounted_return", Type::number, standard_deviation(returns.discounted),
      "Deviation of an episode's discounted return (n - 1).");
  add("sd_steps", Type::number, standard_deviation(numbers(returns.steps)),
      "Deviation of an episode's number of steps (n - 1).");
  table.rows.push_back(std::move(row));
  return table;
}

/// A row for each episode: equal scenarios of different policies are paired.
Table returns_table(const Returns& returns) {
  Table table;
  table.columns = {{"scenario", Type::integer, "", "Number of the scenario: the same for every policy."},
                   {"return", Type::number, "", "Sum of rewards."},
                   {"discounted_return", Type::number, "", "Discounted sum of rewards."},
                   {"steps", Type::integer, "", "Steps."},
                   {"terminal", Type::boolean, "", "1: ended in a terminal state."}};
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

  std::vector<std::string> makes() const override { return {"evaluation", "timing"}; }
  std::vector<std::string> labelled_tables() const override { return {std::string(kEvaluationFile)}; }

  void check(const NodeContext& context) const override {
    const auto target = load_problem(context.inputs("problem").front());
    const InputNode& policy = context.inputs("policies").front();
    load_policy(policy, *target);
    if (std::find(policy.streams.begin(), policy.streams.end(), context.stream()) != policy.streams.end()) {
      throw std::invalid_argument(
          fmt::format("policy '{}' was made with the very draws ({}) that would judge it; give this node a "
                      "seed_label of its own",
                      policy.id, context.stream()));
    }
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
    context.measure("episode_s", thread_seconds() - begin);
    context.measure("action_s", action_time(policy, recorder.states(), state_size, context.draws()));
  }
};

const Component<Node, EvaluateNode> kComponent("evaluate",
                                               "Estimate returns and costs of policies on a problem.",
                                               "no publication");

}  // namespace
}  // namespace coppice
