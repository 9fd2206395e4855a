#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "registry/component.h"

namespace coppice {

/// A component as the user reads it: kind, doc, source, parameters with type, unit, bounds, default and doc,
/// sub-components, an example.
std::string describe_text(const Catalogue& catalogue, const ComponentInfo& info, std::size_t width = 100);

/// The same as data. Bounds and defaults are in SI, as in a resolved file.
nlohmann::ordered_json describe_json(const Catalogue& catalogue, const ComponentInfo& info);

/// An element that uses the component: what is required (values suit types and bounds; ids and files have
/// invented names), its first optional parameters with their defaults, and its sub-components.
Element example_of(const Catalogue& catalogue, const ComponentInfo& info);

/// Names of the parameters that all components of an interface share (none where there are fewer than three).
std::vector<std::string> common_parameters(const Catalogue& catalogue, std::string_view interface);

}  // namespace coppice
