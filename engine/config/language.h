#pragma once

#include "registry/language.h"

namespace coppice {

/// The config language around components, told to the schema, the manual and `describe`.
const Language& config_language();

}  // namespace coppice
