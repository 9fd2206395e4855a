#pragma once

#include <filesystem>
#include <string>

#include "registry/source.h"

namespace coppice {

/// The section of the page with the tables in a subfolder ("tables", "figures") of a run folder, in the order
/// of the experiment's nodes; "" when there are none. `experiment` is the root of resolved.xml.
std::string published_section(const std::filesystem::path& run_folder, const Element& experiment,
                              const std::string& subfolder, std::string_view title);

}  // namespace coppice
