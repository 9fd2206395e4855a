#pragma once

#include <string>
#include <string_view>

#include "registry/parameters.h"

namespace coppice {

// How declarations are shown: in error messages, the schema, the manual and descriptions.

/// "number", "list of integers", ...: what must be given, without unit and bounds; choices are listed.
std::string type_text(const ParameterInfo& info);

/// ">= 2", "> 0 s", "in [0, 1)"; "" when everything is allowed. Limits are in SI.
std::string bounds_text(const ParameterInfo& info);

/// "20 s": the default with its unit; "" when there is none.
std::string default_text(const ParameterInfo& info);

/// All in one: "number [s] > 0 s, default 0.05 s", "integer >= 2, required".
std::string parameter_text(const ParameterInfo& info);

/// "Learns the value. (an approximator, default extra_trees)"
std::string slot_text(const SlotInfo& slot);

}  // namespace coppice
