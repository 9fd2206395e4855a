#include "reports/html.h"

#include <fmt/format.h>

#include "registry/text.h"

namespace coppice::html {

std::string escaped(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (std::size_t i = 0; i < text.size();) {
    const std::optional<CodePoint> character = decode_utf8(text, i);
    const std::size_t bytes = character ? character->bytes : 1;
    const char32_t c = character ? character->value : U'\xFFFD';
    const bool forbidden =
        (c < 0x20 && c != '\t' && c != '\n' && c != '\r') || c == 0xFFFD || c == 0xFFFE || c == 0xFFFF;
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        out += forbidden ? std::string_view("\xEF\xBF\xBD") : text.substr(i, bytes);
    }
    i += bytes;
  }
  return out;
}

std::string link(std::string_view path) {
  std::string out;
  for (const char c : path) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       std::string_view("-._~/").find(c) != std::string_view::npos;
    out += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return out;
}

std::string element(std::string_view name, std::string_view content, const Attributes& attributes) {
  std::string given;
  for (const auto& [attribute, value] : attributes) {
    if (!value.empty()) given += fmt::format(" {}=\"{}\"", attribute, escaped(value));
  }
  return fmt::format("<{}{}>{}</{}>", name, given, content, name);
}

std::string text_element(std::string_view name, std::string_view text, const Attributes& attributes) {
  return element(name, escaped(text), attributes);
}

}  // namespace coppice::html
