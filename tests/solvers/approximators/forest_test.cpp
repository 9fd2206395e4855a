#include "solvers/approximators/forest.h"

#include <gtest/gtest.h>

#include <bit>
#include <functional>
#include <limits>
#include <stdexcept>

#include "solvers/approximators/forest_descent.h"
#include "tests/solvers/approximators/random_trees.h"

namespace coppice::testing {
namespace {

const Draws kForestDraws(2017, "forest", 0);

struct Grown {
  std::vector<Tree> trees;  // output after output
  Forest forest;
};

Grown random_forest(Stream& stream, std::size_t inputs, std::size_t outputs, LeafModel leaf) {
  Grown grown;
  grown.forest = Forest(inputs, std::vector<OutputScale>(outputs), leaf);
  grown.trees.resize(outputs * (1 + stream.below(60)));
  for (Tree& tree : grown.trees) {
    tree = random_tree(stream, {inputs, leaf, 5});
    grown.forest.add(pack(tree));
  }
  return grown;
}

std::vector<double> outputs_of(const Forest& forest, const std::vector<double>& x) {
  std::vector<double> y(forest.outputs());
  forest.predict(x, y);
  return y;
}

TEST(Forest, IsNotSavedWithNumbersThatCannotBeRead) {
  Archive archive;
  Forest forest(1, {OutputScale{0, std::numeric_limits<double>::infinity()}}, LeafModel::constant);
  forest.add({{ForestNode::leaf(1, 1)}, {}});
  EXPECT_THROW(forest.save(archive), std::runtime_error);
}

// A linear forest holds the mean of its models in the mean of their ranges.
TEST(Forest, IsTheMeanOfItsTrees) {
  for (std::uint64_t trial = 0; trial < 1000; ++trial) {
    Stream stream = kForestDraws.stream("mean", trial);
    const std::size_t inputs = 1 + stream.below(5), outputs = 1 + stream.below(3);
    const LeafModel leaf = trial % 2 == 0 ? LeafModel::constant : LeafModel::linear;
    const auto [trees, forest] = random_forest(stream, inputs, outputs, leaf);
    const std::size_t each = trees.size() / outputs;
    ASSERT_EQ(forest.trees(), each);
    for (int i = 0; i < 10; ++i) {
      std::vector<double> x;
      for (std::size_t c = 0; c < inputs; ++c) x.push_back(eighth(stream, -2, 2));
      const std::vector<double> y = outputs_of(forest, x);
      for (std::size_t o = 0; o < outputs; ++o) {
        Prediction sum;
        for (std::size_t t = 0; t < each; ++t) {
          const Prediction p = predict(trees[o * each + t], x);
          ASSERT_EQ(predict(unpacked(forest.tree(o, t)), x), p);
          sum = {sum.model + p.model, sum.low + p.low, sum.high + p.high};
        }
        ASSERT_EQ(y[o], sum.value() / static_cast<double>(each)) << "trial " << trial;
      }
    }
  }
}

// Leaving out the lowest and the highest tenth, rounded up, by repeatedly removing the extremes.
double trimmed_by_hand(std::vector<double> values) {
  const auto tenth = static_cast<std::size_t>(std::ceil(static_cast<double>(values.size()) / 10));
  for (std::size_t i = 0; i < tenth && values.size() > 2; ++i) {
    values.erase(std::min_element(values.begin(), values.end()));
    values.erase(std::max_element(values.begin(), values.end()));
  }
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

TEST(Forest, IsTheTrimmedMeanOfItsTrees) {
  for (std::uint64_t trial = 0; trial < 1000; ++trial) {
    Stream stream = kForestDraws.stream("trimmed", trial);
    const std::size_t inputs = 1 + stream.below(5), outputs = 1 + stream.below(3);
    auto [trees, forest] =
        random_forest(stream, inputs, outputs, trial % 2 == 0 ? LeafModel::constant : LeafModel::linear);
    forest.aggregate_by(Aggregation::trimmed_mean);
    const std::size_t each = trees.size() / outputs;
    for (int i = 0; i < 10; ++i) {
      std::vector<double> x;
      for (std::size_t c = 0; c < inputs; ++c) x.push_back(eighth(stream, -2, 2));
      const std::vector<double> y = outputs_of(forest, x);
      for (std::size_t o = 0; o < outputs; ++o) {
        std::vector<double> values;  // each held in its range
        for (std::size_t t = 0; t < each; ++t) values.push_back(predict(trees[o * each + t], x).value());
        ASSERT_EQ(y[o], trimmed_by_hand(values)) << each << " trees, trial " << trial;
      }
    }
    Archive archive;
    forest.save(archive);
    ASSERT_EQ(Forest::load(archive), forest);
  }
}

TEST(TrimmedMean, LeavesOutTheTenthRoundedUpButNeverAll) {
  const auto of_first = [](std::size_t size) {
    std::vector<double> values(size);
    for (std::size_t i = 0; i < size; ++i) values[i] = static_cast<double>((i * 7) % size);
    values[0] = -1e9;  // the 0
    return trimmed_mean(values);
  };
  EXPECT_EQ(of_first(1), -1e9);
  EXPECT_EQ(of_first(2), (-1e9 + 1) / 2);
  EXPECT_EQ(of_first(3), 1);
  EXPECT_EQ(trimmed_on_each_side(10), 1u);
  EXPECT_EQ(trimmed_on_each_side(11), 2u);
  EXPECT_EQ(trimmed_on_each_side(25), 3u) << "as in the thesis's code";
  EXPECT_EQ(of_first(25), 12);
  for (const std::size_t size : {2, 5, 9, 10, 11, 20, 25, 60, 61, 100, 250}) {
    for (const int levels : {1, 2, 8}) {  // few: many are equal
      Stream stream = kForestDraws.stream("values", size);
      std::vector<double> values(size);
      for (double& value : values) value = eighth(stream, 0, levels) - (size % 2 == 0 ? 1 : 0);
      const double expected = trimmed_by_hand(values);
      EXPECT_EQ(trimmed_mean(values), expected) << size << " values";
    }
  }
  std::vector<double> with_nan = {1, std::numeric_limits<double>::quiet_NaN(), 2, 3};
  EXPECT_TRUE(std::isnan(trimmed_mean(with_nan)));
}

// A point next to a threshold, in double precision, is on the side that double precision says.
TEST(Forest, ComparesAsInDoublePrecision) {
  Stream stream = kForestDraws.stream("sides");
  for (int trial = 0; trial < 10000; ++trial) {
    const auto threshold = static_cast<float>(stream.normal() * std::exp2(stream.uniform(-140, 120)));
    Tree tree;
    tree.inputs = 1;
    tree.nodes = {{threshold, 0, 1}, {-1, 1, 1}, {1, 1, 2}};
    const Forest forest = forest_of({tree});
    const double above =
        std::nextafter(static_cast<double>(threshold), std::numeric_limits<double>::infinity());
    const double below =
        std::nextafter(static_cast<double>(threshold), -std::numeric_limits<double>::infinity());
    ASSERT_EQ(outputs_of(forest, {threshold}), std::vector<double>{-1});
    ASSERT_EQ(outputs_of(forest, {below}), std::vector<double>{-1});
    ASSERT_EQ(outputs_of(forest, {above}), std::vector<double>{1});
    ASSERT_EQ(outputs_of(forest, {std::numeric_limits<double>::infinity()}), std::vector<double>{1});
    ASSERT_EQ(outputs_of(forest, {-std::numeric_limits<double>::infinity()}), std::vector<double>{-1});
    ASSERT_EQ(outputs_of(forest, {-std::numeric_limits<double>::quiet_NaN()}), std::vector<double>{-1});
  }
}

TEST(Forest, PredictsABatchAsOneByOne) {
  for (const std::size_t inputs : {std::size_t{1}, std::size_t{3}, std::size_t{40}, kMaxTreeInputs}) {
    for (const LeafModel leaf : {LeafModel::constant, LeafModel::linear}) {
      Stream stream = kForestDraws.stream("batch", inputs);
      Forest forest = random_forest(stream, inputs, 2, leaf).forest;
      for (const std::size_t rows : {0, 1, 7, 8, 9, 255, 300, 600}) {
        forest.aggregate_by(rows % 2 == 0 ? Aggregation::mean : Aggregation::trimmed_mean);
        Matrix x(rows, inputs), y(rows, 2);
        for (double& value : x.values()) value = stream.uniform(-1.5, 1.5);
        forest.predict_batch(x, y);
        std::vector<double> in(inputs), out(2);
        for (std::size_t i = 0; i < rows; ++i) {
          x.row(i, in);
          forest.predict(in, out);
          ASSERT_EQ(y(i, 0), out[0]) << inputs << " inputs, row " << i << " of " << rows;
          ASSERT_EQ(y(i, 1), out[1]);
        }
      }
    }
  }
}

TEST(Forest, ScalesItsConstants) {
  Tree tree;
  tree.inputs = 1;
  tree.nodes = {{0.5, 0, 1}, {0.25, 1, 1}, {1, 1, 2}};
  Forest forest(1, {{1000, 8}}, LeafModel::constant);
  forest.add(pack(tree));
  EXPECT_EQ(outputs_of(forest, {0}), std::vector<double>{1002});
  EXPECT_EQ(outputs_of(forest, {1}), std::vector<double>{1008});
  EXPECT_EQ(predict(unpacked(forest.tree(0, 0)), std::vector<double>{1}).value(), 1008);
}

// Whatever their magnitude and offset, values are packed with an error of 2^-24 of their range; numbers of
// few digits, and ranges around 0, exactly.
TEST(ValueRange, MakesAScaleThatKeepsItsValues) {
  const auto packed = [](double least, double most, double value) {
    ValueRange range;
    range.include(least);
    range.include(most);
    const OutputScale scale = range.scale();
    return scale.offset + scale.scale * static_cast<double>(scale.packed(value));
  };
  Stream stream = kForestDraws.stream("range");
  for (int trial = 0; trial < 10000; ++trial) {
    const double unit = std::exp2(stream.uniform(-900, 900));
    const double least = (stream.normal() + (trial % 2 == 0 ? 0 : 1e5)) * unit;
    const double most = least + stream.uniform() * unit;
    const double value = std::clamp(stream.uniform(least, most), least, most);
    const double bound = std::max(most - least, std::min(std::fabs(least), std::fabs(most)) * 1e-9);
    ASSERT_NEAR(packed(least, most, value), value, bound * 0x1p-23 * 17) << least << " to " << most;
  }
  EXPECT_EQ(packed(0.1, 0.1, 0.1), 0.1);
  EXPECT_EQ(packed(0, 1, 1), 1);
  EXPECT_EQ(packed(-100, 0, -7.5), -7.5);
  EXPECT_EQ(packed(1000, 1001, 1000.625), 1000.625);
  EXPECT_EQ(packed(-1e308, 1e308, 1e308),
            static_cast<double>(static_cast<float>(1e308 * 0x1p-1023)) * 0x1p1023);
}

TEST(Forest, CountsItsLeaves) {
  Stream stream = kForestDraws.stream("leaves");
  const auto [trees, forest] = random_forest(stream, 2, 2, LeafModel::constant);
  std::size_t leaves = 0;
  for (const Tree& tree : trees) leaves += leaves_of(tree).size();
  EXPECT_EQ(forest.leaves(), leaves);
}

TEST(Forest, SurvivesAnArchive) {
  for (const LeafModel leaf : {LeafModel::constant, LeafModel::linear}) {
    Stream stream = kForestDraws.stream("archive");
    const Forest forest = random_forest(stream, 3, 2, leaf).forest;
    Archive archive;
    forest.save(archive);
    EXPECT_EQ(Forest::load(Archive::from_bytes(archive.bytes())), forest);
  }
}

TEST(Forest, TakesAtMostSoManyInputs) {
  EXPECT_NO_THROW(Forest(kMaxTreeInputs, {{}}, LeafModel::constant));
  EXPECT_THROW(Forest(kMaxTreeInputs + 1, {{}}, LeafModel::constant), std::invalid_argument);
}

TEST(Forest, PacksNoTreeWhoseChildrenAreTooFar) {
  Tree tree;
  tree.inputs = 1;
  tree.nodes.assign((1u << 24) + 2, {0, 1, 0});
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) tree.nodes[i].child = static_cast<std::int32_t>(i);
  tree.nodes[0] = {0.5, 0, 1 << 24};
  EXPECT_THROW(pack(tree), std::runtime_error);
}

template <class V>
std::vector<V> changed(const Archive& archive, const std::string& name, std::size_t i, V value) {
  std::vector<V> array = archive.get<std::vector<V>>(name);
  array.at(i) = value;
  return array;
}

using Damages = std::vector<std::pair<std::string, std::function<void(Archive&)>>>;
using Shape = std::vector<std::int64_t>;
using Ints = std::vector<std::int32_t>;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

void expect_refused(const Archive& good, const Damages& damages) {
  EXPECT_NO_THROW(Forest::load(good));
  for (const auto& [message, damage] : damages) {
    Archive archive = good;
    damage(archive);
    try {
      Forest::load(archive);
      ADD_FAILURE() << "accepted although: " << message;
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
    }
  }
}

Damages damages_of_shape() {
  return {{"three or four numbers",
           [](Archive& a) {
             a.put("shape", Shape{2, 1});
           }},
          {"number of inputs",
           [](Archive& a) {
             a.put("shape", Shape{-1, 1, 1});
           }},
          {"number of inputs",
           [](Archive& a) {
             a.put("shape", Shape{256, 1, 1});
           }},
          {"number of outputs",
           [](Archive& a) {
             a.put("shape", Shape{2, 0, 1});
           }},
          {"kind of leaf",
           [](Archive& a) {
             a.put("shape", Shape{2, 1, 2});
           }},
          {"unknown aggregation", [](Archive& a) {
             a.put("shape", Shape{2, 1, 1, 2});
           }}};
}

std::int32_t link(std::uint32_t feature, std::uint32_t ahead) {
  return static_cast<std::int32_t>(feature << 24 | ahead);
}

TEST(Forest, RefusesArraysThatMakeNone) {
  Forest forest(2, {{}}, LeafModel::linear);
  Tree tree;
  tree.inputs = 2;
  tree.leaf = LeafModel::linear;
  tree.nodes = {{0.5, 1, 1}, {0, 2, 1}, {1, 2, 2}};
  tree.models = {1, 2, 3, -1, 1, 4, 5, 6, -2, 2};
  forest.add(pack(tree));
  Archive good;
  forest.save(good);
  Damages damages = damages_of_shape();
  const Damages more = {
      {"number of scales", [](Archive& a) { a.put("scales", std::vector<double>{0}); }},
      {"scale that is not finite",
       [](Archive& a) {
         a.put("scales", std::vector<double>{0, kNaN});
       }},
      {"differ in length",
       [](Archive& a) {
         a.put("links", Ints{1, 2});
       }},
      {"number of trees", [](Archive& a) { a.put("roots", Shape{}); }},
      {"does not exist", [](Archive& a) { a.put("roots", Shape{3}); }},
      {"does not exist", [](Archive& a) { a.put("roots", Shape{-1}); }},
      {"does not exist", [](Archive& a) { a.put("links", changed(a, "links", 0, link(1, 2))); }},
      {"used twice",
       [](Archive& a) {
         a.put("roots", Shape{0, 1});
       }},
      {"that no tree reaches", [](Archive& a) { a.put("roots", Shape{1}); }},
      {"not finite", [](Archive& a) { a.put("values", changed(a, "values", 0, static_cast<float>(kNaN))); }},
      {"a split of no input", [](Archive& a) { a.put("links", changed(a, "links", 0, link(3, 1))); }},
      {"a leaf with children", [](Archive& a) { a.put("links", changed(a, "links", 0, link(2, 1))); }},
      {"or a split without", [](Archive& a) { a.put("links", changed(a, "links", 1, link(1, 0))); }},
      {"size of its leaf models", [](Archive& a) { a.put("models", std::vector<double>(11)); }},
      {"model that is not finite", [](Archive& a) { a.put("models", changed(a, "models", 1, kNaN)); }},
      {"empty range", [](Archive& a) { a.put("models", changed(a, "models", 3, 1.5)); }},
  };
  damages.insert(damages.end(), more.begin(), more.end());
  expect_refused(good, damages);
}

TEST(Forest, RefusesTreesThatAreTooDeep) {
  Tree tree;
  tree.inputs = 1;
  for (int i = 0; i <= kMaxTreeDepth; ++i) {  // low children are leaves
    tree.nodes.push_back({0.5, 0, 2 * i + 1});
    tree.nodes.push_back({0, 1, 2 * i + 1});
  }
  tree.nodes.push_back({0, 1, 2 * kMaxTreeDepth + 2});
  Archive archive;
  forest_of({tree}).save(archive);
  EXPECT_THROW(Forest::load(archive), std::runtime_error);
}

/// The arrays that version 0.1 wrote: two trees of one output, whose models are not in the order of leaves.
Archive first_format(LeafModel leaf) {
  Archive archive;
  archive.put("shape", Shape{2, 1, leaf == LeafModel::linear ? 1 : 0});
  archive.put("roots", Ints{0, 3});
  const std::vector<double> constants{0.5, 1000.1, 1000.7, 1000.3}, rows{0.5, 2, 0, 1};
  archive.put("values", leaf == LeafModel::linear ? rows : constants);
  archive.put("features", Ints{1, 2, 2, 2});
  archive.put("children", Ints{1, 1, 2, 3});
  const std::vector<double> models{1, 2, 3, -10, 10, 4, 5, 6, -20, 20, 7, 8, 9, -30, 30};
  archive.put("models", leaf == LeafModel::linear ? models : std::vector<double>{});
  return archive;
}

TEST(Forest, ReadsTheFirstFormat) {
  const Forest constant = Forest::load(first_format(LeafModel::constant));
  EXPECT_EQ(constant.trees(), 2u);
  EXPECT_NEAR(outputs_of(constant, {0, 0.5})[0], 1000.2, 1e-6);
  EXPECT_NEAR(outputs_of(constant, {0, 0.6})[0], 1000.5, 1e-6);
  const Forest linear = Forest::load(first_format(LeafModel::linear));
  EXPECT_EQ(outputs_of(linear, {0.25, 0}), std::vector<double>{(7 + 8 * 0.25 + 4 + 5 * 0.25) / 2});
  EXPECT_EQ(outputs_of(linear, {0.25, 1}), std::vector<double>{(1 + 2 * 0.25 + 3 + 4 + 5 * 0.25 + 6) / 2});
  Archive archive;
  linear.save(archive);
  EXPECT_EQ(Forest::load(archive), linear) << "in the new format";
}

TEST(Forest, RefusesArraysOfTheFirstFormatThatMakeNone) {
  Damages damages = damages_of_shape();
  const Damages more = {
      {"differ in length",
       [](Archive& a) {
         a.put("features", Ints{1, 2});
       }},
      {"number of trees", [](Archive& a) { a.put("roots", Ints{}); }},
      {"does not exist", [](Archive& a) { a.put("roots", Ints{4}); }},
      {"does not exist", [](Archive& a) { a.put("roots", Ints{-1}); }},
      {"used twice",
       [](Archive& a) {
         a.put("roots", Ints{0, 1});
       }},
      {"that no tree reaches", [](Archive& a) { a.put("roots", Ints{3}); }},
      {"not finite", [](Archive& a) { a.put("values", changed(a, "values", 0, kNaN)); }},
      {"not finite", [](Archive& a) { a.put("values", changed(a, "values", 0, 1e300)); }},
      {"a split of no input", [](Archive& a) { a.put("features", changed(a, "features", 0, -1)); }},
      {"a split of no input", [](Archive& a) { a.put("features", changed(a, "features", 0, 3)); }},
      {"do not follow", [](Archive& a) { a.put("children", changed(a, "children", 1, 0)); }},
      {"a leaf with children", [](Archive& a) { a.put("children", changed(a, "children", 0, 0)); }},
      {"without its model", [](Archive& a) { a.put("values", changed(a, "values", 2, 3.0)); }},
      {"without its model", [](Archive& a) { a.put("values", changed(a, "values", 2, 0.5)); }},
      {"model that is not finite", [](Archive& a) { a.put("models", changed(a, "models", 1, kNaN)); }},
      {"empty range", [](Archive& a) { a.put("models", changed(a, "models", 3, 11.0)); }},
  };
  damages.insert(damages.end(), more.begin(), more.end());
  expect_refused(first_format(LeafModel::linear), damages);
}

}  // namespace
}  // namespace coppice::testing
