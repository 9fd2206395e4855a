#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

namespace coppice {

class Database;

/// A finished node as the index keeps it.
struct IndexedNode {
  std::string experiment;
  std::string node;  ///< its name
  std::string key;
  std::string component;
  std::string family;
  double wall_s = 0;
  double cpu_s = 0;
  std::string finished;  ///< ISO 8601, UTC
};

/// Mean recorded durations, for predictions.
class Durations {
 public:
  void add(const std::string& family, const std::string& component, double mean_s, std::size_t count = 1);
  /// Mean wall time in s of nodes of the family, else of the component; none when neither has been recorded.
  std::optional<double> predict(const std::string& family, const std::string& component) const;

 private:
  struct Sum {
    double total_s = 0;
    std::size_t count = 0;
  };
  std::map<std::string, Sum, std::less<>> families_, components_;
};

/// What is known below `out`: from its index, or, where there is none that can be read, from the records of
/// its store. Never throws.
Durations read_durations(const std::filesystem::path& out);

/// OUT/index.sqlite: which nodes ran when, and how long. Written by the process that started the run only. It
/// can be made again from the store's records and the run folders' journals, and is when it is missing,
/// damaged or of another format. While it cannot be used, for example because another process holds it, all
/// this does nothing. May be used by any thread. Never throws.
///
///   nodes(key, finished, experiment, node, component, family, wall_s, cpu_s)
///   runs(experiment, started, finished, outcome)
class Index {
 public:
  explicit Index(const std::filesystem::path& out);
  ~Index();
  Index(const Index&) = delete;
  Index& operator=(const Index&) = delete;

  void add(const IndexedNode& node);
  void begin_run(const std::string& experiment, const std::string& started);
  /// `outcome`: "done", "failed", "interrupted".
  void end_run(const std::string& experiment, const std::string& started, const std::string& finished,
               const std::string& outcome);
  bool usable() const { return database_ != nullptr; }

 private:
  template <class Write>
  void attempt(const Write& write);

  std::mutex mutex_;
  std::unique_ptr<Database> database_;
};

}  // namespace coppice
