#include "engine/graph/index.h"

#include <fmt/format.h>

#include <set>

#include "engine/graph/events.h"
#include "engine/graph/provenance.h"
#include "engine/graph/sqlite.h"
#include "engine/graph/store.h"

namespace coppice {
namespace {

namespace fs = std::filesystem;

/// Raised when the tables change: an index of another format is made again.
constexpr int kIndexFormat = 1;
constexpr int kWaitWriting_ms = 300;
constexpr int kWaitReading_ms = 100;

constexpr const char* kTables =
    "CREATE TABLE nodes(key TEXT, finished TEXT, experiment TEXT, node TEXT, component TEXT, family TEXT,"
    " wall_s REAL, cpu_s REAL, PRIMARY KEY(key, finished)) WITHOUT ROWID;"
    "CREATE TABLE runs(experiment TEXT, started TEXT, finished TEXT, outcome TEXT,"
    " PRIMARY KEY(experiment, started)) WITHOUT ROWID;";

fs::path index_file(const fs::path& out) {
  return out / "index.sqlite";
}

void write_node(Statement& insert, const IndexedNode& node) {
  insert.bind(node.key).bind(node.finished).bind(node.experiment).bind(node.node);
  insert.bind(node.component).bind(node.family).bind(node.wall_s).bind(node.cpu_s).step();
}

Statement node_insertion(Database& database) {
  return {database, "INSERT OR REPLACE INTO nodes VALUES(?,?,?,?,?,?,?,?)"};
}

void write_run(Database& database, const std::string& experiment, const std::string& started,
               const std::string& finished, const std::string& outcome) {
  Statement(database, "INSERT OR REPLACE INTO runs VALUES(?,?,?,?)")
      .bind(experiment)
      .bind(started)
      .bind(finished)
      .bind(outcome)
      .step();
}

/// Every result of the store, by key: what is known without the names it has in experiments.
std::map<std::string, IndexedNode> stored_nodes(const fs::path& out) {
  std::map<std::string, IndexedNode> nodes;
  const StoreReader store(out / "store");
  for (const std::string& key : store.keys()) {
    const std::optional<ResultRecord> record = store.read(key);
    FileStamp stamp;
    if (!record || !stamp_file(store.record(key).native(), stamp)) continue;
    IndexedNode& node = nodes[key];
    node.key = key;
    node.component = record->component;
    node.family = record->family;
    node.wall_s = record->wall_s;
    node.cpu_s = record->cpu_s;
    node.finished = timestamp(stamp.modified_ns);
  }
  return nodes;
}

/// Writes what a run folder's journal tells of the stored nodes; the keys of those go to `told`.
void write_journal(Database& database, const fs::path& folder,
                   const std::map<std::string, IndexedNode>& stored, std::set<std::string>& told) {
  const std::string experiment = folder.filename().string();
  Statement insert = node_insertion(database);
  std::string started;
  for (const Event& event : read_events(folder / kJournalFile)) {
    if (event.what == kRunStarted) {
      started = event.time;
      write_run(database, experiment, started, "", "running");
    } else if (event.what.starts_with(kRunEnded)) {
      write_run(database, experiment, started, event.time, event.what.substr(kRunEnded.size()));
    }
    const auto known = stored.find(event.key);
    if (event.what != kNodeFinished || known == stored.end()) continue;
    IndexedNode node = known->second;
    node.experiment = experiment;
    node.node = event.node;
    node.wall_s = event.wall_s.value_or(node.wall_s);
    node.cpu_s = event.cpu_s.value_or(node.cpu_s);
    node.finished = event.time;
    write_node(insert, node);
    told.insert(node.key);
  }
}

/// Fills an empty index with what the run folders and the store tell.
void rebuild(Database& database, const fs::path& out) {
  const std::map<std::string, IndexedNode> stored = stored_nodes(out);
  std::set<std::string> told;
  std::error_code ignored;
  for (fs::directory_iterator folder(out, ignored), end; folder != end; folder.increment(ignored)) {
    if (folder->is_directory(ignored)) write_journal(database, folder->path(), stored, told);
  }
  Statement insert = node_insertion(database);
  for (const auto& [key, node] : stored) {
    if (!told.contains(key)) write_node(insert, node);
  }
}

bool has_format(Database& database) {
  return database.value("PRAGMA user_version") == std::to_string(kIndexFormat);
}

/// Opens the index for writing, and makes it when it is new.
std::unique_ptr<Database> open_index(const fs::path& out) {
  auto database = std::make_unique<Database>(index_file(out), true, kWaitWriting_ms);
  database->execute("PRAGMA journal_mode=WAL; PRAGMA synchronous=NORMAL");
  if (database->value("PRAGMA quick_check") != "ok") throw DatabaseError(SQLITE_CORRUPT, "damaged");
  database->execute("BEGIN IMMEDIATE");  // two processes may come to make it at once
  if (!has_format(*database)) {
    database->execute(kTables);  // fails when there are others, of another format
    rebuild(*database, out);
    database->execute(fmt::format("PRAGMA user_version={}", kIndexFormat));
  }
  database->execute("COMMIT");
  return database;
}

}  // namespace

void Durations::add(const std::string& family, const std::string& component, double mean_s,
                    std::size_t count) {
  for (Sum* sum : {&families_[family], &components_[component]}) {
    sum->total_s += mean_s * static_cast<double>(count);
    sum->count += count;
  }
}

std::optional<double> Durations::predict(const std::string& family, const std::string& component) const {
  auto found = families_.find(family);
  if (found == families_.end()) {
    found = components_.find(component);
    if (found == components_.end()) return std::nullopt;
  }
  return found->second.total_s / static_cast<double>(found->second.count);
}

Durations read_durations(const fs::path& out) {
  Durations durations;
  try {
    Database database(index_file(out), false, kWaitReading_ms);
    if (!has_format(database)) throw DatabaseError(SQLITE_ERROR, "another format");
    Statement means(database,
                    "SELECT family, component, AVG(wall_s), COUNT(*) FROM nodes GROUP BY family, component");
    while (means.step())
      durations.add(means.text(0), means.text(1), means.number(2),
                    static_cast<std::size_t>(means.integer(3)));
    return durations;
  } catch (const DatabaseError&) {
    durations = {};
  }
  for (const auto& [key, node] : stored_nodes(out)) durations.add(node.family, node.component, node.wall_s);
  return durations;
}

Index::Index(const fs::path& out) {
  for (const bool last_try : {false, true}) {
    try {
      database_ = open_index(out);
      return;
    } catch (const DatabaseError& error) {
      if (last_try || !error.unusable()) return;
    }
    std::error_code ignored;
    for (const char* suffix : {"", "-wal", "-shm"}) fs::remove(index_file(out).native() + suffix, ignored);
  }
}

Index::~Index() = default;

template <class Write>
void Index::attempt(const Write& write) {
  const std::lock_guard lock(mutex_);
  if (!database_) return;
  try {
    write(*database_);
  } catch (const DatabaseError&) {  // the next rebuild has it from the journal
  }
}

void Index::add(const IndexedNode& node) {
  attempt([&](Database& database) {
    Statement insert = node_insertion(database);
    write_node(insert, node);
  });
}

void Index::begin_run(const std::string& experiment, const std::string& started) {
  attempt([&](Database& database) { write_run(database, experiment, started, "", "running"); });
}

void Index::end_run(const std::string& experiment, const std::string& started, const std::string& finished,
                    const std::string& outcome) {
  attempt([&](Database& database) { write_run(database, experiment, started, finished, outcome); });
}

}  // namespace coppice
