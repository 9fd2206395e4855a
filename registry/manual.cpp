#include "registry/manual.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "registry/describe.h"
#include "registry/parameter_text.h"
#include "registry/text.h"
#include "registry/units.h"

namespace coppice {
namespace {

constexpr const char* kGenerated =
    "<!-- Generated from the declarations of the components. Do not edit. -->\n\n";

/// A text on one line; signs that Markdown would take for its own are escaped.
std::string plain(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '\n') {
      escaped += ' ';
      continue;
    }
    if (c == '|' || c == '<' || c == '*' || c == '_' || c == '`') escaped += '\\';
    escaped += c;
  }
  return escaped;
}

std::string code(std::string_view text) {
  return text.empty() ? "" : fmt::format("`{}`", text);
}

std::string row(const std::vector<std::string>& cells) {
  return "| " + join(cells, " | ") + " |\n";
}

std::string head(const std::vector<std::string>& titles) {
  return row(titles) + row(std::vector<std::string>(titles.size(), "---"));
}

std::string value_cell(const ParameterInfo& info) {
  std::string text = type_text(info);
  if (const std::string bounds = bounds_text(info); !bounds.empty()) {
    text += " " + bounds;
  } else if (!info.unit.empty()) {
    text += " in " + info.unit;
  }
  return plain(text + (info.automatic ? " or auto" : ""));
}

std::string parameter_rows(const std::vector<const ParameterInfo*>& parameters) {
  if (parameters.empty()) return "";
  std::string text = head({"attribute", "value", "default", "meaning"});
  for (const ParameterInfo* info : parameters) {
    text += row({code(info->name), value_cell(*info), info->required ? "required" : code(default_text(*info)),
                 plain(info->doc)});
  }
  return text + "\n";
}

/// "arg", or "arg in include" where another <arg> stands elsewhere.
std::string title(const LanguageElement& element) {
  return element.inside.empty() ? element.name : element.name + " in " + join(element.inside);
}

/// A link to the section of that title; the anchor is made as Markdown viewers make it.
std::string link(const LanguageElement& element) {
  std::string anchor;
  for (const char c : title(element)) {
    if (c != ',') anchor += c == ' ' ? '-' : c;
  }
  return fmt::format("[`{}`](#{})", element.name, anchor);
}

class Manual {
 public:
  Manual(const Catalogue& catalogue, const Language& language) : catalogue_(catalogue), language_(language) {}

  std::vector<ManualPage> pages() const {
    std::vector<ManualPage> pages = {index_page()};
    for (const std::string& interface : catalogue_.interfaces()) pages.push_back(interface_page(interface));
    pages.push_back(language_page());
    pages.push_back(units_page());
    return pages;
  }

 private:
  std::string interface_doc(const std::string& interface) const {
    const auto found = language_.interfaces.find(interface);
    return found == language_.interfaces.end() ? "" : found->second + "\n\n";
  }

  std::string component_table(const std::string& interface, const std::string& file) const {
    std::string text = head({"element", "what it is"});
    for (const ComponentInfo* info : catalogue_.all(interface)) {
      text += row({fmt::format("[`{0}`]({1}#{0})", info->name, file), plain(info->doc)});
    }
    return text + "\n";
  }

  ManualPage index_page() const {
    std::string text = std::string(kGenerated) + "# Reference\n\n";
    text +=
        "Every element and attribute that a config may hold, from the declarations that the program itself "
        "reads by. `runner describe NAME` shows the same for one component.\n\n";
    text += fmt::format("- [The elements of the language](language.md): {}\n", element_list());
    text += "- [Units](units.md)\n\n";
    for (const std::string& interface : catalogue_.interfaces()) {
      const std::string file = interface + ".md";
      text += fmt::format("## [{}]({})\n\n", interface, file) + interface_doc(interface) +
              component_table(interface, file);
    }
    return {"README.md", std::move(text)};
  }

  std::string element_list() const {
    std::vector<std::string> names = {code(language_.root.name)};
    for (const LanguageElement& element : language_.elements) {
      if (std::find(names.begin(), names.end(), code(element.name)) == names.end())
        names.push_back(code(element.name));
    }
    return join(names);
  }

  /// Which components have a place for this kind.
  std::string users(const std::string& interface) const {
    std::set<std::string> links;
    for (const std::string& other : catalogue_.interfaces()) {
      for (const ComponentInfo* info : catalogue_.all(other)) {
        for (const SlotInfo& slot : info->slots) {
          if (slot.interface == interface)
            links.insert(fmt::format("[`{0}`]({1}.md#{0})", info->name, other));
        }
      }
    }
    if (interface == language_.root_interface) links.insert(code(language_.root.name));
    return links.empty() ? "" : "Stands in: " + join({links.begin(), links.end()}) + ".\n\n";
  }

  ManualPage interface_page(const std::string& interface) const {
    const std::vector<std::string> common = common_parameters(catalogue_, interface);
    std::string text = std::string(kGenerated) + fmt::format("# {}\n\n", interface);
    text += interface_doc(interface) + users(interface) + component_table(interface, "");
    if (!common.empty()) {
      text += "## Attributes of all of them\n\n";
      text += parameter_rows(select(*catalogue_.all(interface).front(), common, true));
    }
    for (const ComponentInfo* info : catalogue_.all(interface)) text += component_section(*info, common);
    text.pop_back();  // one line end is enough
    return {interface + ".md", std::move(text)};
  }

  static std::vector<const ParameterInfo*> select(const ComponentInfo& info,
                                                  const std::vector<std::string>& names, bool inside) {
    std::vector<const ParameterInfo*> selected;
    for (const ParameterInfo& parameter : info.parameters) {
      const bool named = std::find(names.begin(), names.end(), parameter.name) != names.end();
      if (named == inside) selected.push_back(&parameter);
    }
    return selected;
  }

  std::string component_section(const ComponentInfo& info, const std::vector<std::string>& common) const {
    std::string text =
        fmt::format("## {}\n\n{}\n\nSource: {}\n\n", info.name, plain(info.doc), plain(info.source));
    text += parameter_rows(select(info, common, false));
    if (!info.slots.empty()) text += head({"inside", "what", "default", "meaning"});
    for (const SlotInfo& slot : info.slots) {
      const std::string kind = fmt::format("[{0}]({0}.md)", slot.interface);
      text += row({slot.direct ? "the element itself" : code("<" + slot.name + ">"),
                   slot.many ? "any number of " + kind : kind,
                   !slot.default_component.empty() ? code(slot.default_component)
                   : slot.required                 ? "required"
                                                   : "",
                   plain(slot.doc)});
    }
    if (!info.slots.empty()) text += "\n";
    return text + "```xml\n" + to_xml(example_of(catalogue_, info)) + "```\n\n";
  }

  ManualPage language_page() const {
    std::string text = std::string(kGenerated) + "# The elements of the language\n\n";
    if (!language_.common.empty()) {
      text += "Every element but the root, of the language or not, may have:\n\n" +
              attribute_rows(language_.common);
    }
    text += element_section(language_.root);
    for (const LanguageElement& element : language_.elements) text += element_section(element);
    text.pop_back();
    return {"language.md", std::move(text)};
  }

  static std::string attribute_rows(const std::vector<LanguageAttribute>& attributes) {
    if (attributes.empty()) return "";
    std::string text = head({"attribute", "", "meaning"});
    for (const LanguageAttribute& attribute : attributes) {
      text += row({code(attribute.name), attribute.required ? "required" : "", plain(attribute.doc)});
    }
    return text + "\n";
  }

  std::string element_section(const LanguageElement& element) const {
    std::string text = fmt::format("## {}\n\n{}\n\n", title(element), plain(element.doc)) +
                       attribute_rows(element.attributes);
    if (element.free_attributes) text += "Further attributes have any names.\n\n";
    std::vector<std::string> inside;
    for (const std::string& child : element.children) {
      inside.push_back(link(find_element(language_, child, element.name)));
    }
    if (&element == &language_.root) {
      inside.push_back(fmt::format("[{0}]({0}.md)", language_.root_interface));
      for (const LanguageElement& other : language_.elements) {
        if (other.in_root) inside.push_back(link(other));
      }
    } else if (element.content == LanguageContent::surrounding) {
      inside.emplace_back("whatever may stand around it");
    } else if (element.content == LanguageContent::anything) {
      inside.emplace_back("any elements");
    }
    if (!inside.empty()) text += "Inside: " + join(inside) + ".\n\n";
    return text;
  }

  static ManualPage units_page() {
    std::map<std::string, std::vector<std::string>> units;
    std::vector<std::string> order;
    for (const NamedUnit& unit : named_units()) {
      std::string dimension = dimension_text(unit.value.dimension);
      if (!units.contains(dimension)) order.push_back(dimension);
      units[std::move(dimension)].push_back(fmt::format("`{}`", unit.name));
    }
    std::string text = std::string(kGenerated) + "# Units\n\n";
    text +=
        "A number may carry a unit: `20 deg`, `3 h`, `2 cm`. Products, quotients and integer powers are "
        "units too: "
        "`m/s^2`, `kg*m^2`, `deg/s`. Inside, everything is in the SI unit that the attribute declares, and a "
        "number "
        "without unit is taken in it. A unit of another kind is an error: degrees never pass for a plain "
        "number.\n\n";
    text += head({"kind (unit inside)", "units"});
    for (const std::string& dimension : order) text += row({plain(dimension), join(units.at(dimension))});
    return {"units.md", std::move(text)};
  }

  const Catalogue& catalogue_;
  const Language& language_;
};

}  // namespace

std::vector<ManualPage> manual_pages(const Catalogue& catalogue, const Language& language) {
  return Manual(catalogue, language).pages();
}

}  // namespace coppice
