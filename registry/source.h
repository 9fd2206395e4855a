#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "registry/error.h"

namespace coppice {

/// name="value" with its places. Values made by the program have no file.
struct Attribute {
  std::string name;
  std::string value;
  Place name_place;
  Place value_place;  ///< of the first character inside the quotes
  /// Its value could not be worked out, and that was reported: readers treat it as given and say nothing
  /// more.
  bool failed = false;
};

/// A located XML element; a plain value that expansion copies and edits.
struct Element {
  std::string name;
  Place place;  ///< of the name, after '<'
  std::vector<Attribute> attributes;
  std::vector<Element> children;
  /// Some of its children could not be worked out, and that was reported: readers do not miss any.
  bool failed = false;

  const Attribute* find(std::string_view attribute) const;
  /// The attribute's value, or `fallback`.
  std::string_view get(std::string_view attribute, std::string_view fallback = {}) const;
  /// Adds the attribute or replaces its value.
  void set(std::string_view attribute, std::string value);
  const Element* child(std::string_view child_name) const;
};

/// Where an attribute's value stands; the element's place when it is not given.
const Place& place_of(const Attribute* attribute, const Element& element);

/// Reads a file of at most `largest` bytes. A file that cannot be read, is empty or is not text gives one
/// located error.
std::shared_ptr<const SourceFile> read_source(const std::string& path,
                                              std::size_t largest = std::size_t{64} << 20);

/// The whole lines within the first `enough` bytes of a file or a little more; else as read_source.
std::shared_ptr<const SourceFile> read_head(const std::string& path, std::size_t enough);

/// Parses the root element of a text, refusing what XML forbids and tinyxml2 lets pass: a second root, text
/// after the root, entities other than the five, DOCTYPE; also text between elements. Throws ConfigError.
Element parse_xml(const std::shared_ptr<const SourceFile>& source);
/// The same, but goes on after mistakes that leave the rest clear, and adds them to `mistakes`.
Element parse_xml(const std::shared_ptr<const SourceFile>& source, std::vector<Diagnostic>& mistakes);

/// The text as it is written inside XML, in quotes or between tags.
std::string escape_xml(std::string_view text);

/// The element as XML text, attributes in order, two spaces of indent. parse_xml reads it back to the same
/// tree.
std::string to_xml(const Element& element, int indent = 0);

}  // namespace coppice
