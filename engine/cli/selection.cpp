#include "engine/cli/selection.h"

#include "registry/text.h"

namespace coppice::cli {
namespace {

std::vector<std::string> separated(const std::vector<std::string>& lists) {
  std::vector<std::string> items;
  for (const std::string& list : lists) {
    for (const std::string_view item : split_list(list)) items.emplace_back(item);
  }
  return items;
}

}  // namespace

Selection SelectionInputs::selection() const {
  return {separated(only), separated(force)};
}

int thread_count(const CommandLine& line, const std::optional<std::uint64_t>& jobs) {
  constexpr std::uint64_t kMost = 1024;
  if (!jobs) return 0;
  if (*jobs == 0 || *jobs > kMost) {
    const std::string given = std::to_string(*jobs);
    throw line.error(given, "'--jobs' must be an integer in [1, 1024], not '" + given + "'");
  }
  return static_cast<int>(*jobs);
}

}  // namespace coppice::cli
