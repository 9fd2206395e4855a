#pragma once

#include <cstddef>

#include "registry/source.h"

namespace coppice::config {

/// Where value[offset, offset + length) stands in the user's text; characters that were written as entities
/// (&lt;) are accounted for. Falls back to the place of the whole value where that is not the text that the
/// user wrote.
Place place_in(const Attribute& attribute, std::size_t offset, std::size_t length);

}  // namespace coppice::config
