#include <fcntl.h>
#include <fmt/format.h>

#include <set>
#include <stdexcept>

#include "engine/data/file_system.h"
#include "engine/graph/events.h"
#include "engine/graph/placement.h"
#include "engine/graph/store.h"
#include "registry/error.h"

namespace coppice {
namespace {

namespace fs = std::filesystem;

/// The keys that the journal names since the last run that ended: of that run, and of those killed since,
/// which the record of what lies in the folder may not know.
std::set<std::string> recent_keys(const fs::path& run_folder) {
  std::set<std::string> keys;
  bool ended = false;
  for (const Event& event : read_events(run_folder / kJournalFile)) {
    if (event.what == kRunStarted) {
      if (ended) keys.clear();
      ended = false;
    } else if (event.what.starts_with(kRunEnded)) {
      ended = true;
    }
    if (!event.key.empty()) keys.insert(event.key);
  }
  return keys;
}

/// The keys that the run folders below `out` refer to.
std::set<std::string> wanted_keys(const fs::path& out) {
  std::set<std::string> wanted;
  std::error_code code;
  for (fs::directory_iterator i(out, code), end; !code && i != end; i.increment(code)) {
    const fs::path file = i->path() / kPlacementsFile;
    wanted.merge(recent_keys(i->path()));
    if (!fs::exists(file, code)) continue;
    const std::optional<Placements> placements = read_placements(file);
    if (!placements) {
      throw ConfigError(
          fmt::format("cannot tell which results {} refers to: {} is damaged; run it again, or "
                      "remove the folder",
                      i->path().string(), file.string()));
    }
    for (const auto& [place, placement] : *placements) wanted.insert(placement.key);
  }
  if (code) throw ConfigError(fmt::format("cannot read {}: {}", out.string(), code.message()));
  return wanted;
}

class Sweep {
 public:
  Sweep(const fs::path& out, bool dry_run) : store_(out / "store"), dry_run_(dry_run) {}

  Garbage run(const std::set<std::string>& wanted) {
    std::set<std::string> objects;
    for (const std::string& key : store_.keys()) {
      const std::optional<ResultRecord> record = wanted.contains(key) ? store_.read(key) : std::nullopt;
      if (!record) {
        remove(store_.record(key));  // before its objects: what is acknowledged stays whole
        remove(store_.timing(key));
        ++garbage_.results;
      } else {
        for (const StoredFile& file : record->files) objects.insert(file.hash);
      }
    }
    for (const fs::path& object : files_below("objects")) {
      if (objects.contains(object.filename().string())) continue;
      remove(object);
      ++garbage_.objects;
    }
    for (const fs::path& checkpoint : files_below("checkpoints")) {
      if (!wanted.contains(checkpoint.filename().string())) remove(checkpoint);
    }
    for (const fs::path& leftover : files_below("tmp")) remove(leftover);
    return garbage_;
  }

 private:
  std::vector<fs::path> files_below(const char* part) const {
    std::vector<fs::path> files;
    std::error_code ignored;
    for (fs::recursive_directory_iterator i(store_.folder() / part, ignored), end; i != end;
         i.increment(ignored)) {
      if (i->is_regular_file(ignored)) files.push_back(i->path());
    }
    return files;
  }

  void remove(const fs::path& file) {
    FileStamp stamp;
    if (!stamp_file(file.native(), stamp)) return;
    garbage_.bytes += stamp.size;
    if (!dry_run_) coppice::remove_all(file);
  }

  StoreReader store_;
  bool dry_run_;
  Garbage garbage_;
};

}  // namespace

Garbage collect_garbage(const fs::path& out, bool dry_run) {
  const fs::path store = out / "store";
  std::error_code ignored;
  if (!fs::is_directory(store, ignored))
    throw ConfigError(
        fmt::format("{} holds no results: there is no folder {}", out.string(), store.string()));
  try {
    const OpenFile in_use(store / "lock", O_RDWR | O_CREAT);
    if (!in_use.try_lock())
      throw ConfigError(fmt::format("a run uses {}; try again when it has ended", store.string()));
    return Sweep(out, dry_run).run(wanted_keys(out));
  } catch (const ConfigError&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw ConfigError(error.what());
  }
}

}  // namespace coppice
