#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace coppice {

/// The known name nearest to `given` (Damerau-Levenshtein, case-insensitive), or "" when none is near enough.
std::string nearest(std::string_view given, const std::vector<std::string>& known);

/// "did you mean 'x'?" when a name is near, else "valid: a, b, c" (the first dozen), else "".
std::string suggestion(std::string_view given, const std::vector<std::string>& known);

/// The name in the folder of `path` that is nearest to its last part, or "".
std::string nearest_file(const std::string& path);

}  // namespace coppice
