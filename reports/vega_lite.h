#pragma once

#include <string>
#include <vector>

#include "engine/data/table_file.h"

namespace coppice {

enum class FigureKind { line, histogram, interval, profile };

struct FigureLayout {
  FigureKind kind = FigureKind::line;
  std::string x, y;             ///< column of a line's x; name of what is shown
  std::vector<std::string> by;  ///< columns that tell apart: by colour, then dashes, then in rows
};

/// A Vega-Lite v5 specification with the data inside, as text.
std::string vega_lite(const Table& table, const FigureLayout& layout);

}  // namespace coppice
