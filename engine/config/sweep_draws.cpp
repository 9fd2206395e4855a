#include <fmt/format.h>
#include <xxhash.h>

#include <cmath>

#include "engine/config/sobol.h"
#include "engine/config/sweep.h"
#include "engine/vocabulary/elementary.h"
#include "engine/vocabulary/random.h"

namespace coppice::config {
namespace {

/// A column that is drawn: from a list of values, or from a range.
struct DrawnColumn {
  std::string name;
  std::vector<Value> values;
  Quantity low, high;
  bool logarithmic = false;
  bool integer = false;

  /// The value at u, uniform in [0, 1).
  Value at(double u) const {
    if (!values.empty()) return values[static_cast<std::size_t>(u * static_cast<double>(values.size()))];
    const double top = integer ? high.value + 1 : high.value;
    const double width = top - low.value;
    double x = std::isfinite(width) ? low.value + u * width : (1 - u) * low.value + u * top;
    if (logarithmic) {
      const double bottom = elementary::log(low.value);
      x = elementary::exp(bottom + u * (elementary::log(top) - bottom));
    }
    if (integer) x = std::floor(x);
    return Value::quantity({std::fmin(std::fmax(x, low.value), high.value), low.dimension});
  }
};

class ColumnReader {
 public:
  ColumnReader(const Element& element, Diagnostics& diagnostics)
      : element_(element), diagnostics_(diagnostics) {}

  std::optional<DrawnColumn> read() {
    const std::size_t before = diagnostics_.size();
    DrawnColumn column;
    if (const std::optional<std::string> name = read_column(element_, diagnostics_)) column.name = *name;
    if (element_.find("values") != nullptr) {
      read_choice(column);
    } else {
      read_range(column);
    }
    const bool good = !failed_ && !column.name.empty() && diagnostics_.size() == before;
    return good ? std::optional(std::move(column)) : std::nullopt;
  }

 private:
  void error(const Attribute* attribute, std::string message, std::string hint = {}) {
    diagnostics_.error(attribute != nullptr ? attribute->value_place : element_.place, std::move(message),
                       std::move(hint));
  }

  void read_choice(DrawnColumn& column) {
    for (const char* other : {"min", "max", "log", "integer"}) {
      if (const Attribute* extra = element_.find(other)) {
        diagnostics_.error(extra->name_place, fmt::format("'{}' has no meaning beside 'values'", other),
                           "a column has either values, or min and max");
      }
    }
    std::optional<std::vector<Value>> values = read_values(*element_.find("values"), diagnostics_);
    failed_ = !values;
    if (values) column.values = std::move(*values);
  }

  void read_range(DrawnColumn& column) {
    const std::optional<Quantity> low = limit("min"), high = limit("max");
    column.logarithmic = flag("log");
    column.integer = flag("integer");
    if (!low || !high) return;
    column.low = *low;
    column.high = *high;
    const Attribute* max = element_.find("max");
    const Attribute* min = element_.find("min");
    if (low->dimension != high->dimension) {
      error(max, fmt::format("'max' is {}, but 'min' is {}", dimension_text(high->dimension),
                             dimension_text(low->dimension)));
    } else if (!(low->value < high->value)) {
      error(max, fmt::format("'max' = {} must be above 'min' = {}", max->value, min->value));
    } else if (column.logarithmic && low->value <= 0) {
      error(min, fmt::format("'min' = {} must be above 0 for log=\"true\"", min->value));
    }
    if (column.integer) {
      whole(*low, min);
      whole(*high, max);
    }
  }

  void whole(const Quantity& quantity, const Attribute* attribute) {
    const bool integer = quantity.dimension == Dimension{} && quantity.value == std::floor(quantity.value);
    if (integer && std::abs(quantity.value) < 0x1p53) return;
    error(attribute, fmt::format("'{}' = {} must be an integer for integer=\"true\"", attribute->name,
                                 attribute->value));
  }

  std::optional<Quantity> limit(const char* name) {
    const Attribute* attribute = element_.find(name);
    if (attribute == nullptr) {
      error(nullptr, fmt::format("the column needs '{}'", name),
            "a column has either values, or min and max");
      return std::nullopt;
    }
    failed_ = failed_ || attribute->failed;
    if (attribute->failed) return std::nullopt;
    const std::optional<Quantity> quantity = parse_quantity(attribute->value);
    if (quantity && std::isfinite(quantity->value)) return quantity;
    error(attribute, fmt::format("'{}' must be a finite number, not '{}'", name, attribute->value));
    return std::nullopt;
  }

  bool flag(const char* name) {
    const Attribute* attribute = element_.find(name);
    if (attribute == nullptr) return false;
    failed_ = failed_ || attribute->failed;
    if (!attribute->failed && attribute->value != "true" && attribute->value != "false") {
      error(attribute, fmt::format("'{}' must be true or false, not '{}'", name, attribute->value));
    }
    return attribute->value == "true";
  }

  const Element& element_;
  Diagnostics& diagnostics_;
  bool failed_ = false;
};

/// The number of points, 0 after a mistake.
std::size_t read_count(const Element& element, Diagnostics& diagnostics) {
  const Attribute* attribute = element.find("n");
  if (attribute == nullptr || attribute->failed) return 0;  // reported
  const Value value = Value::inferred(attribute->value);
  const double* n = value.as_plain_number();
  if (n != nullptr && *n == std::floor(*n) && *n >= 1 && *n <= static_cast<double>(kMostPoints)) {
    return static_cast<std::size_t>(*n);
  }
  diagnostics.error(attribute->value_place,
                    fmt::format("'n' = {} must be an integer from 1 to {}", attribute->value, kMostPoints));
  return 0;
}

std::vector<DrawnColumn> read_columns(const Element& element, Diagnostics& diagnostics) {
  std::vector<DrawnColumn> columns;
  bool good = true;
  for (const Element& child : element.children) {
    if (child.name != "param") continue;
    std::optional<DrawnColumn> column = ColumnReader(child, diagnostics).read();
    good = good && column;
    if (!good) continue;
    for (const DrawnColumn& other : columns) {
      if (other.name != column->name) continue;
      diagnostics.error(child.place, fmt::format("the column '{}' is there already", column->name));
      good = false;
    }
    columns.push_back(std::move(*column));
  }
  if (good && columns.empty()) {
    diagnostics.error(element.place, fmt::format("a <{}> needs at least one <param>", element.name));
  }
  if (!good) columns.clear();
  return columns;
}

}  // namespace

std::optional<SweepRows> draw_rows(const Element& element, std::uint64_t seed, std::string_view label,
                                   std::uint64_t part, Diagnostics& diagnostics) {
  const std::size_t n = read_count(element, diagnostics);
  const std::vector<DrawnColumn> columns = read_columns(element, diagnostics);
  if (n == 0 || columns.empty()) return std::nullopt;
  const bool random = element.name == "random";
  if (!random && columns.size() > kSobolDimensions) {
    diagnostics.error(
        element.place,
        fmt::format("<sobol> has {} columns, but at most {} are possible", columns.size(), kSobolDimensions),
        "<random> has no limit");
    return std::nullopt;
  }
  SweepRows rows;
  rows.drawn = true;
  rows.rows.resize(n);
  const Draws draws = Draws(seed, label, 0).fork("sweep", part);
  for (std::size_t d = 0; d < columns.size(); ++d) {
    const std::string& name = columns[d].name;
    rows.columns.push_back(name);
    // Addressed by the column's name and the point's number: neither more columns nor more points change a
    // value.
    const Draws column = draws.fork("column", XXH3_64bits(name.data(), name.size()));
    for (std::size_t i = 0; i < n; ++i) {
      const double u =
          random ? column.scenario(i).uniform("value", 0, 1) : sobol(static_cast<std::uint32_t>(i), d);
      rows.rows[i].push_back(columns[d].at(u));
    }
  }
  return rows;
}

}  // namespace coppice::config
