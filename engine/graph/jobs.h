#pragma once

#include <string>
#include <vector>

#include "engine/graph/plan.h"
#include "engine/graph/status.h"

namespace coppice {

/// A node of one of several plans.
struct NodePlace {
  std::size_t plan = 0;
  std::size_t node = 0;
};

/// One result to compute: all nodes with its key, in all plans of a run.
struct Job {
  enum class State { waiting, running, done, failed, skipped, interrupted };
  std::string key;
  std::vector<NodePlace> places;        ///< the one that runs, then those that share its result
  std::vector<std::size_t> dependants;  ///< jobs that read it
  std::size_t waiting_for = 0;          ///< jobs that it reads and that are not done
  State state = State::waiting;
};

/// The jobs of a run, each after those that it reads. A job is there when one of its nodes is to run.
std::vector<Job> make_jobs(const std::vector<const Plan*>& plans,
                           const std::vector<std::vector<NodeStatus>>& statuses);

}  // namespace coppice
