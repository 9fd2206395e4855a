#include "registry/units.h"

#include <gtest/gtest.h>

#include <clocale>
#include <cmath>
#include <limits>
#include <numbers>

namespace coppice {
namespace {

constexpr double kPi = std::numbers::pi;

struct Given {
  const char* text;
  double value;
  const char* unit;  ///< of the SI value
};

class Quantities : public testing::TestWithParam<Given> {};

TEST_P(Quantities, AreTheNearestDoubleInSi) {
  const std::optional<Quantity> quantity = parse_quantity(GetParam().text);
  ASSERT_TRUE(quantity.has_value());
  EXPECT_EQ(quantity->value, GetParam().value);
  EXPECT_EQ(unit_text(quantity->dimension), GetParam().unit);
}

INSTANTIATE_TEST_SUITE_P(Plain, Quantities,
                         testing::Values(Given{"1e-3", 1e-3, ""}, Given{" 5 ", 5, ""}, Given{"+5", 5, ""},
                                         Given{"-.5", -0.5, ""}, Given{"5.", 5, ""}, Given{"50 %", 0.5, ""},
                                         Given{"7%", 0.07, ""},
                                         Given{"inf", std::numeric_limits<double>::infinity(), ""},
                                         Given{"-inf", -std::numeric_limits<double>::infinity(), ""}));

// Decimal multiples must not carry a rounding error: 7 * 0.01 is not the double nearest to 0.07.
INSTANTIATE_TEST_SUITE_P(DecimalMultiples, Quantities,
                         testing::Values(Given{"7 cm", 0.07, "m"}, Given{"0.07 km", 70, "m"},
                                         Given{"3mm", 0.003, "m"}, Given{"1.1e2 um", 1.1e-4, "m"},
                                         Given{"29 g", 0.029, "kg"}, Given{"2 t", 2000, "kg"},
                                         Given{"35 ms", 0.035, "s"}, Given{"9 ns", 9e-9, "s"},
                                         Given{"200 Hz", 200, "1/s"}, Given{"0.3 kHz", 300, "1/s"},
                                         Given{"3 kN", 3000, "kg*m/s^2"}, Given{"70 MB", 7e7, "byte"},
                                         Given{"-57 cm/s", -0.57, "m/s"},
                                         Given{"1.15 cm^2", 1.15e-4, "m^2"}));

INSTANTIATE_TEST_SUITE_P(OtherMultiples, Quantities,
                         testing::Values(Given{"3 h", 10800, "s"}, Given{"1.5 min", 90, "s"},
                                         Given{"2 d", 172800, "s"}, Given{"180 deg", kPi, "rad"},
                                         Given{"90 deg", kPi / 2, "rad"}, Given{"1 turn", 2 * kPi, "rad"},
                                         Given{"36 km/h", 10, "m/s"}, Given{"2 KiB", 2048, "byte"},
                                         Given{"1 GiB", 1073741824, "byte"}));

INSTANTIATE_TEST_SUITE_P(Products, Quantities,
                         testing::Values(Given{"9.81 m/s^2", 9.81, "m/s^2"}, Given{"2 kg*m^2", 2, "kg*m^2"},
                                         Given{"2 N*m", 2, "kg*m^2/s^2"},
                                         Given{"3 kg * m ^ 2 / s ^ 2", 3, "kg*m^2/s^2"},
                                         Given{"360 deg/s", 2 * kPi, "rad/s"}, Given{"4 1/s", 4, "1/s"},
                                         Given{"4 s^-1", 4, "1/s"}, Given{"8 m/s/s", 8, "m/s^2"},
                                         Given{"5 m/m", 5, ""}, Given{"1 W", 1, "kg*m^2/s^3"},
                                         Given{"1 V", 1, "kg*m^2/A/s^3"}));

TEST(Units, KnowTurningSpeeds) {
  EXPECT_DOUBLE_EQ(parse_quantity("60 rpm")->value, 2 * kPi);
  EXPECT_EQ(parse_quantity("60 rpm")->dimension, parse_unit("rad/s")->dimension);
}

TEST(Units, RefuseWhatIsNoQuantity) {
  for (const char* text : {"",      " ",    "m",     "nan",      "NaN",    "-nan",      "nan(1)", "0x10",
                           "1,5",   "1 2",  "5 1",   "--5",      "+-5",    "1e",        "1e999",  "1 sec",
                           "1 M",   "1 m^", "1 m^x", "1 m^99",   "1 m//s", "1 *m",      "1 m*",   "1 /s",
                           "1 m s", "one",  "1 m/",  "1e308 km", "$5",     "5 deg deg", "1_000"}) {
    EXPECT_FALSE(parse_quantity(text).has_value()) << text;
  }
}

TEST(Units, ParseUnitTexts) {
  EXPECT_EQ(parse_unit("")->value, 1);
  EXPECT_EQ(parse_unit("1")->value, 1);
  EXPECT_EQ(parse_unit("cm")->value, 0.01);
  EXPECT_EQ(parse_unit("deg")->value, kPi / 180);
  EXPECT_FALSE(parse_unit("metre").has_value());
  EXPECT_FALSE(parse_unit("m^").has_value());
}

TEST(Units, AnAngleIsNotAPlainNumber) {
  EXPECT_NE(parse_unit("rad")->dimension, parse_unit("")->dimension);
  EXPECT_NE(parse_unit("rad/s")->dimension, parse_unit("Hz")->dimension);
}

TEST(Units, UnitTextsReadBackToTheirDimension) {
  for (const NamedUnit& unit : named_units()) {
    const std::optional<Quantity> again = parse_unit(unit_text(unit.value.dimension));
    ASSERT_TRUE(again.has_value()) << unit.name;
    EXPECT_EQ(again->dimension, unit.value.dimension) << unit.name;
    EXPECT_EQ(again->value, 1) << unit.name;
  }
}

TEST(Units, SayWhatADimensionIs) {
  EXPECT_EQ(dimension_text(parse_unit("deg")->dimension), "an angle (rad)");
  EXPECT_EQ(dimension_text(parse_unit("km/h")->dimension), "a speed (m/s)");
  EXPECT_EQ(dimension_text({}), "a plain number");
  EXPECT_EQ(dimension_text(parse_unit("m^5/s")->dimension), "a quantity in m^5/s");
}

TEST(Units, NumberTextIsShortestAndReadsBackEqual) {
  EXPECT_EQ(number_text(0.1), "0.1");
  EXPECT_EQ(number_text(100000), "100000");
  EXPECT_EQ(number_text(1e-7), "1e-07");
  EXPECT_EQ(number_text(-0.0), "-0");
  EXPECT_EQ(number_text(std::numeric_limits<double>::infinity()), "inf");
  for (const double value :
       {0.1 + 0.2, 1.0 / 3, 5e-324, 1.7976931348623157e308, -kPi, 1e22, 123456789012345678.0}) {
    EXPECT_EQ(parse_quantity(number_text(value))->value, value);
  }
}

TEST(Units, DoNotDependOnTheLocale) {
  const std::string before = std::setlocale(LC_ALL, nullptr);
  for (const char* locale : {"de_DE.UTF-8", "fr_FR.UTF-8", "C.UTF-8"}) {  // where the machine has them
    if (std::setlocale(LC_ALL, locale) == nullptr) continue;
    EXPECT_EQ(number_text(1234.5), "1234.5");
    EXPECT_EQ(parse_quantity("0.5 m")->value, 0.5);
  }
  std::setlocale(LC_ALL, before.c_str());
}

}  // namespace
}  // namespace coppice
