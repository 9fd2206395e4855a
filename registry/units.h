#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace coppice {

/// Exponents of m, kg, s, A, rad, byte. An angle is a dimension of its own: degrees never pass for a plain
/// number.
using Dimension = std::array<int, 6>;

/// A number in SI units (radians, bytes) with its dimension.
struct Quantity {
  double value = 0;
  Dimension dimension{};
};

/// A unit text such as "m", "deg", "cm/s", "kg*m^2", "Hz", "h": its SI factor and dimension; "" and "1" are
/// plain.
std::optional<Quantity> parse_unit(std::string_view unit);

/// "20 deg", "3 h", "2 cm", "1e-3", "inf": a number, optionally followed by a unit. Nothing for anything
/// else. "nan" is not a number here.
std::optional<Quantity> parse_quantity(std::string_view text);

/// The SI unit text of a dimension ("m/s^2"; "" for plain numbers).
std::string unit_text(const Dimension& dimension);

/// What a dimension is, for messages: "an angle (rad)", "a plain number", "a quantity in m^5/s".
std::string dimension_text(const Dimension& dimension);

/// A unit that has a name of its own, with its value in SI.
struct NamedUnit {
  std::string_view name;
  Quantity value;
};
/// All of them, for the schema and the manual; products, quotients and powers of them are units too.
std::vector<NamedUnit> named_units();

/// The shortest text that reads back to the same double, independent of the locale.
std::string number_text(double value);

}  // namespace coppice
