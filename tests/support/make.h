#pragma once

#include <memory>
#include <string>

#include "registry/component.h"

namespace coppice {

/// Makes a component as a config does. Throws ConfigError.
template <class Interface>
Sub<Interface> make_from_xml(const std::string& xml) {
  const auto source = std::make_shared<SourceFile>(SourceFile{"test.xml", xml});
  Diagnostics diagnostics;
  Sub<Interface> made = make<Interface>(parse_xml(source), diagnostics);
  diagnostics.throw_if_any();
  return made;
}

}  // namespace coppice
