#include "engine/vocabulary/dataset.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace coppice {
namespace {

const Spaces kSpaces = {{{"x", "m", -1, 1}}, {{"push", {{"force", "N", -1, 1}}}, {"wait", {}}}};

/// Rows with the given episodes; every other number tells the row and the part.
Dataset part(double mark, const std::vector<std::int64_t>& episodes) {
  Dataset dataset(kSpaces, episodes.size());
  dataset.episode = episodes;
  for (std::size_t i = 0; i < episodes.size(); ++i) {
    const double value = mark + static_cast<double>(i);
    dataset.states(i, 0) = value;
    dataset.next(i, 0) = value + 0.25;
    dataset.reward[i] = -value;
    dataset.set_action(i, {0, {value / 10}});
  }
  return dataset;
}

TEST(Dataset, KeepsActionsOfDifferentWidths) {
  Dataset dataset(kSpaces, 2);
  Action wait;
  wait.id = 1;
  dataset.set_action(0, {0, {0.5}});
  dataset.set_action(1, wait);
  EXPECT_EQ(dataset.action(0), (Action{0, {0.5}}));
  EXPECT_EQ(dataset.action(1), wait);
  EXPECT_TRUE(std::isnan(dataset.actions(1, 0)));
}

TEST(Dataset, CheckFindsColumnsOfDifferentLengths) {
  Dataset dataset = part(0, {0, 0});
  EXPECT_NO_THROW(dataset.check());
  dataset.terminal.pop_back();
  EXPECT_THROW(dataset.check(), std::logic_error);
}

TEST(Join, KeepsRowsAndGivesEveryPartsEpisodesNumbersOfTheirOwn) {
  const Dataset all = join({part(10, {0, 0, 2}), part(20, {}), part(30, {0, 1})});
  EXPECT_EQ(all.episode, (std::vector<std::int64_t>{0, 0, 2, 3, 4}));
  EXPECT_EQ(all.reward, (std::vector<double>{-10, -11, -12, -30, -31}));
  EXPECT_EQ(all.states(3, 0), 30);
  EXPECT_EQ(all.next(4, 0), 31.25);
  EXPECT_EQ(all.action(4).values[0], 3.1);
  EXPECT_NO_THROW(all.check());
}

TEST(Join, RefusesPartsOfDifferentSpaces) {
  Dataset other = part(0, {0});
  other.spaces.states[0].high = 2;
  EXPECT_THROW(join({part(0, {0}), other}), std::invalid_argument);
}

TEST(Join, OfNothingIsEmpty) {
  EXPECT_EQ(join({}).rows(), 0u);
}

}  // namespace
}  // namespace coppice
