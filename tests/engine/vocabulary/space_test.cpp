#include "engine/vocabulary/space.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace coppice {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

const std::vector<ActionBox> kActions = {
    {"walk", {{"speed", "m/s", -1, 2}, {"turn", "rad", -std::numbers::pi, std::numbers::pi, true}}},
    {"kick", {}}};

Action walk(double speed, double turn) {
  return {0, {speed, turn}};
}

TEST(Vec, HasTheSizeOfItsValuesAndItsCapacityWithoutThem) {
  EXPECT_EQ(Vec<3>().size(), 3u);
  const Vec<3> two = {1.0, 2.0};
  EXPECT_EQ(two.size(), 2u);
  EXPECT_EQ(std::span<const double>(two).size(), 2u);
}

TEST(Vec, NewComponentsAreZeroAlsoAfterShrinking) {
  Vec<3> v = {1.0, 2.0, 3.0};
  v.resize(1);
  v.resize(3);
  EXPECT_EQ(v, (Vec<3>{1.0, 0.0, 0.0}));
}

TEST(Vec, VectorsOfDifferentSizesDiffer) {
  EXPECT_FALSE((Vec<3>{1.0, 2.0}) == (Vec<3>{1.0, 2.0, 0.0}));
}

TEST(Clamp, KeepsWhatIsInTheBox) {
  EXPECT_EQ(clamp(walk(0.3, -1), kActions), walk(0.3, -1));
}

TEST(Clamp, MovesToTheNearestLimit) {
  EXPECT_EQ(clamp(walk(5, 0), kActions).values[0], 2);
  EXPECT_EQ(clamp(walk(-kInfinity, 0), kActions).values[0], -1);
}

TEST(Clamp, WrapsCircularAxes) {
  EXPECT_NEAR(clamp(walk(0, 4), kActions).values[1], 4 - 2 * std::numbers::pi, 1e-15);
  EXPECT_NEAR(clamp(walk(0, -10), kActions).values[1], 4 * std::numbers::pi - 10, 1e-14);
}

TEST(Clamp, MakesANaNTheCentre) {
  EXPECT_EQ(clamp(walk(std::nan(""), 0), kActions).values[0], 0.5);
  const std::vector<ActionBox> half_open = {{"push", {{"force", "N", 1, kInfinity}}}};
  EXPECT_EQ(clamp({0, {std::nan("")}}, half_open).values[0], 1);
}

TEST(Clamp, RefusesActionsThatAreNone) {
  Action action;  // without parameters
  for (int id : {-1, 0, 2}) {
    action.id = id;
    EXPECT_THROW(clamp(action, kActions), std::invalid_argument) << id;
  }
  action.id = 1;
  EXPECT_NO_THROW(clamp(action, kActions));
}

TEST(Spaces, WidestActionHasTheMostAxes) {
  EXPECT_EQ((Spaces{{{"x", "", 0, 1}}, kActions}.widest_action()), 2u);
}

TEST(Spaces, CheckNamesWhatIsWrong) {
  const Space line = {{"x", "m", 0, 1}};
  const auto message = [](const Spaces& spaces) -> std::string {
    try {
      spaces.check();
    } catch (const std::invalid_argument& wrong) {
      return wrong.what();
    }
    return "";
  };
  EXPECT_EQ(message({line, kActions}), "");
  EXPECT_NE(message({line, {}}).find("no action"), std::string::npos);
  EXPECT_NE(message({{}, kActions}).find("no axis"), std::string::npos);
  EXPECT_NE(message({{{"", "m", 0, 1}}, kActions}).find("no name"), std::string::npos);
  EXPECT_NE(message({{{"x", "m", 0, 1}, {"x", "m", 0, 1}}, kActions}).find("two axes called 'x'"),
            std::string::npos);
  EXPECT_NE(message({{{"x", "m", 2, 1}}, kActions}).find("from 2 to 1"), std::string::npos);
  EXPECT_NE(message({{{"x", "m", std::nan(""), 1}}, kActions}).find("nan"), std::string::npos);
  EXPECT_NE(message({Space(kMaxStateSize + 1, line[0]), kActions}).find("33 axes"), std::string::npos);
}

}  // namespace
}  // namespace coppice
