#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "engine/data/table_file.h"
#include "engine/graph/artifacts.h"
#include "engine/graph/nodes/episodes.h"
#include "engine/graph/nodes/progress_table.h"
#include "engine/graph/nodes/tuned_policy.h"
#include "engine/statistics/estimates.h"
#include "engine/vocabulary/optimizer.h"

namespace coppice {
namespace {

enum class Criterion { returns, discounted_return };
constexpr std::array<const char*, 2> kCriteria = {"return", "discounted_return"};
constexpr std::string_view kOptimumFile = "optimum.csv";
constexpr std::string_view kSearchFile = "search.csv";
constexpr std::int64_t kMostAtOnce = 64;     // so that it shows progress and can stop
constexpr std::int64_t kHistoryRows = 1000;  // about as many, however large the budget

/// A search and its history, saved and resumed together.
class Tuning {
 public:
  using Evaluate = std::function<std::vector<double>(const Candidates&, std::int64_t evaluations)>;

  Tuning(const Optimizer& optimizer, SearchTask task, NodeContext& context)
      : task_(std::move(task)),
        names_(optimizer.measures()),
        context_(context),
        search_(optimizer.start(task_)) {
    std::optional<Archive> saved = context.checkpoint();
    if (!saved) return;
    try {
      load(*saved);
    } catch (const std::runtime_error&) {  // a checkpoint that cannot be read is no loss but of time
      search_ = optimizer.start(task_);
      history_ = {};
      evaluations_ = not_finite_ = last_row_ = next_row_ = 0;
    }
  }

  /// Throws Interrupted when the run should stop.
  void run(const Evaluate& evaluate) {
    CheckpointClock clock;
    while (evaluations_ < task_.budget) {
      const bool stop = context_.parallel().stop_requested();
      if (stop || clock.due()) clock.save(context_, state());
      if (stop) throw Interrupted();
      const Candidates candidates = search_->ask(std::min(kMostAtOnce, task_.budget - evaluations_));
      if (candidates.points.rows() == 0) break;
      check(candidates);
      const std::vector<double> values = evaluate(candidates, evaluations_);
      not_finite_ += std::count_if(values.begin(), values.end(), [](double v) { return !std::isfinite(v); });
      evaluations_ += static_cast<std::int64_t>(values.size());
      search_->tell(values);
      if (evaluations_ >= next_row_) add_row();
      context_.progress(evaluations_, task_.budget);
    }
    if (evaluations_ > last_row_) add_row();
  }

  const Search& search() const { return *search_; }
  Table history() const { return history_.table(); }
  std::int64_t evaluations() const { return evaluations_; }
  std::int64_t not_finite() const { return not_finite_; }

 private:
  void check(const Candidates& candidates) const {
    for (std::size_t i = 0; i < task_.box.size(); ++i) {
      for (const double x : candidates.points.column(i)) {
        if (x >= task_.box[i].low && x <= task_.box[i].high) continue;
        throw std::logic_error(
            fmt::format("a candidate has {} = {}, outside of its limits", task_.box[i].name, x));
      }
    }
  }

  void add_row() {
    TrainingProgress row{evaluations_, task_.budget, {{"best_value", search_->best_value()}}};
    const std::vector<double> values = search_->measures();
    for (std::size_t i = 0; i < names_.size(); ++i) row.measures.emplace_back(names_[i], values[i]);
    history_.add(row);
    last_row_ = evaluations_;
    next_row_ = evaluations_ + task_.budget / kHistoryRows;
  }

  Archive state() const {
    Archive archive;
    archive.put("counts", std::vector<std::int64_t>{evaluations_, not_finite_, last_row_, next_row_});
    {
      const Archive::Scope scope(archive, "search");
      search_->save(archive);
    }
    const Archive::Scope scope(archive, "history");
    history_.save(archive);
    return archive;
  }
  void load(Archive& archive) {
    const std::vector<std::int64_t> counts = archive.get<std::vector<std::int64_t>>("counts");
    if (counts.size() != 4) throw std::runtime_error("not the counts of a search");
    evaluations_ = counts[0];
    not_finite_ = counts[1];
    last_row_ = counts[2];
    next_row_ = counts[3];
    {
      const Archive::Scope scope(archive, "search");
      search_->load(archive);
    }
    const Archive::Scope scope(archive, "history");
    history_.load(archive);
  }

  const SearchTask task_;
  const std::vector<std::string> names_;
  NodeContext& context_;
  std::unique_ptr<Search> search_;
  ProgressTable history_;
  std::int64_t evaluations_ = 0;
  std::int64_t not_finite_ = 0;  ///< values that were NaN or infinite
  std::int64_t last_row_ = 0;    ///< evaluations when the history got its last row
  std::int64_t next_row_ = 0;
};

/// Looks for the numbers of a configured policy with which it does best: the mean return of a few episodes is
/// what the optimizer sees. Makes the policy with the best numbers.
struct OptimizeNode : Node {
  Reference problem, policy;
  std::vector<std::string> free;
  std::vector<double> low, high;
  std::int64_t budget = 0;
  std::int64_t episodes = 1;
  std::optional<int> horizon;
  std::optional<double> discount;
  Criterion criterion = Criterion::returns;
  bool common_scenarios = true;
  bool noisy = true;
  Sub<Optimizer> optimizer;

  std::vector<std::string> makes() const override { return {"policy", "progress", "timing"}; }
  bool learns() const override { return true; }
  std::vector<std::string> labelled_tables() const override {
    return {std::string(kProgressFile), std::string(kOptimumFile), std::string(kSearchFile)};
  }
  std::vector<std::string> progress_columns(const NodeContext&) const override {
    std::vector<std::string> measures = {"best_value"};
    for (const std::string& measure : optimizer->measures()) measures.push_back(measure);
    return ProgressTable::column_names(measures);
  }
  std::shared_ptr<const Spaces> spaces(const NodeContext& context) const override {
    return load_spaces(context.inputs("problem").front());
  }

  void check(const NodeContext& context) const override {
    const auto target = load_problem(context.inputs("problem").front());
    const TunedPolicy tuned = tuned_policy(context);
    prepared(tuned, tuned.configured(), *target);
    optimizer->start(task(tuned, context));
  }

  void run(NodeContext& context) const override {
    const auto target = load_problem(context.inputs("problem").front());
    const TunedPolicy tuned = tuned_policy(context);
    Tuning tuning(*optimizer, task(tuned, context), context);
    tuning.run([&](const Candidates& candidates, std::int64_t evaluations) {
      return evaluate(candidates, evaluations, tuned, *target, context);
    });
    context.count("evaluations", tuning.evaluations());
    context.count("episodes", tuning.evaluations() * episodes);
    const std::vector<double> best = tuning.search().best();
    write_policy(prepared(tuned, best, *target), target->spaces(), context);
    write_table(context.folder() / kProgressFile, tuning.history());
    write_table(context.folder() / kOptimumFile, optimum(tuned, best));
    write_table(context.folder() / kSearchFile, summary(tuning));
  }

  static Parameters<OptimizeNode> parameters() {
    using This = OptimizeNode;
    return node_parameters<This>()
        .reference("problem", &This::problem, "problem", "Where the policy acts.")
        .reference("policy", &This::policy, "policy",
                   "The policy, configured in a policy node; the search begins at its numbers.")
        .require("parameters", &This::free, "",
                 "Which of the policy's parameters are tuned: numbers, or lists of numbers.")
        .add("low", &This::low, "",
             "Lower limits in SI units: one for each number that is tuned, or one for all; empty: as "
             "declared.")
        .add("high", &This::high, "", "Upper limits, likewise.")
        .require("budget", &This::budget, "", "Evaluations in all, repeated ones included.", at_least(1))
        .add("episodes", &This::episodes, "", "Episodes of an evaluation.", between(1, 1000000))
        .automatic("horizon", &This::horizon, "", "Steps of an episode at most; auto: the problem's.",
                   at_least(1))
        .automatic("discount", &This::discount, "",
                   "Discount of a step, for the discounted return; auto: the problem's.", between(0, 1))
        .choice("criterion", &This::criterion, {kCriteria.begin(), kCriteria.end()},
                "What is made large: its mean over the episodes.")
        .add("common_scenarios", &This::common_scenarios, "",
             "Whether candidates that the optimizer compares meet the same scenarios (common random "
             "numbers); else "
             "each evaluation meets its own.")
        .add("noisy", &This::noisy, "",
             "false where neither problem nor policy draw anything: the search then trusts every value, and "
             "repeats none.")
        .direct(&This::optimizer, "How to search.");
  }

 private:
  TunedPolicy tuned_policy(const NodeContext& context) const {
    const InputNode& node = context.inputs("policy").front();
    if (node.kind != "policy" || node.element.children.empty()) {
      throw std::invalid_argument(fmt::format(
          "policy '{}' is not configured in a policy node, but learned or read from a file: it has no "
          "parameters to tune",
          node.id));
    }
    return {node.element.children.front(), free, low, high};
  }

  SearchTask task(const TunedPolicy& tuned, const NodeContext& context) const {
    return {.box = tuned.box(),
            .guess = tuned.configured(),
            .budget = budget,
            .noisy = noisy,
            .draws = context.draws().fork("search")};
  }

  static MadePolicy prepared(const TunedPolicy& tuned, std::span<const double> numbers,
                             const Problem& target) {
    Diagnostics diagnostics;
    MadePolicy made = make<Policy>(tuned.at(numbers), diagnostics);
    diagnostics.throw_if_any();
    made.object->prepare(target.spaces(), target.simulator());
    return made;
  }

  std::vector<double> evaluate(const Candidates& candidates, std::int64_t evaluations,
                               const TunedPolicy& tuned, const Problem& target, NodeContext& context) const {
    std::vector<double> values(candidates.points.rows());
    const Draws draws = context.draws().fork("evaluations");
    context.parallel().for_each(values.size(), [&](std::size_t i) {
      std::vector<double> numbers(candidates.points.columns());
      candidates.points.row(i, numbers);
      const MadePolicy made = prepared(tuned, numbers, target);
      const std::uint64_t number =
          common_scenarios ? candidates.scenarios[i] : static_cast<std::uint64_t>(evaluations) + i;
      Simulation simulation;
      simulation.policy = made.object.get();
      simulation.rollouts = static_cast<std::size_t>(episodes);
      simulation.horizon = horizon.value_or(target.horizon());
      simulation.discount = discount.value_or(target.discount());
      simulation.first_scenario = number * static_cast<std::uint64_t>(episodes);
      const Returns returns = target.episodes(simulation, draws, context.parallel());
      values[i] = mean(criterion == Criterion::returns ? returns.total : returns.discounted);
    });
    return values;
  }

  static void write_policy(const MadePolicy& policy, const Spaces& spaces, NodeContext& context) {
    PolicyFile file{.writer = {},
                    .provenance = context.key(),
                    .spaces = spaces,
                    .component = policy.resolved,
                    .arrays = {}};
    policy->save(file.arrays);
    write_policy_file(context.folder() / kPolicyFile, file);
  }

  static Table optimum(const TunedPolicy& tuned, const std::vector<double>& best) {
    using Type = ColumnInfo::Type;
    Table table;
    table.columns = {
        {"parameter", Type::text, "", "Number that was tuned; those of a list are counted from 0."},
        {"unit", Type::text, "", "Its SI unit."},
        {"low", Type::number, "", "Lower limit."},
        {"high", Type::number, "", "Upper limit."},
        {"configured", Type::number, "", "Where the search began."},
        {"value", Type::number, "", "What was found best."}};
    for (std::size_t i = 0; i < best.size(); ++i) {
      const Axis& axis = tuned.box()[i];
      table.rows.push_back({axis.name, axis.unit, axis.low, axis.high, tuned.configured()[i], best[i]});
    }
    return table;
  }

  static Table summary(const Tuning& tuning) {
    using Type = ColumnInfo::Type;
    Table table;
    table.columns = {{"evaluations", Type::integer, "", "Evaluations made, repeated ones included."},
                     {"not_finite", Type::integer, "", "Those whose value was not a finite number."},
                     {"best_value", Type::number, "", "Value of the best point as the search estimates it."},
                     {"stop_reason", Type::text, "", "Why the search ended."}};
    const std::string reason = tuning.search().stop_reason();
    table.rows.push_back({tuning.evaluations(), tuning.not_finite(), tuning.search().best_value(),
                          reason.empty() ? std::string("budget") : reason});
    return table;
  }
};

const Component<Node, OptimizeNode> kComponent(
    "optimize", "Tune numbers of a configured policy with a black-box optimizer.",
    "L. Hofer's thesis (2017), 2.4.1 and appendix A");

}  // namespace
}  // namespace coppice
