#pragma once

#include <atomic>
#include <filesystem>
#include <functional>

#include "engine/graph/running_context.h"
#include "engine/graph/store.h"

namespace coppice {

/// Runs one node in this process and stores what it made. Inputs lie in the run folder. `watch` gets the
/// context before the node runs, and null before the context ends. Whatever the node throws is thrown.
ResultRecord compute_node(const Plan& plan, std::size_t node, const std::filesystem::path& run_folder,
                          Store& store, TaskParallel& parallel,
                          const std::function<void(const RunningContext*)>& watch);

/// How to run a node in a process of its own.
struct ChildProgram {
  std::filesystem::path runner;
  std::size_t threads = 1;
};

/// What a node may use at most; 0: any. Only a process of its own can keep a limit.
struct Limits {
  double time = 0;    ///< s
  double memory = 0;  ///< byte

  Limits() = default;
  Limits(double seconds, double bytes) : time(seconds), memory(bytes) {}
  explicit Limits(const NodeOptions& node) : time(node.time_limit), memory(node.memory_limit) {}
  bool any() const { return time > 0 || memory > 0; }
};

/// The same in a process of its own, within limits. Throws std::runtime_error with the limit and
/// what was used, or what the process said; Interrupted when it was stopped.
ResultRecord compute_in_process(const PlannedNode& node, const Limits& limits,
                                const std::filesystem::path& run_folder, const Store& store,
                                const ChildProgram& program, const std::atomic<bool>& stop);

/// "1.5 GB", in units of 1000.
std::string memory_text(double bytes);

/// What an exception of a node says to the user. Call it while handling one.
std::string failure_text();

}  // namespace coppice
