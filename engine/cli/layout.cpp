#include "engine/cli/layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "registry/text.h"

namespace coppice::cli {
namespace {

std::size_t display_columns(std::string_view text) {
  std::size_t columns = 0;
  for (std::size_t offset = 0; offset < text.size();) {
    const auto character = decode_utf8(text, offset);
    columns += character ? static_cast<std::size_t>(display_width(character->value)) : 1;
    offset += character ? character->bytes : 1;
  }
  return columns;
}

}  // namespace

std::string wrapped(std::string_view text, std::size_t width, std::size_t indent) {
  std::string out;
  std::size_t column = 0;
  while (!text.empty()) {
    const std::size_t end = text.find_first_of(" \n");
    const std::string_view word = text.substr(0, end);
    if (column > indent && column + word.size() > width) {
      while (out.ends_with(' ')) out.pop_back();
      out += '\n' + std::string(indent, ' ');
      column = indent;
    }
    out += word;
    column += word.size();
    if (end == std::string_view::npos) break;
    out += text[end];
    column = text[end] == '\n' ? 0 : column + 1;
    text.remove_prefix(end + 1);
  }
  return out;
}

std::string aligned(const std::vector<std::vector<std::string>>& rows, std::size_t indent,
                    std::size_t width) {
  std::vector<std::size_t> widths;
  for (const std::vector<std::string>& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], display_columns(row[i]));
  }
  std::string text;
  for (const std::vector<std::string>& row : rows) {
    std::string line(indent, ' ');
    std::size_t column = indent;
    for (std::size_t i = 0; i < row.size(); ++i) {
      line += row[i];
      if (i + 1 == row.size()) break;
      line.append(widths[i] - display_columns(row[i]) + 2, ' ');
      column += widths[i] + 2;
    }
    while (line.ends_with(' ')) line.pop_back();
    text += (width > column + 20 ? wrapped(line, width, column) : line) + '\n';
  }
  return text;
}

std::string shortened(std::string_view text, std::size_t width) {
  if (display_columns(text) <= width) return std::string(text);
  std::size_t offset = 0, columns = 0;
  while (offset < text.size()) {
    const auto character = decode_utf8(text, offset);
    const std::size_t next =
        columns + (character ? static_cast<std::size_t>(display_width(character->value)) : 1);
    if (next + 3 > width) break;
    columns = next;
    offset += character ? character->bytes : 1;
  }
  return std::string(text.substr(0, offset)) + std::string(std::min<std::size_t>(3, width), '.');
}

std::string duration_text(double seconds) {
  if (seconds < 9.95) return fmt::format("{:.1f} s", std::max(seconds, 0.0));
  const std::int64_t whole = std::llround(seconds);
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
}

std::string counted(std::size_t number, std::string_view noun) {
  return fmt::format("{} {}{}", number, noun, number == 1 ? "" : "s");
}

}  // namespace coppice::cli
