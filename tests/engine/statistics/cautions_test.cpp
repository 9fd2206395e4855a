#include "engine/statistics/cautions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace coppice {
namespace {

using ::testing::HasSubstr;

TEST(Caution, NamesSmallSamples) {
  EXPECT_THAT(caution(1, NAN, "training runs"), HasSubstr("no interval"));
  EXPECT_THAT(caution(3, 0, "training runs"), HasSubstr("only 3 training runs"));
  EXPECT_THAT(caution(10, 0, "training runs"), HasSubstr("10 training runs cannot rule out skewed values"));
}

TEST(Caution, AsksSmallSamplesToShowThatTheyAreNotSkewed) {
  for (const double sign : {1.0, -1.0}) {
    EXPECT_EQ(caution(20, sign * 0.24, "episodes"), "");
    EXPECT_THAT(caution(20, sign * 0.26, "episodes"), HasSubstr("cannot rule out")) << "(20 - 10) / 40";
    EXPECT_EQ(caution(40, sign * 0.74, "episodes"), "");
    EXPECT_THAT(caution(40, sign * 0.76, "episodes"), HasSubstr("cannot rule out"));
    EXPECT_EQ(caution(50, sign * 1.01, "episodes"), "");
  }
}

TEST(Caution, NamesSkewedOnes) {
  EXPECT_THAT(caution(20, -1.4, "episodes"), HasSubstr("skewed (skewness -1.4)"));
  EXPECT_EQ(caution(50, 2.5, "episodes"), "") << "the interval follows this much";
  EXPECT_THAT(caution(10000, 60, "episodes"), HasSubstr("decide the mean")) << "three of 10000";
  EXPECT_EQ(caution(10000, 40, "episodes"), "");
}

TEST(Caution, IsDueOfEqualAndOfHugeValues) {
  const std::vector<double> equal(60, 3.0);
  EXPECT_THAT(caution(moments(equal), "episodes"), HasSubstr("all 60 episodes are equal"));
  std::vector<double> varied = equal;
  for (std::size_t i = 0; i < varied.size(); i += 2) varied[i] = 4;
  EXPECT_EQ(caution(moments(varied), "episodes"), "");
  for (double& value : varied) value *= 1e160;
  EXPECT_THAT(caution(moments(varied), "episodes"), HasSubstr("too large for an interval"));
  varied[0] = std::numeric_limits<double>::infinity();
  EXPECT_THAT(caution(moments(varied), "episodes"), HasSubstr("no finite mean"));
}

}  // namespace
}  // namespace coppice
