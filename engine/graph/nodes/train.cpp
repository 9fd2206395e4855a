#include <fmt/format.h>

#include <stdexcept>

#include "engine/data/table_file.h"
#include "engine/graph/artifacts.h"
#include "engine/graph/nodes/episodes.h"
#include "engine/graph/nodes/progress_table.h"
#include "engine/vocabulary/solver.h"

namespace coppice {
namespace {

/// A training and the rows of its progress, saved and resumed together.
class Learning {
 public:
  Learning(const Solver& solver, const TrainingInputs& inputs, NodeContext& context)
      : context_(context), training_(solver.start(inputs)) {
    std::optional<Archive> saved = context.checkpoint();
    if (!saved) return;
    try {
      load(*saved);
    } catch (const std::runtime_error&) {  // a checkpoint that cannot be read is no loss but of time
      training_ = solver.start(inputs);
      progress_ = {};
    }
  }

  /// Throws Interrupted when the run should stop.
  void run() {
    CheckpointClock clock;
    std::int64_t done = training_->progress().done;
    for (bool more = true; more;) {
      const bool stop = context_.parallel().stop_requested();
      if (stop || clock.due()) clock.save(context_, state());
      if (stop) throw Interrupted();
      more = training_->advance(context_.parallel());
      const TrainingProgress progress = training_->progress();
      if (progress.done == done) continue;  // nothing was left to do
      done = progress.done;
      progress_.add(progress);
      context_.progress(progress.done, progress.total);
    }
    context_.count("iterations", done);
  }

  TrainingResult result() const { return training_->result(); }
  Table progress() const { return progress_.table(); }

 private:
  void load(Archive& archive) {
    {
      const Archive::Scope scope(archive, "training");
      training_->load(archive);
    }
    const Archive::Scope scope(archive, "progress");
    progress_.load(archive);
  }
  Archive state() const {
    Archive archive;
    {
      const Archive::Scope scope(archive, "training");
      training_->save(archive);
    }
    const Archive::Scope scope(archive, "progress");
    progress_.save(archive);
    return archive;
  }

  NodeContext& context_;
  std::unique_ptr<Training> training_;
  ProgressTable progress_;
};

/// What a solver learns: a policy, and for some also a value function.
struct TrainNode : Node {
  Reference problem, value, policy;
  References samples;
  Sub<Solver> solver;

  std::vector<std::string> makes() const override { return {"policy", "function", "progress", "timing"}; }
  bool learns() const override { return true; }
  bool gathers_replicates(std::string_view parameter) const override { return parameter == "samples"; }
  std::vector<std::string> labelled_tables() const override { return {std::string(kProgressFile)}; }

  std::vector<std::string> progress_columns(const NodeContext&) const override {
    return ProgressTable::column_names(solver->measures(!value.id.empty()));
  }

  void check(const NodeContext& context) const override {
    const auto target = load_problem(context.inputs("problem").front());
    Rules rules;
    check_needs(*target, rules);
    check_samples(context.inputs("samples"), rules);
    if (!policy.id.empty())
      rules.check("policy", [&] { load_policy(context.inputs("policy").front(), *target); });
    for (const InputNode& node : context.inputs("samples"))
      rules.check("samples", [&] { require_samples_of(node, *target); });
    rules.check("", [&] { solver->check(target->spaces(), !value.id.empty()); });
    rules.enforce();
  }

  std::shared_ptr<const Spaces> spaces(const NodeContext& context) const override {
    return load_spaces(context.inputs("problem").front());
  }

  void run(NodeContext& context) const override {
    const auto target = load_problem(context.inputs("problem").front());
    const Dataset gathered = gather(context, target->spaces());
    TrainingInputs inputs;
    inputs.problem = target.get();
    if (!samples.empty()) inputs.samples = &gathered;
    if (!value.id.empty())
      inputs.value = load_value_function(context.inputs("value").front(), target->spaces());
    if (!policy.id.empty()) inputs.initial_policy = load_policy(context.inputs("policy").front(), *target);
    inputs.draws = context.draws();

    Learning learning(*solver, inputs, context);
    learning.run();
    write(learning.result(), target->spaces(), context);
    write_table(context.folder() / kProgressFile, learning.progress());
    context.count("samples", static_cast<std::int64_t>(gathered.rows()));
  }

  static Parameters<TrainNode> parameters() {
    using This = TrainNode;
    return node_parameters<This>()
        .reference("problem", &This::problem, "problem", "What the policy is for.")
        .references("samples", &This::samples, "dataset",
                    "Transitions to learn from; those of several nodes are joined.", false)
        .reference("value", &This::value, "function", "A value function learned elsewhere.", false)
        .reference("policy", &This::policy, "policy", "A policy to begin with.", false)
        .direct(&This::solver, "How it is learned.");
  }

 private:
  /// All that the solver lacks, and all that it would not look at.
  void check_needs(const Problem& target, Rules& rules) const {
    const Solver::Needs needs = solver->needs();
    const std::string& name = solver.resolved.name;
    if (needs.samples && samples.empty()) {
      rules.broken("", fmt::format("<{}> learns from samples", name),
                   "give samples=\"...\", a collect or dataset node");
    }
    if (needs.simulator && target.simulator() == nullptr) {
      rules.broken("problem", fmt::format("<{}> needs a problem that can be set to any state; '{}' only "
                                          "offers episodes",
                                          name, problem.id));
    }
    const std::size_t actions = target.spaces().actions.size();
    if (needs.single_action && actions != 1) {
      rules.broken("problem", fmt::format("<{}> can choose the parameters of one action; '{}' has {} actions",
                                          name, problem.id, actions));
    }
    const std::string takes =
        fmt::format("<{}> takes problem, samples{}{}", name, needs.uses_value ? ", value" : "",
                    needs.uses_policy ? ", policy" : "");
    const auto refuse = [&](bool used, std::string_view parameter, const Reference& given) {
      if (used || given.id.empty()) return;
      rules.broken(parameter, fmt::format("<{}> makes no use of {}=\"{}\"", name, parameter, given.id),
                   takes);
    };
    refuse(needs.uses_value, "value", value);
    refuse(needs.uses_policy, "policy", policy);
  }

  /// Episodes that are there twice would count twice.
  static void check_samples(const std::vector<InputNode>& nodes, Rules& rules) {
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const std::string origin = common_origin(nodes[j], nodes[i]);
        if (origin.empty()) continue;
        const std::string hint =
            nodes[i].streams.empty() ? "" : fmt::format("give '{}' a seed_label of its own", nodes[i].id);
        rules.broken("samples", fmt::format("samples '{}' and '{}' {}", nodes[j].id, nodes[i].id, origin),
                     hint);
        break;
      }
    }
  }

  Dataset gather(const NodeContext& context, const Spaces& spaces) const {
    std::vector<Dataset> parts;
    for (const InputNode& node : context.inputs("samples")) parts.push_back(load_dataset(node, spaces));
    return parts.size() == 1 ? std::move(parts.front()) : parts.empty() ? Dataset(spaces, 0) : join(parts);
  }

  static void write(const TrainingResult& result, const Spaces& spaces, NodeContext& context) {
    write_policy(result.policy, spaces, context);
    if (!result.value) return;
    FunctionFile value_file{.writer = {},
                            .provenance = context.key(),
                            .inputs = {},
                            .output = "value",
                            .component = result.value.resolved,
                            .arrays = {}};
    value_file.inputs = value_columns(spaces, result.value->inputs() > spaces.state_size());
    result.value->save(value_file.arrays);
    write_function_file(context.folder() / kValueFile, value_file);
  }
};

const Component<Node, TrainNode> kTrainNode("train", "Learn a policy with a solver.", "no publication");

}  // namespace
}  // namespace coppice
