#include <filesystem>

#include "engine/cli/console.h"
#include "engine/cli/exit_status.h"
#include "engine/cli/policy_inputs.h"
#include "engine/cli/selection.h"
#include "engine/data/csv.h"
#include "engine/graph/nodes/evaluation_table.h"
#include "engine/graph/pool.h"

namespace coppice::cli {
namespace {

std::string csv(const Table& table) {
  std::string text;
  for (const ColumnInfo& column : table.columns) append_csv(text += text.empty() ? "" : ",", column.name);
  for (const std::vector<Cell>& row : table.rows) {
    text += '\n';
    for (std::size_t i = 0; i < row.size(); ++i) append_csv(text += i == 0 ? "" : ",", cell_text(row[i]));
  }
  return text + '\n';
}

struct PolicyEvaluate : PolicyInputs {
  std::uint64_t episodes = 1000;
  std::uint64_t seed = 1;
  std::uint64_t replicate = 0;
  std::string label = "evaluate";
  std::optional<std::uint64_t> horizon;
  std::optional<std::string> discount;
  std::optional<std::uint64_t> jobs;

  static Arguments<PolicyEvaluate> arguments() {
    using This = PolicyEvaluate;
    return policy_arguments<This>()
        .option("--episodes", "N", &This::episodes, "Number of episodes.")
        .option("--horizon", "N", &This::horizon,
                "Steps of an episode at most; the problem's when not given.")
        .option("--discount", "GAMMA", &This::discount, "Discount of a step; the problem's when not given.")
        .option("--seed", "N", &This::seed, "Root seed.")
        .option("--seed-label", "LABEL", &This::label, "Label of the draws, as a node's seed_label.")
        .option("--replicate", "N", &This::replicate, "Replicate of the draws, from 0.")
        .option("-j,--jobs", "N", &This::jobs, "Threads; one for each core when not given.");
  }

  int run(const CommandLine& line, Console& console) const {
    if (problem.empty()) throw line.error("", "'--problem' is missing", "where the policy is to act");
    const ReadyPolicy ready = ready_policy(line, *this);
    Simulation simulation;
    simulation.policy = ready.policy.object.get();
    simulation.rollouts = positive(line, "--episodes", episodes, 1e9);
    simulation.horizon =
        horizon ? static_cast<int>(positive(line, "--horizon", *horizon, 1e9)) : ready.problem->horizon();
    simulation.discount = discount ? discount_of(line) : ready.problem->discount();
    Returns returns;
    Pool pool(static_cast<std::size_t>(thread_count(line, jobs)));
    Task task;
    task.work = [&](TaskParallel& parallel) {
      returns = ready.problem->episodes(simulation, Draws(seed, label, replicate), parallel);
    };
    pool.submit(std::move(task));
    pool.wait();
    console.out(csv(labelled(ready, evaluation_table(returns, simulation.horizon, simulation.discount))));
    return kDone;
  }

 private:
  static std::size_t positive(const CommandLine& line, const std::string& name, std::uint64_t value,
                              double most) {
    if (value >= 1 && static_cast<double>(value) <= most) return value;
    throw line.error(std::to_string(value), "'" + name + "' must be an integer in [1, 1000000000]");
  }
  double discount_of(const CommandLine& line) const {
    const std::optional<double> value = parse_number(*discount);
    if (value && *value >= 0 && *value <= 1) return *value;
    throw line.error(*discount, "'--discount' must be a number in [0, 1], not '" + *discount + "'");
  }
  /// The columns that name the row, as in the results of a run.
  Table labelled(const ReadyPolicy& ready, Table table) const {
    const std::vector<std::pair<ColumnInfo, Cell>> labels = {
        {{"problem", ColumnInfo::Type::text, "", "Where the policy acted."}, ready.problem_name},
        {{"policy", ColumnInfo::Type::text, "", "The policy file."},
         std::filesystem::path(file).stem().string()},
        {{"replicate", ColumnInfo::Type::integer, "", "Replicate of the draws."},
         static_cast<std::int64_t>(replicate)}};
    for (std::size_t i = labels.size(); i-- > 0;) {
      table.columns.insert(table.columns.begin(), labels[i].first);
      for (std::vector<Cell>& row : table.rows) row.insert(row.begin(), labels[i].second);
    }
    return table;
  }
};

const Command<PolicyEvaluate> kPolicyEvaluate(
    {.name = "policy evaluate",
     .group = Group::policies,
     .doc = "Plays episodes of a policy on a problem and writes their statistics as a CSV row.",
     .details = "Seed, label, replicate and episodes of an experiment's 'evaluate' node give that node's "
                "numbers again.",
     .examples = {{"runner policy evaluate learned.policy --problem double_integrator --episodes 1000",
                   "On a problem with its default parameters."},
                  {"runner policy evaluate learned.policy --config configs/quickstart.xml --problem car",
                   "On a problem of a config."}}});

}  // namespace
}  // namespace coppice::cli
