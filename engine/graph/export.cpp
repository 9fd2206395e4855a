#include "engine/graph/export.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "registry/suggest.h"

namespace coppice {

std::shared_ptr<const Exporter> make_exporter(const std::string& format) {
  const std::vector<std::string> known = Catalogue::instance().names(Exporter::kInterface);
  if (std::find(known.begin(), known.end(), format) == known.end()) {
    throw std::invalid_argument(
        fmt::format("there is no export format '{}'; {}", format, suggestion(format, known)));
  }
  Element element;
  element.name = format;
  Diagnostics diagnostics;
  const Sub<Exporter> made = make<Exporter>(element, diagnostics);
  diagnostics.throw_if_any();
  return made.object;
}

void check_export_name(const std::string& name) {
  const bool well_formed =
      !name.empty() && name.front() >= 'a' && name.front() <= 'z' && name.size() <= 60 &&
      name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") == std::string::npos &&
      name.find("__") == std::string::npos;
  if (well_formed) return;
  throw std::invalid_argument(fmt::format(
      "the name of an export has up to 60 small letters, digits and single underscores and begins "
      "with a letter, as 'onboard_2'; '{}' does not",
      name));
}

ExportedPolicy exported_policy(std::string name, const MadePolicy& policy, const PolicyFile& file,
                               const Spaces& spaces) {
  check_export_name(name);
  try {
    return {std::move(name), policy.resolved.name, file.writer, file.provenance, spaces, policy->exported()};
  } catch (const std::invalid_argument& why) {
    throw std::invalid_argument(
        fmt::format("<{}> cannot be exported: it {}", policy.resolved.name, why.what()));
  }
}

}  // namespace coppice
