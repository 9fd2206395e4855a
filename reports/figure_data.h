#pragma once

#include <string>
#include <vector>

#include "engine/data/table_file.h"
#include "engine/graph/node.h"
#include "engine/statistics/estimates.h"

namespace coppice {

/// One learning run, or dataset, as a curve: increasing x, finite y.
struct Curve {
  std::vector<double> x, y;
};

/// The rows of a dataset.
Curve read_points(const InputNode& node, const std::string& x, const std::string& y);

/// A learning node's measure by another of its columns, or by "cpu_s" or "wall_s": the node's time, shared
/// out among its units of work as if each had taken equally long; or a dataset's rows in the order of x.
/// Throws std::invalid_argument for a column
/// that the progress has not.
Curve read_curve(const InputNode& node, const std::string& x, const std::string& y);

bool is_time(const std::string& x);

/// A mean curve: at each x over the curves that have begun, each with its last value so far.
struct CurvePoint {
  double x = 0;
  Estimate estimate;
};
/// At all their x, or (`points` > 0) at so many evenly spaced ones, from where all have begun to the last.
std::vector<CurvePoint> mean_curve(const std::vector<Curve>& curves, std::size_t points);

/// The ends of equally wide bins for all values: `bins` from the least to the largest when positive, else by
/// the Freedman-Diaconis rule, hardly more than 100; whole numbers then have bins of a whole width with ends
/// between them.
std::vector<double> bin_ends(const std::vector<double>& values, std::size_t bins);

}  // namespace coppice
