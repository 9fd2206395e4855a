#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace coppice {

// The language that stands around components, told by those who define it: the schema and the manual need it,
// the registry does not.

struct LanguageAttribute {
  std::string name;
  std::string doc;
  bool required = false;
};

/// What may stand inside an element of the language.
enum class LanguageContent {
  none,         ///< only `children`
  surrounding,  ///< `children`, and what may stand where the element stands ("group")
  anything      ///< whatever is well-formed ("macro", "call")
};

/// An element of the language itself ("include", "sweep"), not a component. The same name may be declared
/// several times, for different parents.
struct LanguageElement {
  std::string name;
  std::string doc;
  std::vector<LanguageAttribute> attributes;
  bool free_attributes = false;       ///< attributes of any name besides ("call")
  std::vector<std::string> children;  ///< names of other language elements allowed inside
  LanguageContent content = LanguageContent::none;
  std::vector<std::string> inside;  ///< the language elements it stands in; empty: this one holds elsewhere
  bool in_root = false;             ///< allowed in the root
  bool in_components = false;       ///< allowed in components and in their slots
};

struct Language {
  LanguageElement root;        ///< the document's element
  std::string root_interface;  ///< the components that stand in it
  std::vector<LanguageElement> elements;
  std::vector<LanguageAttribute> common;  ///< attributes of every element but the root ("if")
  std::map<std::string, std::string, std::less<>>
      interfaces;  ///< what each kind of component is, a sentence or two
};

/// The declaration of the language element `name` that stands in `parent` ("": in the root or a component).
/// Throws std::logic_error when there is none.
const LanguageElement& find_element(const Language& language, std::string_view name, std::string_view parent);

}  // namespace coppice
