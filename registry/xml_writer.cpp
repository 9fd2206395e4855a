#include "registry/xml_writer.h"

#include "registry/source.h"

namespace coppice {

XmlWriter::Scope XmlWriter::open(const std::string& name, const Attributes& attributes) {
  tag(name, attributes, ">\n");
  ++depth_;
  return Scope(*this, name);
}

void XmlWriter::leaf(const std::string& name, const Attributes& attributes) {
  tag(name, attributes, "/>\n");
}

void XmlWriter::documentation(std::string_view text) {
  text_.append(2 * depth_, ' ');
  text_ += "<xs:annotation><xs:documentation>" + escape_xml(text) + "</xs:documentation></xs:annotation>\n";
}

void XmlWriter::tag(const std::string& name, const Attributes& attributes, std::string_view end) {
  text_.append(2 * depth_, ' ');
  text_ += "<" + name;
  for (const auto& [attribute, value] : attributes)
    text_ += " " + attribute + "=\"" + escape_xml(value) + "\"";
  text_ += end;
}

void XmlWriter::close(const std::string& name) {
  --depth_;
  text_.append(2 * depth_, ' ');
  text_ += "</" + name + ">\n";
}

}  // namespace coppice
