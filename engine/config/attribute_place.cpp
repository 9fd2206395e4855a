#include "engine/config/attribute_place.h"

#include <algorithm>
#include <optional>
#include <string_view>

#include "registry/text.h"

namespace coppice::config {
namespace {

/// Bytes of the user's text, and of the value that it stands for.
struct Piece {
  std::size_t raw = 1, value = 1;
};

std::size_t utf8_length(std::string_view digits) {
  const bool hexadecimal = digits.starts_with('x');
  unsigned long code = 0;
  for (const char c : digits.substr(hexadecimal ? 1 : 0)) {
    const int digit = c <= '9' ? c - '0' : (c | 0x20) - 'a' + 10;
    code = code * (hexadecimal ? 16 : 10) + static_cast<unsigned long>(digit);
  }
  return code < 0x80 ? 1 : code < 0x800 ? 2 : code < 0x10000 ? 3 : 4;
}

/// The character or entity at the beginning of `raw`.
Piece next_piece(std::string_view raw) {
  const std::size_t end = raw.front() == '&' ? raw.find(';') : std::string_view::npos;
  if (end == std::string_view::npos) return {};
  const std::string_view entity = raw.substr(1, end - 1);
  return {end + 1, entity.starts_with('#') ? utf8_length(entity.substr(1)) : 1};
}

/// The offset of a place in its file's text; nothing when the place is unknown.
std::optional<std::size_t> offset_of(const Place& place) {
  if (!place.file || place.line < 1 || place.column < 1) return std::nullopt;
  const std::string_view line = place.file->line(place.line);
  if (line.data() == nullptr) return std::nullopt;
  std::size_t offset = 0;
  for (int column = 1; column < place.column; ++column) {
    if (offset >= line.size()) return std::nullopt;
    const std::optional<CodePoint> character = decode_utf8(line, offset);
    offset += character ? character->bytes : 1;
  }
  return static_cast<std::size_t>(line.data() - place.file->text.data()) + offset;
}

}  // namespace

Place place_in(const Attribute& attribute, std::size_t offset, std::size_t length) {
  const Place& whole = attribute.value_place;
  const std::optional<std::size_t> start = offset_of(whole);
  if (!start || offset > attribute.value.size()) return whole;
  const std::string_view text = whole.file->text;
  std::size_t raw = *start, begin = *start;
  for (std::size_t value = 0; value < offset + length && raw < text.size();) {
    if (value <= offset) begin = raw;
    const Piece piece = next_piece(text.substr(raw));
    const char literal = text[raw] == '\n' || text[raw] == '\t' ? ' ' : text[raw];
    const bool same = value < attribute.value.size() && (piece.raw > 1 || literal == attribute.value[value]);
    if (!same) return whole;
    raw += piece.raw;
    value += piece.value;
    if (value <= offset) begin = raw;
  }
  Place place = whole;
  const std::string_view before = text.substr(0, begin);
  const std::size_t line_begin = before.rfind('\n') == std::string_view::npos ? 0 : before.rfind('\n') + 1;
  place.line += static_cast<int>(std::count(text.begin() + static_cast<std::ptrdiff_t>(*start),
                                            text.begin() + static_cast<std::ptrdiff_t>(begin), '\n'));
  place.column = 1 + static_cast<int>(count_characters(before.substr(line_begin)));
  const std::string_view marked = text.substr(begin, raw - begin);
  place.length = std::max(1, static_cast<int>(count_characters(marked.substr(0, marked.find('\n')))));
  return place;
}

}  // namespace coppice::config
