#include "registry/schema.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "registry/parameter_text.h"
#include "registry/schema_types.h"
#include "registry/text.h"
#include "registry/xml_writer.h"

namespace coppice {
namespace {

/// Children are checked by name, not by order or number: conditions and macros decide those when reading.
const XmlWriter::Attributes kAnyNumber = {{"minOccurs", "0"}, {"maxOccurs", "unbounded"}};

class SchemaWriter {
 public:
  SchemaWriter(const Catalogue& catalogue, const Language& language)
      : catalogue_(catalogue), language_(language) {}

  std::string write() {
    write_schema();
    return xml_.text();
  }

 private:
  using Names = std::set<std::string, std::less<>>;

  static SlotInfo direct_slot(const std::string& interface) {
    SlotInfo slot;
    slot.name = slot.interface = interface;
    slot.direct = true;
    return slot;
  }

  void write_schema() {
    const auto schema = xml_.open("xs:schema", {{"xmlns:xs", "http://www.w3.org/2001/XMLSchema"}});
    write_root();
    write_content_group("content.root", {direct_slot(language_.root_interface)}, true);
    write_content_group("content.none", {}, false);
    write_language_types();
    for (const std::string& interface : catalogue_.interfaces()) write_interface(interface);
    for (const std::string& interface : wrapped_interfaces()) write_slot_type(interface);
    write_common_attributes();
    write_value_types(xml_);
  }

  void write_root() {
    const auto root = xml_.open("xs:element", {{"name", language_.root.name}});
    xml_.documentation(language_.root.doc);
    const auto type = xml_.open("xs:complexType");
    write_content("content.root");
    for (const LanguageAttribute& attribute : language_.root.attributes) write_attribute(attribute);
  }

  void write_content(const std::string& group) {
    const auto choice = xml_.open("xs:choice", kAnyNumber);
    xml_.leaf("xs:group", {{"ref", group}});
  }

  void write_attributes(const std::vector<LanguageAttribute>& attributes) {
    for (const LanguageAttribute& attribute : attributes) {
      for (const LanguageAttribute& common : language_.common) check_distinct(attribute.name, common.name);
      write_attribute(attribute);
    }
    xml_.leaf("xs:attributeGroup", {{"ref", "common"}});
  }

  void write_common_attributes() {
    const auto group = xml_.open("xs:attributeGroup", {{"name", "common"}});
    for (const LanguageAttribute& attribute : language_.common) write_attribute(attribute);
  }

  static void check_distinct(const std::string& name, const std::string& common) {
    if (name == common)
      throw std::logic_error("schema: '" + name + "' is an attribute of every element already");
  }

  void write_attribute(const LanguageAttribute& attribute) {
    const auto open = xml_.open("xs:attribute", {{"name", attribute.name},
                                                 {"type", "xs:string"},
                                                 {"use", attribute.required ? "required" : "optional"}});
    xml_.documentation(attribute.doc);
  }

  void claim(Names& names, const std::string& name, const std::string& group) const {
    if (!names.insert(name).second) {
      throw std::logic_error(fmt::format("schema: two kinds of <{}> may stand in {}", name, group));
    }
  }

  /// What may stand in one place: sub-components, slots, and elements of the language.
  void write_content_group(const std::string& group, const std::vector<SlotInfo>& slots, bool root) {
    const auto open = xml_.open("xs:group", {{"name", group}});
    const auto choice = xml_.open("xs:choice");
    Names names;
    for (const SlotInfo& slot : slots) {
      if (!slot.direct) write_slot(slot, group, names);
    }
    for (const SlotInfo& slot : slots) {
      if (slot.direct) write_direct(slot.interface, names);
    }
    for (const LanguageElement& element : language_.elements) {
      if (!(root ? element.in_root : element.in_components)) continue;
      claim(names, element.name, group);
      write_language_element(element, group);
    }
  }

  void write_slot(const SlotInfo& slot, const std::string& group, Names& names) {
    claim(names, slot.name, group);
    const auto element = xml_.open("xs:element", {{"name", slot.name}, {"type", "slot." + slot.interface}});
    xml_.documentation(slot_text(slot));
  }

  /// Where two interfaces that fit have a component of the same name, the first one is meant, as when
  /// reading.
  void write_direct(const std::string& interface, Names& names) {
    const std::vector<std::string> components = catalogue_.names(interface);
    if (components.empty()) return;
    const bool shared = std::any_of(components.begin(), components.end(),
                                    [&](const std::string& name) { return names.contains(name); });
    if (!shared) xml_.leaf("xs:group", {{"ref", "any." + interface}});
    for (const std::string& name : components) {
      const bool first = names.insert(name).second;
      if (shared && first) write_component_element(interface, name);
    }
  }

  void write_component_element(const std::string& interface, const std::string& name) {
    const auto element = xml_.open("xs:element", {{"name", name}, {"type", interface + "." + name}});
    xml_.documentation(catalogue_.find(interface, name)->doc);
  }

  static std::string type_name(const LanguageElement& element) {
    return "language." + (element.inside.empty() ? "" : element.inside.front() + ".") + element.name;
  }

  void write_language_element(const LanguageElement& element, const std::string& group) {
    if (element.content != LanguageContent::surrounding) {
      const auto open = xml_.open("xs:element", {{"name", element.name}, {"type", type_name(element)}});
      xml_.documentation(element.doc);
      return;
    }
    const auto open = xml_.open("xs:element", {{"name", element.name}});
    xml_.documentation(element.doc);
    const auto type = xml_.open("xs:complexType");
    write_content(group);
    write_language_attributes(element);
  }

  void write_language_attributes(const LanguageElement& element) {
    write_attributes(element.attributes);
    if (element.free_attributes) xml_.leaf("xs:anyAttribute", {{"processContents", "skip"}});
  }

  void write_language_types() {
    for (const LanguageElement& element : language_.elements) {
      if (element.content == LanguageContent::surrounding) continue;
      const auto type = xml_.open("xs:complexType", {{"name", type_name(element)}});
      if (element.content == LanguageContent::anything) {
        const auto sequence = xml_.open("xs:sequence");
        xml_.leaf("xs:any", {{"minOccurs", "0"}, {"maxOccurs", "unbounded"}, {"processContents", "skip"}});
      } else if (!element.children.empty()) {
        write_content("inside." + type_name(element));
      }
      write_language_attributes(element);
    }
    for (const LanguageElement& element : language_.elements) {
      if (element.children.empty()) continue;
      const std::string name = "inside." + type_name(element);
      const auto group = xml_.open("xs:group", {{"name", name}});
      const auto choice = xml_.open("xs:choice");
      for (const std::string& child : element.children)
        write_language_element(find_element(language_, child, element.name), name);
      for (const LanguageElement& other : language_.elements) {  // what is replaced by others when reading
        const bool declared =
            std::find(element.children.begin(), element.children.end(), other.name) != element.children.end();
        if (other.in_components && !declared) write_language_element(other, name);
      }
    }
  }

  /// Interfaces whose components stand inside an element of their own somewhere.
  Names wrapped_interfaces() const {
    Names names;
    for (const std::string& interface : catalogue_.interfaces()) {
      for (const ComponentInfo* info : catalogue_.all(interface)) {
        for (const SlotInfo& slot : info->slots) {
          if (!slot.direct) names.insert(slot.interface);
        }
      }
    }
    return names;
  }

  void write_slot_type(const std::string& interface) {
    const std::string parts = "parts." + interface;
    write_content_group(parts, {direct_slot(interface)}, false);
    const auto type = xml_.open("xs:complexType", {{"name", "slot." + interface}});
    write_content(parts);
    write_attributes({});
  }

  void write_interface(const std::string& interface) {
    {
      const auto group = xml_.open("xs:group", {{"name", "any." + interface}});
      const auto choice = xml_.open("xs:choice");
      for (const std::string& name : catalogue_.names(interface)) write_component_element(interface, name);
    }
    for (const ComponentInfo* info : catalogue_.all(interface)) write_component(*info);
  }

  void write_component(const ComponentInfo& info) {
    const std::string name = info.interface + "." + info.name;
    const std::string content = info.slots.empty() ? "content.none" : "content." + name;
    if (!info.slots.empty()) write_content_group(content, info.slots, false);
    const auto type = xml_.open("xs:complexType", {{"name", name}});
    xml_.documentation(fmt::format("{}\nSource: {}", info.doc, info.source));
    write_content(content);
    for (const ParameterInfo& parameter : info.parameters) {
      for (const LanguageAttribute& common : language_.common) check_distinct(parameter.name, common.name);
      const auto attribute = xml_.open(
          "xs:attribute", {{"name", parameter.name}, {"use", parameter.required ? "required" : "optional"}});
      xml_.documentation(fmt::format("{}\n[{}]", parameter.doc, parameter_text(parameter)));
      write_value_type(xml_, parameter);
    }
    write_attributes({});
  }

  const Catalogue& catalogue_;
  const Language& language_;
  XmlWriter xml_;
};

}  // namespace

std::string xml_schema(const Catalogue& catalogue, const Language& language) {
  return SchemaWriter(catalogue, language).write();
}

}  // namespace coppice
