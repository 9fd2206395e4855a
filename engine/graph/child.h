#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

namespace coppice {

/// How a child process ended.
struct ChildEnd {
  enum class How { exited, signalled, out_of_time, interrupted };
  How how = How::exited;
  int code = 0;  ///< exit status, or number of the signal
  double wall_s = 0;
  double cpu_s = 0;
  double peak_memory = 0;  ///< bytes, resident
  std::string errors;      ///< the last 64 kB of its standard error
};

/// Runs a program to its end; its standard output is dropped. When `stop` is set, or after `time_limit` s (0:
/// no limit), it is interrupted (SIGINT), and killed if it has not ended 5 s later (at a limit: a tenth of
/// it, but 0.5 to 5 s). It is killed, too, when this process dies. Throws std::runtime_error when it cannot
/// be started.
ChildEnd run_child(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                   double time_limit, const std::atomic<bool>& stop);

/// To be called by a process that may be a child of run_child: lets it die with its parent.
void die_with_parent();

/// Lets allocations fail (std::bad_alloc) when this process uses `bytes` of memory more than what it only
/// reserved so far. To be called when its threads have been started.
void limit_memory(double bytes);
/// Takes this limit back: to say that memory ran out takes some.
void release_memory_limit();
/// Most memory that this process has used, in bytes.
double peak_memory();

}  // namespace coppice
