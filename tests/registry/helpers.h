#pragma once

#include <memory>
#include <string>
#include <vector>

#include "registry/source.h"

namespace coppice::test {

inline std::shared_ptr<const SourceFile> text_file(std::string text, std::string path = "a.xml") {
  return std::make_shared<SourceFile>(SourceFile{std::move(path), std::move(text)});
}

inline Element parse(std::string text, std::string path = "a.xml") {
  return parse_xml(text_file(std::move(text), std::move(path)));
}

/// The mistakes that parsing a text reports; none when it is good.
inline std::vector<Diagnostic> mistakes_of(std::string text) {
  try {
    parse(std::move(text));
    return {};
  } catch (const ConfigError& error) {
    return error.diagnostics();
  }
}

inline std::string text_of(const std::vector<Diagnostic>& diagnostics) {
  std::string text;
  for (const Diagnostic& diagnostic : diagnostics) text += to_text(diagnostic);
  return text;
}

}  // namespace coppice::test
