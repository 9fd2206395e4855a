#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "engine/graph/plan.h"

namespace coppice {

/// The program and the machine: version, commit, compiler, flags, libraries, processor, host, system. Names
/// and values in a fixed order; also what `runner --version` and `runner doctor` show.
std::vector<std::pair<std::string, std::string>> environment();

/// What provenance.json holds besides the environment.
struct Provenance {
  const Plan* plan = nullptr;
  std::vector<std::string> command;
  int threads = 0;
  std::string started;   ///< ISO 8601, UTC
  std::string finished;  ///< empty while the run goes on
  std::string outcome;   ///< "running", "done", "failed", "interrupted"
};

/// Throws std::runtime_error with the file and the system's reason.
void write_provenance(const std::filesystem::path& file, const Provenance& provenance);

/// Now, in ISO 8601, UTC, to the millisecond.
std::string timestamp();
/// The same for a time in ns since 1970.
std::string timestamp(std::int64_t since_1970_ns);

}  // namespace coppice
