#include "engine/cli/selection.h"

#include "registry/text.h"

namespace coppice::cli {
namespace {

std::vector<SelectedNode> separated(const CommandLine& line, const std::vector<std::string>& lists) {
  std::vector<SelectedNode> items;
  for (const std::string& list : lists) {
    for (const std::string_view item : split_list(list)) {
      Place place = line.place(list);
      const auto before = static_cast<std::size_t>(item.data() - list.data());
      place.column += static_cast<int>(count_characters(std::string_view(list).substr(0, before)));
      place.length = static_cast<int>(count_characters(item));
      items.emplace_back(std::string(item), std::move(place));
    }
  }
  return items;
}

}  // namespace

Selection SelectionInputs::selection(const CommandLine& line) const {
  return {separated(line, only), separated(line, force)};
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
