#include "engine/graph/plan.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <thread>

#include "engine/cli/console.h"
#include "engine/cli/exit_status.h"
#include "engine/cli/inputs.h"
#include "engine/cli/layout.h"
#include "engine/cli/selection.h"
#include "engine/graph/status.h"

namespace coppice::cli {
namespace {

using Json = nlohmann::ordered_json;
using Statuses = std::vector<NodeStatus>;

struct Counts {
  std::size_t runs = 0;
  std::size_t nodes = 0;  ///< without definitions
  std::size_t selected = 0;
};

Counts count(const Plan& plan, const Statuses& statuses) {
  Counts counts;
  for (std::size_t i = 0; i < plan.nodes.size(); ++i) {
    counts.nodes += plan.nodes[i].definition ? 0 : 1;
    counts.runs += statuses[i].runs ? 1 : 0;
    const bool out = plan.nodes[i].definition || statuses[i].reason == Reason::not_selected;
    counts.selected += out ? 0 : 1;
  }
  return counts;
}

std::string text(const Plan& plan, const Statuses& statuses, int threads) {
  std::vector<std::vector<std::string>> rows;
  for (std::size_t i = 0; i < plan.nodes.size(); ++i) {
    if (!statuses[i].runs) continue;
    const std::optional<double>& predicted = statuses[i].predicted_s;
    rows.push_back({plan.nodes[i].name,
                    predicted ? fmt::format("~{}", duration_text(*predicted)) : std::string(),
                    to_text(statuses[i])});
  }
  const Counts counts = count(plan, statuses);
  if (counts.nodes > 0 && counts.selected == 0)
    return plan.experiment.name + ": none of its nodes is selected\n";
  std::string head =
      fmt::format("{}: {} of {} to run", plan.experiment.name, counts.runs, counted(counts.nodes, "node"));
  if (const std::optional<double> total = predicted_total(statuses, threads); total && counts.runs > 0) {
    head += fmt::format(", about {} on {}", duration_text(*total),
                        counted(static_cast<std::size_t>(threads), "core"));
  }
  return head + '\n' + aligned(rows, 2);
}

Json json(const Plan& plan, const Statuses& statuses, std::size_t i) {
  const PlannedNode& node = plan.nodes[i];
  Json object = {{"name", node.name}, {"id", node.id}, {"kind", node.kind}, {"key", node.key}};
  object["point"] = Json::object();
  for (const PointValue& value : node.point) object["point"][value.first] = value.second;
  object["replicate"] = node.replicate ? Json(*node.replicate) : Json();
  object["runs"] = statuses[i].runs;
  object["reason"] = to_text(statuses[i]);
  object["changes"] = Json::array();
  for (const Change& change : statuses[i].changes) {
    object["changes"].push_back({{"what", change.what}, {"before", change.before}, {"now", change.now}});
  }
  object["predicted_s"] = statuses[i].predicted_s ? Json(*statuses[i].predicted_s) : Json();
  object["inputs"] = Json::array();
  for (const PlannedInput& input : node.inputs) {
    for (const std::size_t from : input.nodes) object["inputs"].push_back(plan.nodes[from].name);
  }
  return object;
}

Json json(const Plan& plan, const Statuses& statuses, int threads) {
  const Counts counts = count(plan, statuses);
  const std::optional<double> total = predicted_total(statuses, threads);
  Json object = {
      {"experiment", plan.experiment.name}, {"to_run", counts.runs}, {"nodes_total", counts.nodes}};
  object["predicted_s"] = total ? Json(*total) : Json();
  object["nodes"] = Json::array();
  for (std::size_t i = 0; i < plan.nodes.size(); ++i) object["nodes"].push_back(json(plan, statuses, i));
  return object;
}

/// The graph of node elements: one box for each id, with how many nodes it stands for.
std::string dot(const Plan& plan, const Statuses& statuses) {
  const auto quoted = [](const std::string& name) { return Json(name).dump(); };
  struct Box {
    std::string kind;
    std::size_t nodes = 0, runs = 0;
    std::vector<std::string> from;
  };
  std::vector<std::string> ids;
  std::map<std::string, Box> boxes;
  for (std::size_t i = 0; i < plan.nodes.size(); ++i) {
    const PlannedNode& node = plan.nodes[i];
    if (!boxes.contains(node.id)) ids.push_back(node.id);
    Box& box = boxes[node.id];
    box.kind = node.kind;
    ++box.nodes;
    box.runs += statuses[i].runs ? 1 : 0;
    for (const PlannedInput& input : node.inputs) {
      for (const std::size_t from : input.nodes) {
        const std::string& id = plan.nodes[from].id;
        if (std::find(box.from.begin(), box.from.end(), id) == box.from.end()) box.from.push_back(id);
      }
    }
  }
  std::string out = "digraph " + quoted(plan.experiment.name) + " {\n  rankdir=LR;\n  node [shape=box];\n";
  for (const std::string& id : ids) {
    const Box& box = boxes[id];
    const std::string label =
        fmt::format("{}\n{}\n{}, {} to run", id, box.kind, counted(box.nodes, "node"), box.runs);
    out += fmt::format("  {} [label={}{}];\n", quoted(id), quoted(label), box.runs > 0 ? ", style=bold" : "");
    for (const std::string& from : box.from) out += fmt::format("  {} -> {};\n", quoted(from), quoted(id));
  }
  return out + "}\n";
}

struct PlanCommand : ConfigInputs, SelectionInputs {
  std::optional<std::uint64_t> jobs;
  bool as_json = false;
  bool as_dot = false;

  static Arguments<PlanCommand> arguments() {
    return add_selection(config_arguments<PlanCommand>())
        .option("-j,--jobs", "N", &PlanCommand::jobs,
                "Cores that the predicted time is for; all when not given.")
        .flag("--json", &PlanCommand::as_json,
              "Every node with its key, reason, changes and inputs, as JSON.")
        .flag("--dot", &PlanCommand::as_dot, "The graph, for Graphviz.");
  }

  int run(const CommandLine& line, Console& console) const {
    if (as_json && as_dot) throw line.error("--dot", "'--json' and '--dot' exclude each other");
    int threads = thread_count(line, jobs);
    if (threads == 0) threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
    Json all = Json::array();
    const std::vector<Plan>& plans = plan_to_keep(line, *this);
    const Selection selected = selection(line);
    check_selection(plans, selected);
    const std::vector<Statuses> of_plans = inspect(plans, selected, out);
    for (std::size_t i = 0; i < plans.size(); ++i) {
      const Plan& plan = plans[i];
      const Statuses& statuses = of_plans[i];
      if (as_json) {
        all.push_back(json(plan, statuses, threads));
      } else {
        console.out(as_dot ? dot(plan, statuses) : text(plan, statuses, threads));
      }
    }
    if (as_json) console.out(Json({{"experiments", std::move(all)}}).dump(2) + '\n');
    return kDone;
  }
};

const Command<PlanCommand> kPlan(
    {.name = "plan",
     .group = Group::experiments,
     .rank = 2,
     .doc = "Shows the nodes that would run, each with its reason and predicted time.",
     .details =
         "Reads only. What it shows is what 'run' with the same arguments does. Times are predicted from "
         "earlier runs in the same output folder, and left out where there is no evidence.",
     .examples = {
         {"runner plan configs/quickstart.xml", "What would run, and why."},
         {"runner plan configs/quickstart.xml --force fpf_pwl --json",
          "The same as JSON, if the node 'fpf_pwl' were run again."},
         {"runner plan configs/quickstart.xml --dot", "The graph of the experiment, for Graphviz."}}});

}  // namespace
}  // namespace coppice::cli
