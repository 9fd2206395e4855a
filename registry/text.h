#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace coppice {

/// One code point of a UTF-8 text and how many bytes it takes.
struct CodePoint {
  char32_t value = 0;
  std::size_t bytes = 0;
};

/// The code point that starts at `offset` (inside the text); nothing where the bytes are not UTF-8.
std::optional<CodePoint> decode_utf8(std::string_view text, std::size_t offset);

/// Code points of a text; a byte that is not UTF-8 counts as one.
std::size_t count_characters(std::string_view text);

/// Columns that a character takes on a terminal: 0 (combining), 1, or 2 (East Asian wide, emoji).
int display_width(char32_t character);

/// Without white space (space, tab, line ends) at both ends.
std::string_view trim(std::string_view text);

/// The trimmed items of a list separated by commas; a blank text has none.
std::vector<std::string_view> split_list(std::string_view text);

/// "a, b, c"
std::string join(const std::vector<std::string>& items, std::string_view separator = ", ");

/// "a policy", "an evaluation"
std::string with_article(std::string_view noun);

}  // namespace coppice
