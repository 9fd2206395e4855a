#include "engine/statistics/cautions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace coppice {
namespace {

using ::testing::HasSubstr;

TEST(Caution, NamesSmallSamples) {
  EXPECT_THAT(caution(1, NAN, "training runs"), HasSubstr("no interval"));
  EXPECT_THAT(caution(3, 0, "training runs"), HasSubstr("only 3 training runs"));
  EXPECT_EQ(caution(10, 0.3, "training runs"), "");
}

TEST(Caution, NamesSkewedOnes) {
  EXPECT_THAT(caution(20, -1.4, "episodes"), HasSubstr("skewness -1.4"));
  EXPECT_EQ(caution(50, 2.5, "episodes"), "") << "the interval follows this much";
  EXPECT_THAT(caution(10000, 60, "episodes"), HasSubstr("decide the mean")) << "three of 10000";
  EXPECT_EQ(caution(10000, 40, "episodes"), "");
}

}  // namespace
}  // namespace coppice
