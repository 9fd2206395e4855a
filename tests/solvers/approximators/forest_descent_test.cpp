#include "solvers/approximators/forest_descent.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/solvers/approximators/random_trees.h"

namespace coppice::testing {
namespace {

const Draws kDescentDraws(2017, "forest", 0);

TEST(RoundedUp, IsTheLeastFloatThatIsNotBelow) {
  Stream stream = kDescentDraws.stream("rounded");
  std::vector<double> values = {
      0.0,    1.0,           1e-50,  1e-310, 1e-45,
      3.4e38, 3.40282347e38, 3.5e38, 1e300,  std::numeric_limits<double>::infinity(),
      0.1,    16777217};
  for (int i = 0; i < 100000; ++i) values.push_back(stream.normal() * std::exp2(stream.uniform(-160, 130)));
  for (const double magnitude : values) {
    for (const double x : {magnitude, -magnitude}) {
      const float up = rounded_up(x);
      ASSERT_GE(static_cast<double>(up), x);
      const float below = std::nextafter(up, -std::numeric_limits<float>::infinity());
      ASSERT_TRUE(static_cast<double>(below) < x || up == below) << x;
      ASSERT_FALSE(up == 0 && std::signbit(up)) << x;
      ASSERT_TRUE(!is_normal(x) || normal_rounded_up(x) == std::bit_cast<std::uint32_t>(up)) << x;
      // Above what is below it, and not above itself, whatever the sign of a zero.
      const auto key = [](float number) { return ordered(std::bit_cast<std::uint32_t>(number)); };
      ASSERT_LE(key_of(x), key(up)) << x;
      ASSERT_TRUE(key_of(x) <= key(-up) || up != 0) << x;
      ASSERT_TRUE(key_of(x) > key(below) || below == up) << x;
    }
  }
  EXPECT_TRUE(std::isnan(rounded_up(std::numeric_limits<double>::quiet_NaN())));
  EXPECT_EQ(key_of(std::numeric_limits<double>::quiet_NaN()), 0u);
}

TEST(InputKey, IsAboveTheSameThresholdsAsItsInput) {
  constexpr float kInfinite = std::numeric_limits<float>::infinity();
  std::vector<float> numbers = {0, -0.0F, 1e-45F, -1e-45F, 1, -1, 3.4e38F, -3.4e38F, 1e-38F, -1e-38F};
  Stream stream = kDescentDraws.stream("keys");
  for (int i = 0; i < 500; ++i)
    numbers.push_back(static_cast<float>(stream.normal() * std::exp2(stream.uniform(-30, 30))));
  std::vector<float> inputs = numbers;
  inputs.insert(inputs.end(), {kInfinite, -kInfinite, std::numeric_limits<float>::quiet_NaN()});
  for (const float x : inputs) {
    const InputKey key = InputKey::of(x);
    for (const float threshold : numbers) {
      const bool above = (std::bit_cast<std::uint32_t>(threshold) ^ key.flip) < key.key;
      ASSERT_EQ(above, x > threshold) << x << " beside " << threshold;
      ASSERT_FALSE((std::bit_cast<std::uint32_t>(threshold) ^ InputKey::of_leaf().flip) <
                   InputKey::of_leaf().key);
    }
  }
}

// Six levels further down, or in the leaf before.
TEST(TreeTop, LeavesWhereSixStepsLead) {
  for (std::uint64_t trial = 0; trial < 2000; ++trial) {
    Stream stream = kDescentDraws.stream("tops", trial);
    const std::size_t inputs = 1 + stream.below(trial % 3 == 0 ? 40 : 16);
    std::vector<Tree> trees(1 + stream.below(5));
    std::vector<ForestNode> nodes;
    std::vector<TreeTop> tops;
    std::vector<std::uint32_t> roots;
    for (Tree& tree : trees) {
      tree = random_tree(stream, {inputs, LeafModel::constant, 1 + static_cast<int>(stream.below(9))});
      roots.push_back(static_cast<std::uint32_t>(nodes.size()));
      const PackedTree packed = pack(tree);
      nodes.insert(nodes.end(), packed.nodes.begin(), packed.nodes.end());
    }
    for (const std::uint32_t root : roots) tops.push_back(make_top(nodes.data(), root));
    RoundedPoint point;
    for (std::size_t c = 0; c < inputs; ++c) point.set(c, eighth(stream, -2, 2));
    if (trial % 5 == 0) point.set(stream.below(inputs), std::numeric_limits<double>::quiet_NaN());
    if (trial % 7 == 0) point.set(stream.below(inputs), std::numeric_limits<double>::infinity());
    for (const DescendTops descend : usable_top_descents(inputs)) {
      std::vector<std::uint64_t> places(trees.size());
      descend(tops.data(), tops.size(), point.x.data(), places.data());
      for (std::size_t t = 0; t < trees.size(); ++t) {
        std::uint32_t at = roots[t];
        for (int step = 0; step < 6 && nodes[at].ahead() != 0; ++step)
          at += nodes[at].ahead() + (point.x[nodes[at].feature()] > nodes[at].value ? 1 : 0);
        ASSERT_EQ(places[t], at) << "trial " << trial;
      }
    }
  }
}
}  // namespace
}  // namespace coppice::testing
