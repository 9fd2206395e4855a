#include <fmt/format.h>

#include <stdexcept>

#include "engine/data/table_file.h"
#include "engine/graph/artifacts.h"
#include "engine/graph/nodes/objective_target.h"
#include "engine/graph/nodes/policy_target.h"
#include "engine/graph/nodes/search_tables.h"
#include "engine/graph/nodes/tuning.h"

namespace coppice {
namespace {

/// Looks for the numbers with which a configured policy does best, or a test function is largest.
struct OptimizeNode : Node {
  static constexpr const char* kExample =
      "<optimize id=\"tuned\" problem=\"car\" policy=\"by_hand\" parameters=\"gains\" "
      "budget=\"300\"><cma_es/></optimize>";

  using Node::check;

  Reference problem, policy, objective;
  std::vector<std::string> free;
  std::vector<double> low, high, start_low, start_high;
  std::vector<double> targets = {1e1, 1, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8};
  std::optional<double> stop_gap;
  std::int64_t budget = 0;
  std::int64_t episodes = 1;
  std::optional<int> horizon;
  std::optional<double> discount;
  Criterion criterion = Criterion::returns;
  std::optional<bool> common_scenarios, noisy;
  Sub<Optimizer> optimizer;

  std::vector<std::string> makes() const override {
    if (of_objective()) return {"search", "progress", "timing"};
    return {"policy", "search", "progress", "timing"};
  }
  bool learns() const override { return !of_objective(); }
  std::vector<std::string> labelled_tables() const override {
    std::vector<std::string> tables;
    for (const std::string_view file : {kProgressFile, kOptimumFile, kSearchFile, kImprovementsFile})
      tables.emplace_back(file);
    if (of_objective()) tables.emplace_back(kTargetsFile);
    return tables;
  }
  std::vector<std::string> progress_columns(const NodeContext& context) const override {
    const bool known = of_objective() && target(context)->optimum();
    return ProgressTable::column_names(Tuning::measures(*optimizer, known));
  }
  std::shared_ptr<const Spaces> spaces(const NodeContext& context) const override {
    return of_objective() ? nullptr : load_spaces(context.inputs("problem").front());
  }

  void check() const {
    if (!of_objective()) {
      Rules rules;
      if (problem.id.empty() || policy.id.empty() || free.empty())
        rules.broken("", "give a problem, a policy and its parameters to tune, or an objective");
      if (stop_gap) rules.broken("stop_gap", "stop_gap is of objectives, whose optimum is known");
      rules.enforce();
      return;
    }
    const PolicyTrial unused;
    if (!problem.id.empty() || !policy.id.empty() || !free.empty() || episodes != unused.episodes ||
        horizon || discount || criterion != unused.criterion) {
      throw std::invalid_argument(
          "an objective makes no use of problem, policy, parameters, episodes, horizon, discount, criterion");
    }
  }
  void check(const NodeContext& context) const override {
    Rules rules;
    if (!of_objective()) {
      rules.check("policy", [&] {
        configured_policy(context);
        load_policy(context.inputs("policy").front(), *load_problem(context.inputs("problem").front()));
      });
      rules.enforce();
    }
    std::unique_ptr<const SearchTarget> sought;
    rules.check(of_objective() ? "objective" : "parameters", [&] { sought = target(context); });
    rules.enforce();
    if (stop_gap && !sought->optimum())
      rules.broken("stop_gap", "stop_gap is of objectives whose optimum is known");
    rules.check("", [&] { optimizer->start(task(*sought, context)); });
    rules.enforce();
  }

  void run(NodeContext& context) const override {
    const auto sought = target(context);
    const SearchTask search = task(*sought, context);
    const TuningOptions options{common_scenarios.value_or(sought->has_scenarios()), stop_gap};
    Tuning tuning(*optimizer, search, *sought, options, context);
    tuning.run();
    context.count("evaluations", tuning.evaluations());
    tuning.write_history();
    const std::vector<double> best = tuning.best();
    sought->write(best, tuning.evaluations(), context);
    write_table(context.folder() / kOptimumFile, optimum_table(search, best));
    Table summary = tuning.summary();
    if (of_objective()) {
      add_truth(summary, *sought, best);
      write_table(context.folder() / kTargetsFile,
                  targets_table(targets, tuning.improvements(), sought->optimum()));
    }
    write_table(context.folder() / kSearchFile, summary);
  }

  static Parameters<OptimizeNode> parameters() {
    using This = OptimizeNode;
    return node_parameters<This>()
        .reference("problem", &This::problem, "problem", "Where the policy acts.", false)
        .reference("policy", &This::policy, "policy",
                   "The policy, configured in a policy node; the search begins at its numbers.", false)
        .add("parameters", &This::free, "",
             "Which of the policy's parameters are tuned: numbers, or lists of numbers.")
        .reference("objective", &This::objective, "objective",
                   "Instead of a policy: a function to be made large. Each replicate draws its own.", false)
        .add("low", &This::low, "",
             "Lower limits in SI units: one for each number that is tuned, or one for all; empty: as "
             "declared.")
        .add("high", &This::high, "", "Upper limits, likewise.")
        .add("start_low", &This::start_low, "",
             "Lower limits of where the search begins, likewise: it is drawn uniformly; empty: at the "
             "policy's "
             "numbers, or where the optimizer begins.")
        .add("start_high", &This::start_high, "", "Upper limits of that.")
        .require("budget", &This::budget, "", "Evaluations in all, repeated ones included.", at_least(1))
        .add("targets", &This::targets, "",
             "Of objectives: gaps to the optimum; targets.csv says when they were reached.", at_least(0))
        .automatic("stop_gap", &This::stop_gap, "",
                   "Of objectives: the search ends when a point as near to the optimum was tried; auto: it "
                   "goes on.",
                   at_least(0))
        .add("episodes", &This::episodes, "", "Episodes of an evaluation.", between(1, 1000000))
        .automatic("horizon", &This::horizon, "", "Steps of an episode at most; auto: the problem's.",
                   at_least(1))
        .automatic("discount", &This::discount, "",
                   "Discount of a step, for the discounted return; auto: the problem's.", between(0, 1))
        .choice("criterion", &This::criterion, criterion_names(),
                "What is made large: its mean over the episodes.")
        .automatic("common_scenarios", &This::common_scenarios, "",
                   "Whether candidates that the optimizer compares meet the same scenarios (common random "
                   "numbers); else each evaluation meets its own. auto: true for policies, false for "
                   "objectives, whose noise would cancel.")
        .automatic(
            "noisy", &This::noisy, "",
            "false where nothing is drawn: the search then trusts every value, and repeats none. auto: "
            "true for policies; as they say for objectives.")
        .direct(&This::optimizer, "How to search.");
  }

 private:
  bool of_objective() const { return !objective.id.empty(); }

  static const Element& configured_policy(const NodeContext& context) {
    const InputNode& node = context.inputs("policy").front();
    if (node.kind == "policy" && !node.element->children.empty()) return node.element->children.front();
    throw std::invalid_argument(
        fmt::format("policy '{}' is not configured in a policy node, but learned or read from a file: it has "
                    "no parameters to tune",
                    node.id));
  }

  std::unique_ptr<const SearchTarget> target(const NodeContext& context) const {
    if (of_objective()) {
      const Sub<Objective> family = load_objective(context.inputs("objective").front());
      return std::make_unique<ObjectiveTarget>(*family, context.draws());
    }
    return std::make_unique<PolicyTarget>(
        TunedPolicy(configured_policy(context), free), load_problem(context.inputs("problem").front()),
        PolicyTrial{episodes, horizon, discount, criterion}, context.draws().fork("evaluations"));
  }

  SearchTask task(const SearchTarget& sought, const NodeContext& context) const {
    SearchTask task;
    task.box = limited(sought.box(), low, high);
    task.guess = search_start(task.box, sought.guess(), start_low, start_high, context.draws().fork("start"));
    task.budget = budget;
    task.noisy = noisy.value_or(sought.noisy());
    task.draws = context.draws().fork("search");
    return task;
  }
};

const Component<Node, OptimizeNode> kOptimizeNode(
    "optimize", "Tune numbers of a configured policy, or a test function's, with a black-box optimizer.",
    "L. Hofer's thesis (2017), 2.4.1 and appendix A", 2);

}  // namespace
}  // namespace coppice
