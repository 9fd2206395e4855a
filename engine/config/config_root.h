#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "engine/config/files.h"

namespace coppice::config {

inline constexpr int kLanguageVersion = 1;  ///< of the config language: coppice="1"

/// What the root element of a file says.
struct RootAttributes {
  std::string name;
  std::string doc;
  std::optional<std::uint64_t> seed = 1;  ///< nothing after a mistake
  bool readable = false;                  ///< it is an <experiment> of a version that is known
};

/// Reads and checks the root of a file, to which expansion came by `trace`.
RootAttributes read_root(const LoadedFile& file, const Files& files,
                         const std::shared_ptr<const TraceFrame>& trace, Diagnostics& diagnostics);

}  // namespace coppice::config
