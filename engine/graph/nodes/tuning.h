#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "engine/graph/node.h"
#include "engine/graph/nodes/improvements.h"
#include "engine/graph/nodes/progress_table.h"
#include "engine/graph/nodes/search_target.h"
#include "engine/vocabulary/optimizer.h"

namespace coppice {

/// How a search is run.
struct TuningOptions {
  bool common_scenarios = true;    ///< else every evaluation meets a scenario of its own
  std::optional<double> stop_gap;  ///< it ends when a point tried is as near to the optimum
};

/// A search for the largest value of a target, with its history; saved and resumed together.
class Tuning {
 public:
  /// Goes on from the context's checkpoint, if there is one.
  Tuning(const Optimizer& optimizer, SearchTask task, const SearchTarget& target, TuningOptions options,
         NodeContext& context);

  /// To its end. Throws Interrupted when the run should stop; Unfinished, with the number of the evaluation,
  /// the values tried and the cause, when an evaluation throws: the history up to then is written before.
  void run();

  /// Writes progress.csv and improvements.csv.
  void write_history() const;
  /// One row about the search as a whole.
  Table summary() const;
  const Improvements& improvements() const { return improvements_; }
  std::vector<double> best() const { return search_->best(); }
  std::int64_t evaluations() const { return evaluations_; }

  /// The measures of the history.
  static std::vector<std::string> measures(const Optimizer& optimizer, bool optimum_known);

 private:
  bool reached_target() const;
  void check(const Candidates& candidates) const;
  std::vector<double> evaluate(const Candidates& candidates);
  void note(const Candidates& candidates, const std::vector<double>& values);
  void add_row();
  std::string stop_reason() const;
  Archive state() const;
  void load(Archive& archive);

  const SearchTask task_;
  const SearchTarget& target_;
  const TuningOptions options_;
  const std::vector<std::string> names_;
  NodeContext& context_;
  std::unique_ptr<Search> search_;
  ProgressTable history_;
  Improvements improvements_;
  std::int64_t evaluations_ = 0;
  std::int64_t not_finite_ = 0;  ///< values that were NaN or infinite
  std::int64_t last_row_ = 0;    ///< evaluations when the history got its last row
  std::int64_t next_row_ = 0;
  double best_observed_;
  bool spread_ = true;  ///< whether evaluations take long enough for several threads
};

}  // namespace coppice
