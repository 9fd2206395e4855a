#pragma once

#include <filesystem>

#include "registry/component.h"

namespace coppice {

/// Shows a whole run folder to people, in a file of its own there.
class Report {
 public:
  static constexpr const char* kInterface = "report";
  virtual ~Report() = default;
  /// Reads what lies in the folder, also while the run goes on. Throws ConfigError when it is not one of a
  /// run, std::runtime_error when the file cannot be written.
  virtual void write(const std::filesystem::path& run_folder) const = 0;
};

/// Writes every report that there is.
void write_reports(const std::filesystem::path& run_folder);

}  // namespace coppice
