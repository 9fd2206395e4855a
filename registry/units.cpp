#include "registry/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

#include "registry/text.h"

namespace coppice {
namespace {

enum Base { kMetre, kKilogram, kSecond, kAmpere, kRadian, kByte };

/// A unit: number * 10^decimal / divisor in SI. The power of ten is kept apart so that it can be applied to
/// the decimal text of a number: "7 cm" is the double nearest to 0.07, which 7 * 0.01 is not.
struct Unit {
  std::string_view name;
  int decimal = 0;
  double number = 1;
  double divisor = 1;
  Dimension dimension{};
};

constexpr double kPi = std::numbers::pi;
constexpr Dimension kPlain{};
constexpr Dimension kLength{1};
constexpr Dimension kMass{0, 1};
constexpr Dimension kTime{0, 0, 1};
constexpr Dimension kFrequency{0, 0, -1};
constexpr Dimension kCurrent{0, 0, 0, 1};
constexpr Dimension kAngle{0, 0, 0, 0, 1};
constexpr Dimension kTurning{0, 0, -1, 0, 1};
constexpr Dimension kData{0, 0, 0, 0, 0, 1};
constexpr Dimension kForce{1, 1, -2};
constexpr Dimension kEnergy{2, 1, -2};
constexpr Dimension kPower{2, 1, -3};
constexpr Dimension kVoltage{2, 1, -3, -1};
constexpr Dimension kPressure{-1, 1, -2};

constexpr auto kUnits = std::to_array<Unit>({
    {"1", 0, 1, 1, kPlain},
    {"%", -2, 1, 1, kPlain},
    {"m", 0, 1, 1, kLength},
    {"nm", -9, 1, 1, kLength},
    {"um", -6, 1, 1, kLength},
    {"mm", -3, 1, 1, kLength},
    {"cm", -2, 1, 1, kLength},
    {"km", 3, 1, 1, kLength},
    {"kg", 0, 1, 1, kMass},
    {"mg", -6, 1, 1, kMass},
    {"g", -3, 1, 1, kMass},
    {"t", 3, 1, 1, kMass},
    {"s", 0, 1, 1, kTime},
    {"ns", -9, 1, 1, kTime},
    {"us", -6, 1, 1, kTime},
    {"ms", -3, 1, 1, kTime},
    {"min", 0, 60, 1, kTime},
    {"h", 0, 3600, 1, kTime},
    {"d", 0, 86400, 1, kTime},
    {"Hz", 0, 1, 1, kFrequency},
    {"kHz", 3, 1, 1, kFrequency},
    {"MHz", 6, 1, 1, kFrequency},
    {"A", 0, 1, 1, kCurrent},
    {"mA", -3, 1, 1, kCurrent},
    {"rad", 0, 1, 1, kAngle},
    {"mrad", -3, 1, 1, kAngle},
    {"deg", 0, kPi, 180, kAngle},
    {"turn", 0, 2 * kPi, 1, kAngle},
    {"rpm", 0, 2 * kPi, 60, kTurning},
    {"N", 0, 1, 1, kForce},
    {"mN", -3, 1, 1, kForce},
    {"kN", 3, 1, 1, kForce},
    {"J", 0, 1, 1, kEnergy},
    {"kJ", 3, 1, 1, kEnergy},
    {"W", 0, 1, 1, kPower},
    {"kW", 3, 1, 1, kPower},
    {"V", 0, 1, 1, kVoltage},
    {"mV", -3, 1, 1, kVoltage},
    {"Pa", 0, 1, 1, kPressure},
    {"kPa", 3, 1, 1, kPressure},
    {"byte", 0, 1, 1, kData},
    {"kB", 3, 1, 1, kData},
    {"MB", 6, 1, 1, kData},
    {"GB", 9, 1, 1, kData},
    {"TB", 12, 1, 1, kData},
    {"KiB", 0, 1024.0, 1, kData},
    {"MiB", 0, 1024.0 * 1024, 1, kData},
    {"GiB", 0, 1024.0 * 1024 * 1024, 1, kData},
    {"TiB", 0, 1024.0 * 1024 * 1024 * 1024, 1, kData},
});

/// What a dimension is called in messages, and the unit that is shown for it.
struct Kind {
  Dimension dimension;
  std::string_view name, unit;
};
constexpr auto kKinds = std::to_array<Kind>({
    {kPlain, "a plain number", ""},
    {kLength, "a length", "m"},
    {{2}, "an area", "m^2"},
    {{3}, "a volume", "m^3"},
    {kMass, "a mass", "kg"},
    {kTime, "a time", "s"},
    {kFrequency, "a frequency", "1/s"},
    {kCurrent, "a current", "A"},
    {kAngle, "an angle", "rad"},
    {kData, "an amount of data", "byte"},
    {{1, 0, -1}, "a speed", "m/s"},
    {{1, 0, -2}, "an acceleration", "m/s^2"},
    {kTurning, "an angular speed", "rad/s"},
    {{0, 0, -2, 0, 1}, "an angular acceleration", "rad/s^2"},
    {{2, 1}, "a moment of inertia", "kg*m^2"},
    {kForce, "a force", "N"},
    {kEnergy, "an energy or a torque", "N*m"},
    {kPower, "a power", "W"},
    {kVoltage, "a voltage", "V"},
    {kPressure, "a pressure", "Pa"},
});

constexpr int kLargestPower = 9;  // nothing real needs more, and factors stay finite

/// Multiplies `product` by unit^power.
void multiply(Unit& product, const Unit& unit, int power) {
  product.decimal += power * unit.decimal;
  for (int i = 0; i < std::abs(power); ++i) {
    product.number *= power > 0 ? unit.number : unit.divisor;
    product.divisor *= power > 0 ? unit.divisor : unit.number;
  }
  for (std::size_t i = 0; i < product.dimension.size(); ++i)
    product.dimension[i] += power * unit.dimension[i];
}

/// "kg*m^2/s^2": factors with integer powers, applied from the left ("a/b/c" divides by both).
std::optional<Unit> parse_product(std::string_view text) {
  Unit product;
  int sign = 1;
  for (std::size_t begin = 0;;) {
    const std::size_t end = text.find_first_of("*/", begin);
    std::string_view factor = trim(text.substr(begin, end - begin));
    int power = 1;
    if (const std::size_t caret = factor.find('^'); caret != std::string_view::npos) {
      const std::string_view digits = trim(factor.substr(caret + 1));
      const char* last = digits.data() + digits.size();
      const auto [stop, failure] = std::from_chars(digits.data(), last, power);
      if (failure != std::errc{} || stop != last || std::abs(power) > kLargestPower) return std::nullopt;
      factor = trim(factor.substr(0, caret));
    }
    const auto unit =
        std::find_if(kUnits.begin(), kUnits.end(), [&](const Unit& u) { return u.name == factor; });
    if (unit == kUnits.end()) return std::nullopt;
    multiply(product, *unit, sign * power);
    if (end == std::string_view::npos) break;
    sign = text[end] == '*' ? 1 : -1;
    begin = end + 1;
  }
  const bool sane = std::all_of(product.dimension.begin(), product.dimension.end(),
                                [](int exponent) { return std::abs(exponent) <= kLargestPower; });
  return sane ? std::optional(product) : std::nullopt;
}

/// The decimal text times 10^decimal as the nearest double, and where the number ends.
std::optional<double> parse_decimal(std::string_view text, int decimal, std::size_t* length) {
  double value = 0;
  const auto [stop, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failure != std::errc{} || std::isnan(value)) return std::nullopt;
  *length = static_cast<std::size_t>(stop - text.data());
  if (decimal == 0 || value == 0 || std::isinf(value)) return value;
  const std::string_view digits = text.substr(0, *length);
  const std::size_t mark = digits.find_first_of("eE");
  int exponent = 0;
  if (mark != std::string_view::npos) {
    std::string_view power = digits.substr(mark + 1);
    if (power.starts_with('+')) power.remove_prefix(1);
    std::from_chars(power.data(), power.data() + power.size(), exponent);
  }
  const std::string shifted = fmt::format("{}e{}", digits.substr(0, mark), exponent + decimal);
  const auto result = std::from_chars(shifted.data(), shifted.data() + shifted.size(), value);
  return result.ec == std::errc{} ? std::optional(value) : std::nullopt;
}

const Kind* find_kind(const Dimension& dimension) {
  const auto kind =
      std::find_if(kKinds.begin(), kKinds.end(), [&](const Kind& k) { return k.dimension == dimension; });
  return kind == kKinds.end() ? nullptr : &*kind;
}

}  // namespace

std::optional<Quantity> parse_unit(std::string_view unit) {
  const std::optional<Unit> product = trim(unit).empty() ? Unit{} : parse_product(unit);
  if (!product) return std::nullopt;
  std::size_t length = 0;
  const std::optional<double> power = parse_decimal("1", product->decimal, &length);
  if (!power) return std::nullopt;
  return Quantity{*power * product->number / product->divisor, product->dimension};
}

std::optional<Quantity> parse_quantity(std::string_view text) {
  text = trim(text);
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  std::size_t length = 0;
  if (!parse_decimal(text, 0, &length)) return std::nullopt;
  const std::string_view unit_part = trim(text.substr(length));
  if (unit_part.starts_with('1') && !unit_part.starts_with("1/")) return std::nullopt;  // "5 1" is not 5
  const std::optional<Unit> unit = unit_part.empty() ? Unit{} : parse_product(unit_part);
  if (!unit) return std::nullopt;
  const std::optional<double> value = parse_decimal(text, unit->decimal, &length);
  if (!value) return std::nullopt;
  const Quantity quantity{*value * unit->number / unit->divisor, unit->dimension};
  if (std::isinf(quantity.value) && !std::isinf(*value)) return std::nullopt;
  return quantity;
}

std::vector<NamedUnit> named_units() {
  std::vector<NamedUnit> units;
  for (const Unit& unit : kUnits) {
    if (unit.name != "1") units.push_back({unit.name, *parse_unit(unit.name)});
  }
  return units;
}

std::string unit_text(const Dimension& dimension) {
  static constexpr std::array<std::string_view, 6> kNames = {"m", "kg", "s", "A", "rad", "byte"};
  static constexpr std::array<Base, 6> kOrder = {kKilogram, kMetre, kRadian, kByte, kAmpere, kSecond};
  std::string above, below;
  for (const Base base : kOrder) {
    const int exponent = dimension[base];
    if (exponent == 0) continue;
    std::string factor(kNames[base]);
    if (std::abs(exponent) != 1) factor += fmt::format("^{}", std::abs(exponent));
    if (exponent > 0) above += (above.empty() ? "" : "*") + factor;
    if (exponent < 0) below += "/" + factor;
  }
  return above.empty() && !below.empty() ? "1" + below : above + below;
}

std::string dimension_text(const Dimension& dimension) {
  const Kind* kind = find_kind(dimension);
  if (kind == nullptr) return fmt::format("a quantity in {}", unit_text(dimension));
  return kind->unit.empty() ? std::string(kind->name) : fmt::format("{} ({})", kind->name, kind->unit);
}

std::string number_text(double value) {
  return fmt::format("{}", value);
}

}  // namespace coppice
