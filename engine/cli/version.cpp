#include "engine/cli/version.h"

#include <fmt/format.h>

#include "engine/graph/provenance.h"

namespace coppice::cli {

std::string version_text() {
  std::string text;
  for (const auto& [name, value] : environment()) text += fmt::format("{}: {}\n", name, value);
  return text;
}

}  // namespace coppice::cli
