#pragma once

#include <string>

namespace coppice::cli {

/// What `runner --version` shows: the program first, then what it was built with.
std::string version_text();

}  // namespace coppice::cli
