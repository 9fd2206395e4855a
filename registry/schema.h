#pragma once

#include <string>

#include "registry/component.h"
#include "registry/language.h"

namespace coppice {

/// XSD 1.0 of all configs that the components and the language allow, as editors and xmllint take it. Written
/// for texts before expansion: every value may also be an expression ("${...}", "$(...)"). Types are local to
/// their context, since components of different interfaces share names. What it refuses, reading refuses too;
/// rules that XSD cannot say (references, checks between parameters, bounds of numbers with units) are left
/// to reading. Throws std::logic_error when names of the language and of components or parameters clash.
std::string xml_schema(const Catalogue& catalogue, const Language& language);

}  // namespace coppice
