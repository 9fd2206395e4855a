#pragma once

#include <string>
#include <vector>

#include "registry/component.h"
#include "registry/language.h"

namespace coppice {

/// A page of the manual.
struct ManualPage {
  std::string file;  ///< "solver.md"
  std::string text;  ///< Markdown
};

/// The reference manual: an index (README.md), one page for each interface, one for the language's elements
/// and one for the units. A function of the declarations only.
std::vector<ManualPage> manual_pages(const Catalogue& catalogue, const Language& language);

}  // namespace coppice
