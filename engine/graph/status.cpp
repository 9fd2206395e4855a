#include "engine/graph/status.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <thread>
#include <unordered_map>

#include "engine/graph/events.h"
#include "engine/graph/index.h"
#include "engine/graph/key.h"
#include "engine/graph/run_folder.h"
#include "engine/graph/store.h"
#include "registry/suggest.h"

namespace coppice {
namespace {

/// The line's name as the user knows it: parameters stand below "node", other nodes below "input".
std::string shown_name(const std::string& line) {
  for (const std::string_view prefix : {"node.", "input."}) {
    if (line.starts_with(prefix)) return line.substr(prefix.size());
  }
  return line;
}

/// Lines that differ, those of the new text first.
std::vector<Change> differences(const std::string& before, const std::string& now) {
  const std::vector<std::pair<std::string, std::string>> old_lines = key_lines(before);
  std::map<std::string, std::string> old_values(old_lines.begin(), old_lines.end());
  std::vector<Change> changes;
  for (const auto& [name, value] : key_lines(now)) {
    const auto known = old_values.find(name);
    if (known == old_values.end()) {
      changes.push_back({shown_name(name), "", value});
      continue;
    }
    if (known->second != value) changes.push_back({shown_name(name), known->second, value});
    old_values.erase(known);
  }
  for (const auto& [name, value] : old_lines) {
    if (old_values.contains(name)) changes.push_back({shown_name(name), value, ""});
  }
  return changes;
}

[[noreturn]] void unknown_id(const Plan& plan, std::string_view id) {
  Diagnostics diagnostics;
  diagnostics.error({}, fmt::format("'{}' is no node of the experiment '{}'", id, plan.experiment.name),
                    suggestion(id, plan.ids()));
  diagnostics.throw_if_any();
  throw std::logic_error("an error that is none");
}

/// Which nodes the selection leaves in, and which it forces.
struct Selected {
  std::vector<bool> in;
  std::vector<bool> forced;

  Selected(const Plan& plan, const Selection& selection)
      : in(plan.nodes.size(), selection.only.empty()), forced(plan.nodes.size(), false) {
    for (const SelectedNode& node : selection.only) mark(plan, node.id, in);
    for (const SelectedNode& node : selection.force) mark(plan, node.id, forced);
    for (std::size_t i = plan.nodes.size(); i-- > 0;) {  // what a wanted node needs is wanted
      if (in[i]) each_input(plan.nodes[i], [&](std::size_t input) { in[input] = true; });
    }
    for (std::size_t i = 0; i < plan.nodes.size(); ++i) {  // what depends on a forced node is forced
      each_input(plan.nodes[i], [&](std::size_t input) { forced[i] = forced[i] || forced[input]; });
    }
  }

 private:
  static void mark(const Plan& plan, const std::string& id, std::vector<bool>& marks) {
    for (const std::size_t i : plan.find(id)) marks[i] = true;
  }

  template <class F>
  static void each_input(const PlannedNode& node, F&& action) {
    for (const PlannedInput& input : node.inputs) {
      for (const std::size_t i : input.nodes) action(i);
    }
  }
};

/// Compares nodes with what the last run left.
class Inspector {
 public:
  Inspector(const Plan& plan, const std::filesystem::path& out)
      : plan_(plan), folder_(out / plan.experiment.name), store_(out / "store") {}

  /// Which results lie in the folder as a run left them: a look at the date of each file, by all cores.
  std::vector<char> placed() const {
    std::vector<char> placed(plan_.nodes.size());
    const std::size_t workers =
        plan_.nodes.size() < 500 ? 1 : std::max(1U, std::thread::hardware_concurrency());
    const auto look = [&](std::size_t worker) {
      const std::size_t count = placed.size();
      for (std::size_t i = worker * count / workers; i < (worker + 1) * count / workers; ++i) {
        if (!plan_.nodes[i].definition) placed[i] = folder_.intact(plan_.nodes[i]) ? 1 : 0;
      }
    };
    {
      std::vector<std::jthread> threads;
      for (std::size_t worker = 1; worker < workers; ++worker) threads.emplace_back(look, worker);
      look(0);
    }  // the threads end
    return placed;
  }

  NodeStatus status(std::size_t index, bool placed, bool forced) const {
    const PlannedNode& node = plan_.nodes[index];
    NodeStatus status;
    if (node.definition) {
      status.reason = Reason::definition;
      return status;
    }
    status.placed = placed;
    if (forced) {
      status.reason = Reason::forced;
      status.runs = true;
    } else if (status.placed || store_.find(node.key)) {
      status.reason = Reason::up_to_date;
    } else {
      status.runs = true;
      status.reason = missing_reason(index, status.changes);
    }
    return status;
  }

  /// Finds damage that leaves no trace in a file's date: reads the whole result.
  void verify(std::size_t index, NodeStatus& status) const {
    const PlannedNode& node = plan_.nodes[index];
    if (status.placed && folder_.has_content(node)) return;
    status.placed = false;
    if (store_.find_verified(node.key)) return;
    status.reason = Reason::damaged;
    status.runs = true;
  }

  /// What is different from the last run, if anything.
  std::vector<Change> changes(std::size_t index) const {
    const PlannedNode& node = plan_.nodes[index];
    const Placement* last = folder_.last(node);
    if (last == nullptr || last->key == node.key) return {};
    const std::optional<ResultRecord> before = store_.read(last->key);
    return before ? differences(before->key_text, plan_.key_text(index)) : std::vector<Change>();
  }

 private:
  Reason missing_reason(std::size_t index, std::vector<Change>& differing) const {
    const PlannedNode& node = plan_.nodes[index];
    const Placement* last = folder_.last(node);
    if (last == nullptr) return store_.read(node.key) ? Reason::missing_output : Reason::new_node;
    if (last->key == node.key) return Reason::missing_output;
    differing = changes(index);
    return Reason::changed;
  }

  const Plan& plan_;
  RunFolder folder_;
  StoreReader store_;
};

std::vector<NodeStatus> inspect_dates(const Plan& plan, const Selected& selected,
                                      const Inspector& inspector) {
  std::vector<NodeStatus> statuses(plan.nodes.size());
  const std::vector<char> placed = inspector.placed();
  for (std::size_t i = 0; i < plan.nodes.size(); ++i) {
    statuses[i] = inspector.status(i, placed[i] != 0, selected.forced[i]);
    if (!selected.in[i] && !plan.nodes[i].definition) {
      statuses[i].reason = Reason::not_selected;
      statuses[i].runs = false;
    }
  }
  return statuses;
}

/// Verifies what nodes that run will read, from the last node to the first: a node stands after its inputs.
void verify_inputs(const Plan& plan, const Inspector& inspector, std::vector<NodeStatus>& statuses) {
  std::vector<bool> verified(plan.nodes.size(), false);
  for (std::size_t i = plan.nodes.size(); i-- > 0;) {
    if (!statuses[i].runs) continue;
    for (const PlannedInput& input : plan.nodes[i].inputs) {
      for (const std::size_t read : input.nodes) {
        if (statuses[read].reason != Reason::up_to_date || verified[read]) continue;
        verified[read] = true;
        inspector.verify(read, statuses[read]);
      }
    }
  }
}

/// Makes one node run of those that would make the same result.
class Sharing {
 public:
  void mark(const Plan& plan, std::vector<NodeStatus>& statuses) {
    for (std::size_t i = 0; i < plan.nodes.size(); ++i) {
      if (!statuses[i].runs) continue;
      const auto [first, is_new] = makers_.try_emplace(plan.nodes[i].key, Maker{&plan, i});
      if (is_new || (first->second.plan == &plan && first->second.node == i)) continue;
      const auto& [its_plan, node] = first->second;
      statuses[i].reason = Reason::shared;
      statuses[i].runs = false;
      statuses[i].predicted_s.reset();
      statuses[i].shared_with = its_plan->nodes[node].name;
      if (its_plan != &plan) statuses[i].shared_with += " of " + its_plan->experiment.name;
    }
  }

 private:
  struct Maker {
    const Plan* plan;
    std::size_t node;
  };
  std::unordered_map<std::string, Maker> makers_;
};

std::string shortened(const std::string& value) {
  if (value.empty()) return "(none)";
  return value.size() > 60 ? value.substr(0, 57) + "..." : value;
}

}  // namespace

std::string to_text(const NodeStatus& status) {
  switch (status.reason) {
    case Reason::definition:
      return "definition";
    case Reason::up_to_date:
      return "up to date";
    case Reason::not_selected:
      return "not selected";
    case Reason::new_node:
      return "new";
    case Reason::missing_output:
      return "missing output";
    case Reason::damaged:
      return "damaged";
    case Reason::forced:
      return "forced";
    case Reason::shared:
      return "the same as " + status.shared_with;
    case Reason::changed:
      break;
  }
  std::string text = "changed";
  constexpr std::size_t kShown = 3;
  for (std::size_t i = 0; i < std::min(kShown, status.changes.size()); ++i) {
    const Change& change = status.changes[i];
    text += fmt::format("{}{}: {} -> {}", i == 0 ? ": " : ", ", change.what, shortened(change.before),
                        shortened(change.now));
  }
  if (status.changes.size() > kShown) text += fmt::format(", and {} more", status.changes.size() - kShown);
  return text;
}

void check_selection(const std::vector<Plan>& plans, const Selection& selection) {
  Diagnostics diagnostics;
  std::vector<std::string> known;
  for (const Plan& plan : plans) {
    for (std::string& id : plan.ids()) known.push_back(std::move(id));
  }
  const auto check_known = [&](const SelectedNode& node) {
    const bool found = std::any_of(plans.begin(), plans.end(),
                                   [&](const Plan& plan) { return !plan.find(node.id).empty(); });
    if (found) return;
    const std::string where =
        plans.size() == 1
            ? fmt::format("'{}' is no node of the experiment '{}'", node.id, plans.front().experiment.name)
            : fmt::format("'{}' is no node of any of the experiments", node.id);
    diagnostics.error(node.place, where, suggestion(node.id, known));
  };
  std::for_each(selection.only.begin(), selection.only.end(), check_known);
  std::for_each(selection.force.begin(), selection.force.end(), check_known);
  diagnostics.throw_if_any();
  for (const SelectedNode& node : selection.force) {  // to force what is left out would do nothing
    const bool wanted = std::any_of(plans.begin(), plans.end(), [&](const Plan& plan) {
      const std::vector<bool> in = Selected(plan, selection).in;
      const std::vector<std::size_t> found = plan.find(node.id);
      return std::any_of(found.begin(), found.end(), [&](std::size_t i) { return in[i]; });
    });
    if (wanted) continue;
    diagnostics.error(
        node.place,
        fmt::format("'{}' is forced, and not among the nodes selected nor what they need", node.id));
  }
  diagnostics.throw_if_any();
}

bool selects_any(const Plan& plan, const Selection& selection) {
  return selection.only.empty() ||
         std::any_of(selection.only.begin(), selection.only.end(),
                     [&](const SelectedNode& node) { return !plan.find(node.id).empty(); });
}

std::vector<NodeStatus> inspect(const Plan& plan, const Selection& selection,
                                const std::filesystem::path& out) {
  const Selected selected(plan, selection);
  const Inspector inspector(plan, out);
  std::vector<NodeStatus> statuses = inspect_dates(plan, selected, inspector);
  if (std::none_of(statuses.begin(), statuses.end(), [](const NodeStatus& s) { return s.runs; }))
    return statuses;
  verify_inputs(plan, inspector, statuses);
  const Durations durations = read_durations(out);
  for (std::size_t i = 0; i < plan.nodes.size(); ++i) {
    if (!statuses[i].runs) continue;
    statuses[i].predicted_s = durations.predict(plan.nodes[i].family, plan.nodes[i].component);
  }
  Sharing().mark(plan, statuses);
  return statuses;
}

std::vector<std::vector<NodeStatus>> inspect(const std::vector<Plan>& plans, const Selection& selection,
                                             const std::filesystem::path& out) {
  std::vector<std::vector<NodeStatus>> all;
  Sharing sharing;
  for (const Plan& plan : plans) sharing.mark(plan, all.emplace_back(inspect(plan, selection, out)));
  return all;
}

std::optional<double> predicted_total(const std::vector<NodeStatus>& nodes, int threads) {
  double sum = 0;
  double longest = 0;
  for (const NodeStatus& node : nodes) {
    if (!node.runs) continue;
    if (!node.predicted_s) return std::nullopt;
    sum += *node.predicted_s;
    longest = std::max(longest, *node.predicted_s);
  }
  return std::max(sum / std::max(threads, 1), longest);
}

std::vector<Explanation> explain(const Plan& plan, std::string_view id_or_name,
                                 const std::filesystem::path& out) {
  const std::vector<std::size_t> found = plan.find(id_or_name);
  if (found.empty()) unknown_id(plan, id_or_name);
  const Inspector inspector(plan, out);
  const std::vector<NodeStatus> statuses = inspect(plan, {}, out);
  std::vector<Explanation> explanations;
  for (const std::size_t i : found) {
    Explanation explanation{plan.nodes[i].name, plan.nodes[i].key, plan.key_text(i), statuses[i]};
    explanation.status.changes = inspector.changes(i);
    explanations.push_back(std::move(explanation));
  }
  return explanations;
}

RunStatus read_status(const std::filesystem::path& run_folder) {
  const std::filesystem::path config = run_folder / "resolved.xml";
  std::error_code code;
  if (!std::filesystem::exists(config, code)) {
    throw ConfigError(
        fmt::format("{} is not the folder of a run: it has no resolved.xml", run_folder.string()));
  }
  const Plan plan = make_plan(expand(config.string(), {}));
  const std::filesystem::path out = (std::filesystem::absolute(run_folder) / "..").lexically_normal();
  const std::vector<NodeStatus> statuses = inspect_dates(plan, Selected(plan, {}), Inspector(plan, out));
  std::map<std::string, std::string> messages;
  for (const Event& event : read_events(run_folder / "events.jsonl")) {
    if (!event.node.empty()) messages[event.node] = event.what == "failed" ? event.message : std::string();
  }
  RunStatus status;
  status.experiment = plan.experiment.name;
  status.running = RunFolder(run_folder).in_use();
  const StoreReader store(out / "store");
  for (std::size_t i = 0; i < plan.nodes.size(); ++i) {
    const PlannedNode& node = plan.nodes[i];
    if (node.definition) continue;
    NodeState state{node.name, node.id, !statuses[i].runs, {}, {}, {}};
    if (!state.done) {
      state.message = messages[node.name];
    } else if (const std::optional<ResultRecord> record = store.read(node.key)) {
      state.wall_s = record->wall_s;
      state.cpu_s = record->cpu_s;
    }
    ++status.nodes;
    if (state.done) ++status.finished;
    if (!state.message.empty()) {
      ++status.failed;
      status.messages.push_back(node.name + ": " + state.message);
    }
    status.states.push_back(std::move(state));
  }
  return status;
}

}  // namespace coppice
