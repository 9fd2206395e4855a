#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace coppice::cli {

/// Wraps each line of `text` at spaces; where it was broken, it goes on `indent` columns to the right.
std::string wrapped(std::string_view text, std::size_t width, std::size_t indent = 0);

/// Rows with their columns aligned, two blanks between them, each row after `indent` blanks. The last column
/// is wrapped when `width` is given.
std::string aligned(const std::vector<std::vector<std::string>>& rows, std::size_t indent = 0,
                    std::size_t width = 0);

/// At most `width` columns of the text as a terminal shows it, the cut marked with "...".
std::string shortened(std::string_view text, std::size_t width);

/// "0.4 s", "31 s", "12 min 5 s", "3 h 20 min".
std::string duration_text(double seconds);

/// "1 node", "3 nodes".
std::string counted(std::size_t number, std::string_view noun);

}  // namespace coppice::cli
