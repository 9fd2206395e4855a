#include "engine/graph/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <thread>

#include "engine/graph/child.h"
#include "engine/graph/executor.h"
#include "engine/graph/provenance.h"

namespace coppice {
namespace {

namespace fs = std::filesystem;

using Workspaces = std::vector<std::unique_ptr<Workspace>>;

std::string resolved_text(const Plan& plan) {
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n" + flat(plan.experiment);
}

bool has_text(const fs::path& file, const std::string& text) {
  FileStamp stamp;
  return stamp_file(file, stamp) && stamp.size == text.size() && read_file(file) == text;
}

Event event_of_run(const std::string& what) {
  Event event;
  event.what = "run " + what;
  return event;
}

/// One experiment of the run, from what lies in its folder to what should.
class FolderUpdate {
 public:
  FolderUpdate(Workspace& workspace, const RunOptions& options)
      : workspace_(workspace), options_(options), resolved_(resolved_text(workspace.plan)) {}

  /// True when everything is as the config wants it.
  bool nothing_to_do() const {
    const RunFolder& folder = workspace_.folder;
    for (std::size_t i = 0; i < workspace_.plan.nodes.size(); ++i) {
      if (is_to_come(i) || is_to_place(i)) return false;
    }
    if (!folder.tables_joined(workspace_.plan)) return false;
    if (folder.has_more_than(wanted()) || !has_text(folder.path() / "resolved.xml", resolved_)) return false;
    FileStamp stamp;
    return !options_.page || stamp_file(folder.path() / "report.html", stamp);
  }

  /// Before the nodes run: takes away what is not wanted, and puts results in place that the store has.
  void begin(const StoreReader& store, Index& index) {
    Workspace& w = workspace_;
    w.started = timestamp();
    w.journal = std::make_unique<Journal>(w.folder.path() / "events.jsonl");
    w.folder.remove_all_but(wanted());
    write_file(w.folder.path() / "resolved.xml", resolved_, true);
    write_provenance(w.folder.path() / "provenance.json", provenance("running", ""));
    w.journal->write(event_of_run("started"));
    index.begin_run(w.plan.experiment.name, w.started);
    for (std::size_t i = 0; i < w.plan.nodes.size(); ++i) {
      if (!is_to_place(i)) continue;
      const std::optional<ResultRecord> result = store.find(w.plan.nodes[i].key);
      if (!result)
        throw std::runtime_error("the result of " + w.plan.nodes[i].name + " vanished from the store");
      w.folder.place(w.plan.nodes[i], *result, store);
    }
  }

  /// After the nodes ran: joined tables, records, page. Returns what went wrong.
  std::vector<std::string> end(bool interrupted, Index& index) {
    Workspace& w = workspace_;
    std::vector<std::string> wrong;
    const auto attempt = [&](const auto& action) {
      try {
        action();
      } catch (const std::runtime_error& error) {
        wrong.push_back(error.what());
      }
    };
    const std::string finished = timestamp();
    attempt([&] { w.folder.join_tables(w.plan); });
    const std::string outcome = interrupted ? "interrupted" : w.failed || !wrong.empty() ? "failed" : "done";
    attempt([&] { write_provenance(w.folder.path() / "provenance.json", provenance(outcome, finished)); });
    if (w.journal) attempt([&] { w.journal->write(event_of_run(outcome)); });
    index.end_run(w.plan.experiment.name, w.started, finished, outcome);
    if (options_.page) attempt([&] { options_.page(w.folder.path()); });
    attempt([&] { w.folder.save(); });  // last: from now on the folder counts as finished
    return wrong;
  }

 private:
  /// True for a result that is known but does not lie in the folder as it should.
  bool is_to_place(std::size_t node) const {
    const NodeStatus& status = workspace_.statuses[node];
    return status.reason == Reason::up_to_date && !status.placed;
  }

  bool is_to_come(std::size_t node) const {
    return workspace_.statuses[node].runs || workspace_.statuses[node].reason == Reason::shared;
  }

  /// Places of the folder whose content stays.
  std::vector<std::string> wanted() const {
    std::vector<std::string> keep;
    for (std::size_t i = 0; i < workspace_.plan.nodes.size(); ++i) {
      const PlannedNode& node = workspace_.plan.nodes[i];
      if (!node.node->labelled_tables().empty()) keep.push_back(RunFolder::joined_table(node.id));
      if (!is_to_come(i) && workspace_.statuses[i].placed) keep.push_back(node.folder);
    }
    return keep;
  }

  Provenance provenance(std::string outcome, std::string finished) const {
    Provenance provenance;
    provenance.plan = &workspace_.plan;
    provenance.command = options_.command;
    provenance.threads = options_.threads;
    provenance.started = workspace_.started;
    provenance.finished = std::move(finished);
    provenance.outcome = std::move(outcome);
    return provenance;
  }

  Workspace& workspace_;
  const RunOptions& options_;
  std::string resolved_;
};

/// Fills in what was left to the engine.
RunOptions completed(RunOptions options) {
  if (options.threads <= 0)
    options.threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  if (options.runner.empty()) options.runner = fs::read_symlink("/proc/self/exe");
  options.out = fs::absolute(options.out).lexically_normal();
  return options;
}

Workspaces open_workspaces(const std::vector<Plan>& plans, const RunOptions& options) {
  Workspaces workspaces;
  for (const Plan& plan : plans) {
    workspaces.emplace_back(std::make_unique<Workspace>(plan, options.out))->folder.lock();
  }
  std::vector<std::vector<NodeStatus>> statuses = inspect(plans, options.selection, options.out);
  for (std::size_t i = 0; i < plans.size(); ++i) workspaces[i]->statuses = std::move(statuses[i]);
  return workspaces;
}

/// True when a killed process may have left something that opening the store removes.
bool has_leftovers(const fs::path& store) {
  std::error_code code;
  const fs::directory_iterator entries(store / "tmp", code);
  return !code && std::any_of(fs::begin(entries), fs::end(entries),
                              [](const fs::directory_entry& entry) { return entry.is_directory(); });
}

std::size_t up_to_date(const Workspaces& workspaces) {
  std::size_t count = 0;
  for (const auto& workspace : workspaces) {
    count += workspace->up_to_date();
  }
  return count;
}

}  // namespace

RunOutcome run(const std::vector<Plan>& plans, const RunOptions& given) {
  const RunOptions options = completed(given);
  check_selection(plans, options.selection);
  Workspaces workspaces = open_workspaces(plans, options);
  std::vector<FolderUpdate> updates;
  for (const auto& workspace : workspaces) {
    FolderUpdate update(*workspace, options);
    if (!update.nothing_to_do()) updates.push_back(std::move(update));
  }
  RunOutcome outcome;
  outcome.totals.up_to_date = up_to_date(workspaces);
  if (updates.empty()) {
    if (has_leftovers(options.out / "store")) Store(options.out / "store");
    if (options.listener != nullptr) {
      options.listener->begin(outcome.totals);
      options.listener->end(outcome.totals);
    }
    return outcome;
  }
  Store store(options.out / "store");
  Index index(options.out);
  try {
    for (FolderUpdate& update : updates) update.begin(store, index);
  } catch (const std::runtime_error& error) {
    throw ConfigError(error.what());  // nothing has run
  }
  Executor executor(workspaces, store, index, options);
  executor.run();
  outcome.totals = executor.totals();
  outcome.failures = executor.failures();
  outcome.troubles = executor.troubles();
  outcome.interrupted = executor.interrupted();
  for (FolderUpdate& update : updates) {
    for (std::string& wrong : update.end(outcome.interrupted, index))
      outcome.troubles.push_back(std::move(wrong));
  }
  return outcome;
}

void run_node(const fs::path& run_folder, const std::string& key, double memory_limit,
              const RunOptions& given) {
  die_with_parent();
  const RunOptions options = completed(given);
  const Plan plan = make_plan(expand((run_folder / "resolved.xml").string(), {}));
  const auto node = std::find_if(plan.nodes.begin(), plan.nodes.end(),
                                 [&](const PlannedNode& n) { return n.key == key && !n.definition; });
  if (node == plan.nodes.end()) {
    throw ConfigError(fmt::format("no node of {} has the key {}", run_folder.string(), key));
  }
  const auto index = static_cast<std::size_t>(node - plan.nodes.begin());
  Store store(fs::absolute(run_folder).lexically_normal() / ".." / "store");
  if (store.find(key)) return;

  Pool pool(static_cast<std::size_t>(options.threads), options.stop);
  if (memory_limit > 0) limit_memory(memory_limit);
  const auto out_of_memory = [&] {
    release_memory_limit();
    return std::runtime_error(
        fmt::format("ran out of memory: its memory_limit is {}; it had {} and needed more",
                    memory_text(memory_limit), memory_text(peak_memory())));
  };
  try {
    Task task;
    task.work = [&](TaskParallel& parallel) {
      compute_node(plan, index, run_folder, store, parallel, [](const RunningContext*) {});
    };
    pool.submit(std::move(task));
    pool.wait();
  } catch (const std::bad_alloc&) {
    if (memory_limit <= 0) throw;
    throw out_of_memory();
  } catch (const Interrupted&) {
    throw;
  } catch (const std::runtime_error& error) {
    release_memory_limit();
    if (memory_limit <= 0 || peak_memory() < memory_limit) throw;
    // Whatever it was, it happened where even small calls of the system are refused their memory.
    throw std::runtime_error(fmt::format("{} ({})", out_of_memory().what(), error.what()));
  }
}

}  // namespace coppice
