#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/data/file_system.h"

namespace coppice {

/// Name of the journal in a run folder.
inline constexpr std::string_view kJournalFile = "events.jsonl";

// What happens: to the run, ...
inline constexpr std::string_view kRunStarted = "run started";
inline constexpr std::string_view kRunEnded = "run ";  ///< with the outcome: "run done", "run failed", ...
// ... and to a node.
inline constexpr std::string_view kNodeFinished = "finished";

/// A line of events.jsonl. What is empty is not written.
struct Event {
  std::string time;  ///< ISO 8601, UTC; now when empty
  std::string
      what;  ///< of the run: "run started", "run done", ...; of a node: "started", "finished", "failed"
  std::string node;  ///< its name
  std::string key;
  std::string message;
  std::optional<double> wall_s;
  std::optional<double> cpu_s;
};

/// Appends to a journal, one JSON object a line, each in one write. Several processes may append at once. A
/// process killed while it writes leaves a torn line, which ends where the next journal begins. May be used
/// by any thread. Never throws: a run goes on without its journal.
class Journal {
 public:
  explicit Journal(const std::filesystem::path& file);
  void write(Event event);
  /// The first failure, with the file and the system's reason; empty when there was none.
  std::string error() const;

 private:
  mutable std::mutex mutex_;
  std::unique_ptr<OpenFile> file_;
  bool torn_ = false;  // the file does not end in a line end
  std::string error_;
};

/// The events of a journal in order; torn and foreign lines are left out. None when it cannot be read.
std::vector<Event> read_events(const std::filesystem::path& file);

}  // namespace coppice
