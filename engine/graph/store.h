#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace coppice {

/// One file of a stored result.
struct StoredFile {
  std::string name;  ///< within the node's folder
  std::uint64_t size = 0;
  std::string hash;  ///< XXH3-128 of the content, hexadecimal
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

/// Results by key: key record -> content hashes -> objects (read-only files). A result is first written in
/// full, then acknowledged by renaming its record into place; a process killed at any instant loses nothing
/// acknowledged. Several processes may use one store at once. Files may be read by any thread.
///
///   results/ab/<key>.json   objects/ab/<hash>   timing/ab/<key>.csv   checkpoints/<key>   tmp/<process>/
class Store {
 public:
  /// Opens or makes the store, and removes what killed processes left in tmp. Throws ConfigError with the
  /// folder and the system's reason.
  explicit Store(std::filesystem::path folder);
  ~Store();
  Store(const Store&) = delete;
  Store& operator=(const Store&) = delete;

  /// The result of a key, if it is whole: record readable, every object there with its size.
  std::optional<ResultRecord> find(const std::string& key) const;
  std::filesystem::path object(const std::string& hash) const;
  std::filesystem::path timing(const std::string& key) const;
  std::filesystem::path checkpoint(const std::string& key) const;

  /// An empty folder for a node to write into.
  std::filesystem::path begin(const std::string& key);
  /// Moves every file of the folder into the store and acknowledges. `record` needs no files. A file
  /// "timing.csv" is kept beside the result and is no part of it. Throws std::runtime_error with file and
  /// reason.
  ResultRecord commit(const std::filesystem::path& folder, ResultRecord record);
  /// Forgets a folder that begin made.
  void abandon(const std::filesystem::path& folder);
  /// Takes a result back (damaged, or to be made again).
  void remove(const std::string& key);

  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path folder_;
  std::filesystem::path temporary_;
  int lock_ = -1;
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
