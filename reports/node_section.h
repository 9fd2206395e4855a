#pragma once

#include <string>

#include "engine/graph/status.h"
#include "registry/source.h"

namespace coppice {

/// The section of the page with the state of the nodes: failures in full, then what each id of the config
/// took. `experiment` is the root of resolved.xml.
std::string node_section(const Element& experiment, const RunStatus& status);

}  // namespace coppice
