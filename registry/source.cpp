#include "registry/source.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <system_error>
#include <utility>

#include "registry/suggest.h"
#include "registry/text.h"
#include "registry/xml_scanner.h"

namespace coppice {
namespace {

[[noreturn]] void fail(Place place, std::string message, std::string hint = {}) {
  throw ConfigError({Diagnostic{std::move(place), std::move(message), std::move(hint), {}}});
}

std::string missing_file_hint(const std::filesystem::path& path) {
  const std::string name = nearest_file(path.string());
  return name.empty() ? "" : fmt::format("did you mean '{}'?", (path.parent_path() / name).string());
}

/// The bytes of a file; if they are more than `largest`, not all of them.
std::string read_bytes(const std::string& path, const Place& place, std::size_t largest) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) fail(place, "this is a folder, not a file");
  errno = 0;
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
  if (!file) {
    const int reason = errno;
    fail(place, "cannot read the file: " + std::generic_category().message(reason),
         reason == ENOENT ? missing_file_hint(path) : "");
  }
  std::string bytes;
  std::vector<char> buffer(std::size_t{1} << 16u);
  while (bytes.size() <= largest) {
    const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), file.get());
    if (count == 0) break;
    bytes.append(buffer.data(), count);
  }
  if (std::ferror(file.get()) != 0) {
    fail(place, "cannot read the file: " + std::generic_category().message(errno));
  }
  return bytes;
}

/// Line ends as LF, no byte order mark.
std::string normalized(std::string_view bytes) {
  if (bytes.starts_with("\xEF\xBB\xBF")) bytes.remove_prefix(3);
  std::string text;
  text.reserve(bytes.size());
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (bytes[i] != '\r') {
      text += bytes[i];
    } else if (i + 1 == bytes.size() || bytes[i + 1] != '\n') {
      text += '\n';
    }
  }
  return text;
}

/// The text that the bytes of a file are.
std::string text_of(const std::string& bytes, const Place& place) {
  if (trim(bytes).empty()) fail(place, "the file is empty");
  if (bytes.starts_with("\xFF\xFE") || bytes.starts_with("\xFE\xFF")) {
    fail(place, "the file is UTF-16 text", "save it as UTF-8");
  }
  if (bytes.find('\0') != std::string::npos) fail(place, "the file is binary, not text");
  return normalized(bytes);
}

/// Gives the parser's elements the places that the scanner found; both go through the text in the same order.
class Builder {
 public:
  explicit Builder(const std::vector<ScannedTag>& tags) : tags_(tags) {}

  Element build(const tinyxml2::XMLElement& parsed) {
    const ScannedTag& tag = tags_.at(next_++);
    Element element;
    element.name = parsed.Name();
    element.place = tag.name;
    std::size_t i = 0;
    for (const auto* attribute = parsed.FirstAttribute(); attribute != nullptr;
         attribute = attribute->Next(), ++i) {
      const ScannedAttribute& place = tag.attributes.at(i);
      element.attributes.push_back(
          {attribute->Name(), attribute->Value(), place.name, place.value, place.failed});
    }
    for (const auto* child = parsed.FirstChildElement(); child != nullptr;
         child = child->NextSiblingElement()) {
      element.children.push_back(build(*child));
    }
    return element;
  }

 private:
  const std::vector<ScannedTag>& tags_;
  std::size_t next_ = 0;
};

void append_xml(std::string& text, const Element& element, int indent) {
  text.append(static_cast<std::size_t>(indent), ' ');
  text += "<" + element.name;
  for (const Attribute& attribute : element.attributes) {
    text.append(" ").append(attribute.name).append("=\"");
    text.append(escape_xml(attribute.value)).append("\"");
  }
  if (element.children.empty()) {
    text += "/>\n";
    return;
  }
  text += ">\n";
  for (const Element& child : element.children) append_xml(text, child, indent + 2);
  text.append(static_cast<std::size_t>(indent), ' ');
  text += "</" + element.name + ">\n";
}

}  // namespace

const Attribute* Element::find(std::string_view attribute) const {
  const auto found = std::find_if(attributes.begin(), attributes.end(),
                                  [attribute](const Attribute& a) { return a.name == attribute; });
  return found == attributes.end() ? nullptr : &*found;
}

std::string_view Element::get(std::string_view attribute, std::string_view fallback) const {
  const Attribute* found = find(attribute);
  return found == nullptr ? fallback : std::string_view(found->value);
}

void Element::set(std::string_view attribute, std::string value) {
  const auto found = std::find_if(attributes.begin(), attributes.end(),
                                  [attribute](const Attribute& a) { return a.name == attribute; });
  if (found != attributes.end()) {
    found->value = std::move(value);
  } else {
    attributes.push_back({std::string(attribute), std::move(value), {}, {}});
  }
}

const Element* Element::child(std::string_view child_name) const {
  const auto found = std::find_if(children.begin(), children.end(),
                                  [child_name](const Element& c) { return c.name == child_name; });
  return found == children.end() ? nullptr : &*found;
}

const Place& place_of(const Attribute* attribute, const Element& element) {
  return attribute != nullptr && attribute->value_place.file ? attribute->value_place : element.place;
}

std::shared_ptr<const SourceFile> read_source(const std::string& path, std::size_t largest) {
  const auto source = std::make_shared<SourceFile>(SourceFile{path, {}});
  const Place place{source, 0, 0, 1, nullptr};
  const std::string bytes = read_bytes(path, place, largest);
  if (bytes.size() > largest) {
    fail(place, fmt::format("the file is larger than {} MiB, the most that is read", largest >> 20u));
  }
  source->text = text_of(bytes, place);
  return source;
}

std::shared_ptr<const SourceFile> read_head(const std::string& path, std::size_t enough) {
  const auto source = std::make_shared<SourceFile>(SourceFile{path, {}});
  const Place place{source, 0, 0, 1, nullptr};
  std::string bytes = read_bytes(path, place, enough);
  if (bytes.size() > enough) bytes.resize(bytes.rfind('\n') + 1);  // to 0 where there is none
  source->text = text_of(bytes, place);
  return source;
}

Element parse_xml(const std::shared_ptr<const SourceFile>& source) {
  std::vector<Diagnostic> mistakes;
  Element root = parse_xml(source, mistakes);
  if (!mistakes.empty()) throw ConfigError(std::move(mistakes));
  return root;
}

Element parse_xml(const std::shared_ptr<const SourceFile>& source, std::vector<Diagnostic>& mistakes) {
  const ScannedXml scanned = scan_xml(source);
  mistakes.insert(mistakes.end(), scanned.mistakes.begin(), scanned.mistakes.end());
  tinyxml2::XMLDocument document;
  if (document.Parse(scanned.text.data(), scanned.text.size()) != tinyxml2::XML_SUCCESS ||
      document.RootElement() == nullptr) {
    fail({source, document.ErrorLineNum(), 0, 1, nullptr}, "this is not well-formed XML");
  }
  Element root = Builder(scanned.tags).build(*document.RootElement());
  // What editors need to find the schema is nothing for us.
  std::erase_if(root.attributes, [](const Attribute& attribute) {
    return attribute.name == "xmlns:xsi" || attribute.name == "xsi:noNamespaceSchemaLocation";
  });
  return root;
}

std::string escape_xml(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\t':
        escaped += "&#9;";
        break;
      case '\n':
        escaped += "&#10;";
        break;
      case '\r':
        escaped += "&#13;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

std::string to_xml(const Element& element, int indent) {
  std::string text;
  append_xml(text, element, indent);
  return text;
}

}  // namespace coppice
