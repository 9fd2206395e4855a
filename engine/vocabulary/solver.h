#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/vocabulary/approximator.h"
#include "engine/vocabulary/archive.h"
#include "engine/vocabulary/dataset.h"
#include "engine/vocabulary/policy.h"
#include "engine/vocabulary/problem.h"
#include "registry/component.h"

namespace coppice {

/// What a training gets. Referred-to objects outlive the training.
struct TrainingInputs {
  const Problem* problem = nullptr;
  const Dataset* samples = nullptr;  ///< null when the config gives none
  MadeFunction value;                ///< a value function learned elsewhere; may be empty
  MadePolicy initial_policy;         ///< prepared; may be empty
  Draws draws{0, "", 0};
};

/// How far a training is; also the row that progress.csv gets after each unit of work.
struct TrainingProgress {
  std::int64_t done = 0;   ///< units of work done
  std::int64_t total = 0;  ///< units of work in all, 0 when unknown
  std::vector<std::pair<std::string, double>>
      measures;  ///< named values of this row ("bellman_residual", ...)
};

/// What a training made.
struct TrainingResult {
  MadePolicy policy;   ///< always
  MadeFunction value;  ///< the value function, for solvers that have one
};

/// One training run, resumable. advance, save, load and result may be called from one thread at a time.
class Training {
 public:
  virtual ~Training() = default;
  /// Does one unit of work (an iteration); returns false when there is nothing left to do. Deterministic: the
  /// state after n units depends on inputs and n only.
  virtual bool advance(Parallel& parallel) = 0;
  virtual TrainingProgress progress() const = 0;
  /// Everything that advance needs to go on bit-identically in a new process.
  virtual void save(Archive& archive) const = 0;
  virtual void load(Archive& archive) = 0;
  /// After advance returned false.
  virtual TrainingResult result() const = 0;
};

/// Learns a policy. Immutable; holds the parameters only.
class Solver {
 public:
  static constexpr const char* kInterface = "solver";
  virtual ~Solver() = default;

  /// What `start` will ask of its inputs and what it makes use of, so that a config that lacks something, or
  /// gives something without effect, is refused before anything runs.
  struct Needs {
    bool samples = false;        ///< a dataset of transitions
    bool simulator = false;      ///< a problem that can be set to any state
    bool single_action = false;  ///< only one action id is supported
    bool uses_value = false;     ///< takes a value function learned elsewhere, when given
    bool uses_policy = false;    ///< takes a policy to begin with, when given
  };
  virtual Needs needs() const = 0;
  /// Names of all the measures that its progress has, with or without TrainingInputs::value, so that a figure
  /// of another one is refused before anything runs.
  virtual std::vector<std::string> measures(bool /*value_given*/) const { return {}; }
  /// Throws std::invalid_argument when it cannot learn for a problem of these spaces, with or without
  /// TrainingInputs::value. Called when planning, after what `needs` asks for was found.
  virtual void check(const Spaces&, bool /*value_given*/) const {}
  /// Throws std::invalid_argument when the inputs cannot be used.
  virtual std::unique_ptr<Training> start(const TrainingInputs& inputs) const = 0;
};

}  // namespace coppice
