#pragma once

#include <string>
#include <vector>

#include "engine/data/table_file.h"

namespace coppice {

enum class FigureKind { line, histogram, interval, profile };

struct FigureLayout {
  FigureKind kind = FigureKind::line;
  std::string x, y;  ///< column of a line's x; name of what is shown
  std::vector<std::string>
      by;               ///< columns that tell apart: first in one figure, then in rows and columns of them
  bool points = false;  ///< a mark at each point of a line: there are few, perhaps only one
  bool observations = false;  ///< rows whose column `drawn` is "point" are no part of lines
};

/// A Vega-Lite v5 specification with the data inside, as text.
std::string vega_lite(const Table& table, const FigureLayout& layout);

}  // namespace coppice
