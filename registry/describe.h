#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "registry/component.h"

namespace coppice {

/// A component as the user reads it: interface, doc, source, parameters with type, unit, bounds, default and
/// doc, sub-components, an example. `width` columns.
std::string describe_text(const ComponentInfo& info, std::size_t width = 100);

/// The same as data. Defaults are in SI, as in a resolved file.
nlohmann::ordered_json describe_json(const ComponentInfo& info);

/// An element that uses the component: what is required (with values that suit types and bounds; ids and
/// files have invented names), and its first optional parameters with their defaults.
Element example_of(const ComponentInfo& info);

}  // namespace coppice
