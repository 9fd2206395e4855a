#include "solvers/approximators/forest.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <stdexcept>

#include "tests/solvers/approximators/random_trees.h"

namespace coppice::testing {
namespace {

const Draws kDraws(2017, "forest", 0);

struct Grown {
  std::vector<Tree> trees;  // output after output
  Forest forest;
};

Grown random_forest(Stream& stream, std::size_t inputs, std::size_t outputs, LeafModel leaf) {
  Grown grown;
  grown.forest = Forest(inputs, outputs, leaf);
  grown.trees.resize(outputs * (1 + stream.below(20)));
  for (Tree& tree : grown.trees) {
    tree = random_tree(stream, {inputs, leaf, 5});
    grown.forest.add(tree);
  }
  return grown;
}

std::vector<double> predict(const Forest& forest, const std::vector<double>& x) {
  std::vector<double> y(forest.outputs());
  forest.predict(x, y);
  return y;
}

// A linear forest holds the mean of its models in the mean of their ranges.
TEST(Forest, IsTheMeanOfItsTrees) {
  for (std::uint64_t trial = 0; trial < 1000; ++trial) {
    Stream stream = kDraws.stream("mean", trial);
    const std::size_t inputs = 1 + stream.below(5), outputs = 1 + stream.below(3);
    const LeafModel leaf = trial % 2 == 0 ? LeafModel::constant : LeafModel::linear;
    const auto [trees, forest] = random_forest(stream, inputs, outputs, leaf);
    const std::size_t each = trees.size() / outputs;
    ASSERT_EQ(forest.trees(), each);
    for (int i = 0; i < 10; ++i) {
      std::vector<double> x;
      for (std::size_t c = 0; c < inputs; ++c) x.push_back(eighth(stream, -2, 2));
      const std::vector<double> y = predict(forest, x);
      for (std::size_t o = 0; o < outputs; ++o) {
        Prediction sum;
        for (std::size_t t = 0; t < each; ++t) {
          const Prediction p = testing::predict(trees[o * each + t], x);
          ASSERT_EQ(testing::predict(forest.tree(o, t), x), p);
          sum = {sum.model + p.model, sum.low + p.low, sum.high + p.high};
        }
        ASSERT_EQ(y[o], sum.value() / static_cast<double>(each)) << "trial " << trial;
      }
    }
  }
}

TEST(Forest, CountsItsLeaves) {
  Stream stream = kDraws.stream("leaves");
  const auto [trees, forest] = random_forest(stream, 2, 2, LeafModel::constant);
  std::size_t leaves = 0;
  for (const Tree& tree : trees) leaves += leaves_of(tree).size();
  EXPECT_EQ(forest.leaves(), leaves);
}

TEST(Forest, SurvivesAnArchive) {
  for (const LeafModel leaf : {LeafModel::constant, LeafModel::linear}) {
    Stream stream = kDraws.stream("archive");
    const Forest forest = random_forest(stream, 3, 2, leaf).forest;
    Archive archive;
    forest.save(archive);
    EXPECT_EQ(Forest::load(Archive::from_bytes(archive.bytes())), forest);
  }
}

TEST(Forest, TakesAtMostSoManyInputs) {
  EXPECT_NO_THROW(Forest(kMaxTreeInputs, 1, LeafModel::constant));
  EXPECT_THROW(Forest(kMaxTreeInputs + 1, 1, LeafModel::constant), std::invalid_argument);
}

template <class V>
std::vector<V> changed(const Archive& archive, const std::string& name, std::size_t i, V value) {
  std::vector<V> array = archive.get<std::vector<V>>(name);
  array.at(i) = value;
  return array;
}

TEST(Forest, RefusesArraysThatMakeNone) {
  Forest forest(2, 1, LeafModel::linear);
  Tree tree;
  tree.inputs = 2;
  tree.leaf = LeafModel::linear;
  tree.nodes = {{0.5, 1, 1}, {0, 2, 1}, {1, 2, 2}};
  tree.models = {1, 2, 3, -1, 1, 4, 5, 6, -2, 2};
  forest.add(tree);
  Archive good;
  forest.save(good);
  EXPECT_NO_THROW(Forest::load(good));

  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  using Ints = std::vector<std::int32_t>;
  const std::vector<std::pair<std::string, std::function<void(Archive&)>>> damages = {
      {"three numbers",
       [](Archive& a) {
         a.put("shape", std::vector<std::int64_t>{2, 1});
       }},
      {"number of inputs",
       [](Archive& a) {
         a.put("shape", std::vector<std::int64_t>{-1, 1, 1});
       }},
      {"number of inputs",
       [](Archive& a) {
         a.put("shape", std::vector<std::int64_t>{256, 1, 1});
       }},
      {"number of outputs",
       [](Archive& a) {
         a.put("shape", std::vector<std::int64_t>{2, 0, 1});
       }},
      {"kind of leaf",
       [](Archive& a) {
         a.put("shape", std::vector<std::int64_t>{2, 1, 2});
       }},
      {"differ in length",
       [](Archive& a) {
         a.put("features", Ints{1, 2});
       }},
      {"number of trees", [](Archive& a) { a.put("roots", Ints{}); }},
      {"does not exist", [](Archive& a) { a.put("roots", Ints{3}); }},
      {"does not exist", [](Archive& a) { a.put("roots", Ints{-1}); }},
      {"used twice",
       [](Archive& a) {
         a.put("roots", Ints{0, 1});
       }},
      {"that no tree reaches", [](Archive& a) { a.put("roots", Ints{1}); }},
      {"not finite", [&](Archive& a) { a.put("values", changed(a, "values", 0, kNaN)); }},
      {"a split of no input",
       [](Archive& a) {
         a.put("features", Ints{-1, 2, 2});
       }},
      {"a split of no input",
       [](Archive& a) {
         a.put("features", Ints{3, 2, 2});
       }},
      {"do not follow",
       [](Archive& a) {
         a.put("children", Ints{0, 1, 2});
       }},
      {"do not follow",
       [](Archive& a) {
         a.put("children", Ints{2, 1, 2});
       }},
      {"a leaf with children",
       [](Archive& a) {
         a.put("children", Ints{1, 1, 1});
       }},
      {"without its model", [](Archive& a) { a.put("values", changed(a, "values", 2, 2.0)); }},
      {"without its model", [](Archive& a) { a.put("values", changed(a, "values", 2, 0.5)); }},
      {"size of its leaf models", [](Archive& a) { a.put("models", std::vector<double>(11)); }},
      {"model that is not finite", [&](Archive& a) { a.put("models", changed(a, "models", 1, kNaN)); }},
      {"empty range", [](Archive& a) { a.put("models", changed(a, "models", 3, 1.5)); }},
  };
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

}  // namespace
}  // namespace coppice::testing
