#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/config/experiment.h"
#include "engine/vocabulary/archive.h"
#include "engine/vocabulary/parallel.h"
#include "engine/vocabulary/random.h"
#include "engine/vocabulary/space.h"
#include "registry/component.h"

namespace coppice {

class Problem;

/// Parameters that every node kind has. Those that do not change a node's result do not enter its key.
struct NodeOptions {
  std::string id;
  std::vector<std::string> over;  ///< ids of sweeps
  std::string at;                 ///< sweep point, in flat files ("variant=HA, gamma=0.9")
  std::optional<int> replicates;
  std::string seed_label;  ///< draws' label; empty: the node's kind
  std::string doc;
  double time_limit = 0;     ///< s of wall time, 0: none
  double memory_limit = 0;   ///< byte, 0: none
  std::int64_t threads = 0;  ///< at most so many, 0: what is free
};

/// Parameters<T> with the common ones declared; T derives from Node.
template <class T>
Parameters<T> node_parameters();

/// A node that another one reads.
struct InputNode {
  std::string id;
  std::string kind;
  Point point;
  std::optional<int> replicate;
  std::shared_ptr<const Element> element;  ///< resolved
  std::shared_ptr<const Problem> problem;  ///< as Node::problem
  std::filesystem::path folder;  ///< its files and timing.csv; empty for definitions and while checking
  std::string key;
  std::vector<PointValue> labels;  ///< columns that name it in tables: sweep columns, "problem", "policy"
  std::map<std::string, std::string> units;  ///< SI units of the labels that are quantities
  std::vector<std::string> streams;          ///< streams of draws it depends on ("collect 0"), its own first
  std::vector<std::string> makes;            ///< as Node::makes
  std::string training;  ///< key of the training run whose policy it is about; empty: nothing was learned
  std::vector<std::string> columns;           ///< as Node::dataset_columns
  std::vector<std::string> progress_columns;  ///< as Node::progress_columns
  std::shared_ptr<const Spaces> spaces;       ///< as Node::spaces
};

/// What a node sees while it is checked and while it runs.
class NodeContext {
 public:
  virtual ~NodeContext() = default;
  /// The nodes that a reference parameter leads to, in the order of the config, then of points and
  /// replicates.
  virtual const std::vector<InputNode>& inputs(std::string_view parameter) const = 0;
  virtual const Point& point() const = 0;
  virtual std::optional<int> replicate() const = 0;
  virtual Draws draws() const = 0;  ///< of (root seed, label, replicate)
  virtual const std::string& key() const = 0;
  virtual const std::string& stream() const = 0;  ///< name of draws(), to compare with InputNode::streams

  // Only while running:
  virtual const std::filesystem::path& folder() const = 0;  ///< write outputs here
  virtual Parallel& parallel() = 0;
  /// Adds to the work counters of timing.csv ("steps", "evaluations").
  virtual void count(std::string_view what, std::int64_t amount) = 0;
  /// Sets the column "<what>_s" of timing.csv: CPU time of one ("action").
  virtual void measure(std::string_view what, double value) = 0;
  virtual void progress(std::int64_t done, std::int64_t total) = 0;
  /// The last checkpoint of this very node (same key), if an earlier run left one.
  virtual std::optional<Archive> checkpoint() = 0;
  virtual void save_checkpoint(const Archive& archive) = 0;
};

/// Thrown by run when stop_requested() made it end early, after it saved a checkpoint.
class Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted") {}
};

/// Thrown by run when it fails, but what it wrote to its folder until then is worth keeping: it is moved to
/// where the user finds it, and the message says where.
class Unfinished : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A table with a row for each node that a reference parameter leads to, in their order.
struct InputTable {
  std::string file;
  std::string parameter;
};

/// A kind of node of the experiment graph. Immutable once read; run writes files into the context's folder,
/// and nothing else decides them than parameters, inputs and draws.
class Node : public NodeOptions {
 public:
  static constexpr const char* kInterface = "node";
  virtual ~Node() = default;

  /// What it makes for others: "problem", "policy", "dataset", "function", "evaluation", "progress", ...
  virtual std::vector<std::string> makes() const = 0;
  /// True when there is nothing to run: the element is all (problem, and policy without a problem).
  virtual bool definition() const { return false; }
  /// The problem that it is the name of; null: it names none.
  virtual std::shared_ptr<const Problem> problem() const { return nullptr; }
  /// False when draws() plays no part: seed, label and replicate then stay out of its key, and it has no
  /// stream.
  virtual bool random() const { return true; }
  /// True when a policy that it makes was learned, or may have been (train, a policy file). What is known of
  /// it is then known of one training run.
  virtual bool learns() const { return false; }
  /// True when a reference parameter takes several nodes although the node has no sweep or replicate of its
  /// own (table, figure, compare, select).
  virtual bool gathers(std::string_view) const { return false; }
  /// True when it takes all replicates of a node where it has none of its own, but one sweep point only
  /// (train's samples).
  virtual bool gathers_replicates(std::string_view) const { return false; }
  /// Components that it uses besides those inside its element; their versions enter its key (export).
  virtual std::vector<const ComponentInfo*> uses() const { return {}; }
  /// True when its files show the labels and replicates of its inputs, which then enter its key. Only for
  /// nodes that make nothing for others (table): renaming a node must not change what is computed from it.
  virtual bool shows_labels() const { return false; }
  /// Tables among its files to which the engine adds the node's labels and replicate as first columns. The
  /// stored result is without, so that equal work under other names is done once.
  virtual std::vector<std::string> labelled_tables() const { return {}; }
  /// A table among its files whose rows get the labels and replicates of the inputs that they stand for, in
  /// the same way (select).
  virtual std::optional<InputTable> input_table() const { return std::nullopt; }
  /// Folder of the run in which its tables appear under the node's id ("tables"); empty: none.
  virtual std::string published_in() const { return {}; }
  /// Columns of the dataset that it makes, as far as they are known when planning; empty: unknown.
  virtual std::vector<std::string> dataset_columns(const NodeContext&) const { return {}; }
  /// The same of its progress.
  virtual std::vector<std::string> progress_columns(const NodeContext&) const { return {}; }
  /// Spaces of the problem that the policy or the dataset it makes is for, as far as they are known when
  /// planning; null: unknown, or of any.
  virtual std::shared_ptr<const Spaces> spaces(const NodeContext&) const { return nullptr; }
  /// Checks that need the inputs' elements. Throws std::invalid_argument (BrokenRules with several, each
  /// about a parameter) or ConfigError; called when planning.
  virtual void check(const NodeContext&) const {}
  virtual void run(NodeContext& context) const = 0;
};

template <class T>
Parameters<T> node_parameters() {
  return Parameters<T>()
      .require("id", static_cast<std::string T::*>(&T::id), "", "Name of the node, unique in the experiment.")
      .add("over", static_cast<std::vector<std::string> T::*>(&T::over), "",
           "Sweeps that the node runs over.")
      .add("at", static_cast<std::string T::*>(&T::at), "",
           "Sweep point of the node; only in expanded files.")
      .automatic(
          "replicates", static_cast<std::optional<int> T::*>(&T::replicates), "",
          "Independent repetitions; auto: those of its inputs where the node has them to itself, else none.",
          at_least(1))
      .add("seed_label", static_cast<std::string T::*>(&T::seed_label), "",
           "Label of the node's draws; empty: its kind. Nodes with equal labels meet equal randomness.")
      .add("doc", static_cast<std::string T::*>(&T::doc), "", "What the node is for; shown in the report.")
      .add("time_limit", static_cast<double T::*>(&T::time_limit), "s",
           "Wall time allowed; 0: no limit. A node that is not done then is stopped and fails; with more "
           "time it goes on from its last checkpoint.",
           at_least(0))
      .add("memory_limit", static_cast<double T::*>(&T::memory_limit), "byte", "Memory allowed; 0: no limit.",
           at_least(0))
      .add("threads", static_cast<std::int64_t T::*>(&T::threads), "",
           "Threads at most; 0: what the run has free.", at_least(0));
}

}  // namespace coppice
