#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/data/file_system.h"

namespace coppice {

/// Times of a node: beside its result in the store, for they are not the same at every attempt.
inline constexpr std::string_view kTimingFile = "timing.csv";

/// One file of a stored result.
struct StoredFile {
  std::string name;  ///< within the node's folder
  std::uint64_t size = 0;
  std::string hash;  ///< XXH3-128 of the content, hexadecimal
  std::int64_t modified_ns =
      0;  ///< of the object when it was stored; another time: its content is read again
};

/// What the store knows about a key: written last, it acknowledges the result.
struct ResultRecord {
  std::string key;
  std::string kind;
  std::string component;  ///< for predictions of time
  std::string family;     ///< hash of the key text without seed, replicate and inputs
  std::string key_text;
  double wall_s = 0;
  double cpu_s = 0;
  std::vector<StoredFile> files;  ///< sorted by name
};

/// Results by key: key record -> content hashes -> objects (read-only files). Only reads; a store that is not
/// there has no results. May be used by any thread.
///
///   results/ab/<key>.json   objects/ab/<hash>   timing/ab/<key>.csv   checkpoints/<key>   tmp/<process>/
class StoreReader {
 public:
  explicit StoreReader(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// The result of a key, if it is whole: record readable, every object there with its size and content.
  std::optional<ResultRecord> find(const std::string& key) const;
  /// The same, reading every object: none was written to since without a trace.
  std::optional<ResultRecord> find_verified(const std::string& key) const;
  /// The record alone, whatever became of its objects.
  std::optional<ResultRecord> read(const std::string& key) const;
  /// All keys that have a record, sorted.
  std::vector<std::string> keys() const;
  std::filesystem::path record(const std::string& key) const;
  std::filesystem::path object(const std::string& hash) const;
  std::filesystem::path timing(const std::string& key) const;
  std::filesystem::path checkpoint(const std::string& key) const;

  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path folder_;
};

/// A store to write to. A result is first written in full, then acknowledged by renaming its record into
/// place; a process killed at any instant loses nothing acknowledged. Several processes may use one store at
/// once, and several threads one Store.
///
/// Results reach the disk before they are acknowledged too, except in a burst of them, which reaches it every
/// two seconds: waiting for the disk costs more than short nodes take. A loss of power in a burst costs what
/// came since; find() tells what is not whole.
class Store : public StoreReader {
 public:
  /// Opens or makes the store, and removes what killed processes left: in tmp, and checkpoints of results
  /// that they had acknowledged. Throws ConfigError with the folder and the system's reason.
  explicit Store(std::filesystem::path folder);
  ~Store();
  Store(const Store&) = delete;
  Store& operator=(const Store&) = delete;

  /// An empty folder for a node to write into.
  std::filesystem::path begin(const std::string& key);
  /// Moves every file of the folder into the store and acknowledges. `record` needs no files. A file
  /// kTimingFile is kept beside the result and is no part of it. The key's checkpoint is removed. Throws
  /// std::runtime_error with file and reason.
  ResultRecord commit(const std::filesystem::path& folder, ResultRecord record);
  /// Forgets a folder that begin made.
  void abandon(const std::filesystem::path& folder);
  /// Replaces the key's checkpoint. Throws std::runtime_error with file and reason.
  void save_checkpoint(const std::string& key, std::string_view bytes);
  /// Takes a result back (damaged, or to be made again).
  void remove(const std::string& key);

 private:
  void claim_temporary_folder();
  void remove_outlived_checkpoints() const;
  std::filesystem::path temporary(const std::string& name);
  StoredFile keep(const std::filesystem::path& file, const std::string& name);
  bool sync_is_due();
  void acknowledge(const ResultRecord& record, bool durably);

  std::unique_ptr<OpenFile> in_use_;  // shared lock: no garbage is collected meanwhile
  std::filesystem::path temporary_;
  std::unique_ptr<OpenFile> claim_;         // lock of temporary_: its owner lives
  std::atomic<unsigned> count_{0};          // names within temporary_
  std::atomic<std::int64_t> synced_ns_{0};  // by the steady clock
  std::atomic<bool> unsynced_{false};
};

/// What collect_garbage removed.
struct Garbage {
  std::size_t results = 0;
  std::size_t objects = 0;
  std::uint64_t bytes = 0;
};

/// Removes results that no run folder below `out` refers to. Throws ConfigError while a run uses the store.
Garbage collect_garbage(const std::filesystem::path& out, bool dry_run);

}  // namespace coppice
