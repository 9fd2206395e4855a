#pragma once

#include <memory>
#include <string>
#include <vector>

#include "registry/error.h"

namespace coppice {

/// Where an attribute stands; the value's place is that of its first character, its length that of the raw
/// text.
struct ScannedAttribute {
  Place name, value;
  bool failed = false;  ///< its value is not known, which was reported
};

/// Where a start tag stands: its name and its attributes, in the order of the text.
struct ScannedTag {
  Place name;
  std::vector<ScannedAttribute> attributes;
};

/// What a scan of a text found: well-formed, or mended where it was not.
struct ScannedXml {
  std::vector<ScannedTag> tags;  ///< start tags in document order
  std::string text;  ///< the same XML with comments and instructions blanked, white space in values as spaces
  std::vector<Diagnostic> mistakes;  ///< after which the rest could be understood
};

inline constexpr std::size_t kMaxXmlDepth = 90;         ///< elements inside each other
inline constexpr std::size_t kMaxXmlAttributes = 1000;  ///< of an element

/// Finds every tag and attribute with its line and column, which the parser does not give, and refuses what
/// is not well-formed XML 1.0, or not allowed in a config (DOCTYPE, entities of one's own, text between
/// elements) with sentences of our own: where, what, and what it should be. Throws ConfigError, with all
/// mistakes so far, for one after which the rest cannot be understood.
ScannedXml scan_xml(const std::shared_ptr<const SourceFile>& source);

}  // namespace coppice
