#include "engine/statistics/student.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace coppice {
namespace {

// From 30-digit arithmetic; the first three digits are those of every printed table.
TEST(StudentTQuantile, AgreesWithTables) {
  struct Row {
    double p, degrees, t;
  };
  const Row rows[] = {
      {0.975, 1, 12.706204736174705},    {0.975, 2, 4.3026527297494639},    {0.975, 4, 2.7764451051977944},
      {0.975, 5, 2.5705818356363155},    {0.975, 9, 2.2621571627982055},    {0.975, 10, 2.2281388519862747},
      {0.975, 19, 2.0930240544083098},   {0.975, 30, 2.0422724563012383},   {0.975, 100, 1.9839715185235523},
      {0.975, 1000, 1.9623390808264085}, {0.975, 9999, 1.9602012636213577}, {0.995, 4, 4.6040948713499932},
      {0.9, 3, 1.6377443536962101},      {0.975, 7.3, 2.3450667365477036},  {0.999, 2.5, 13.822193110865965}};
  for (const Row& row : rows) {
    EXPECT_NEAR(student_t_quantile(row.p, row.degrees) / row.t, 1, 1e-12) << row.p << " " << row.degrees;
  }
}

TEST(StudentTQuantile, AgreesWithTheClosedFormsForOneAndTwoDegrees) {
  for (double p = 0.501; p < 1; p += 0.017) {
    EXPECT_NEAR(student_t_quantile(p, 1) / std::tan(std::numbers::pi * (p - 0.5)), 1, 1e-12) << p;
    EXPECT_NEAR(student_t_quantile(p, 2) / ((2 * p - 1) / std::sqrt(2 * p * (1 - p))), 1, 1e-12) << p;
  }
}

TEST(StudentTQuantile, IsSymmetricAndGrowsWithP) {
  EXPECT_EQ(student_t_quantile(0.5, 7), 0);
  double last = -1e300;
  for (double p = 0.01; p < 1; p += 0.01) {
    const double t = student_t_quantile(p, 3.5);
    EXPECT_GT(t, last);
    EXPECT_NEAR(student_t_quantile(1 - p, 3.5), -t, 1e-12 * std::fabs(t) + 1e-14);
    last = t;
  }
}

TEST(StudentTQuantile, RefusesWhatIsOutOfRange) {
  EXPECT_THROW(student_t_quantile(0, 3), std::logic_error);
  EXPECT_THROW(student_t_quantile(1, 3), std::logic_error);
  EXPECT_THROW(student_t_quantile(0.9, 0.5), std::logic_error);
}

TEST(StudentTTwoSided, IsTheInverseOfTheQuantile) {
  for (const double degrees : {1.0, 2.5, 9.0, 17.776, 1000.0}) {
    for (const double p : {0.6, 0.9, 0.975, 0.9999}) {
      EXPECT_NEAR(student_t_two_sided(-student_t_quantile(p, degrees), degrees) / (2 * (1 - p)), 1, 1e-9);
    }
  }
  EXPECT_EQ(student_t_two_sided(0, 3), 1);
  EXPECT_EQ(student_t_two_sided(INFINITY, 3), 0);
  EXPECT_TRUE(std::isnan(student_t_two_sided(NAN, 3)));
}

}  // namespace
}  // namespace coppice
