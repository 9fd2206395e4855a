#include "registry/language.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace coppice {

const LanguageElement& find_element(const Language& language, std::string_view name,
                                    std::string_view parent) {
  const LanguageElement* elsewhere = nullptr;
  for (const LanguageElement& element : language.elements) {
    if (element.name != name) continue;
    if (std::find(element.inside.begin(), element.inside.end(), parent) != element.inside.end())
      return element;
    if (element.inside.empty()) elsewhere = &element;
  }
  if (elsewhere != nullptr) return *elsewhere;
  throw std::logic_error(fmt::format("the language has no <{}> for <{}>", name, parent));
}

}  // namespace coppice
