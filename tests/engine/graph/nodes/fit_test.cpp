#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "engine/data/table_file.h"
#include "engine/graph/artifacts.h"
#include "tests/engine/graph/nodes/fake_context.h"

namespace coppice::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using Attributes = std::vector<std::pair<std::string, std::string>>;

/// A dataset node's folder with a table in it.
class Data {
 public:
  explicit Data(const std::string& csv) { write_file(context_.folder() / kDatasetFile, csv); }
  InputNode node(const std::string& id) const {
    InputNode made;
    made.id = id;
    made.kind = "dataset";
    made.element = shared(element("dataset", {{"id", id}}));
    made.folder = context_.folder();
    made.key = id;
    return made;
  }

 private:
  FakeContext context_;
};

Sub<Node> fit(const std::string& approximator, Attributes more = {}) {
  more.insert(more.begin(), {{"id", "f"}, {"samples", "train"}, {"inputs", "x1, x2"}, {"output", "y"}});
  return make_node(element("fit", more, {element(approximator, {})}));
}

TEST(Fit, FindsAPlaneAndScoresItOnBothSets) {
  const Data train("x1,other,x2,y\n0,a,0,1\n1,b,0,3\n0,c,1,0\n1,d,1,2\n2,e,1,4\n");  // y = 1 + 2 x1 - x2
  const Data test("y,x2,x1\n6,0,2\n5,2,3\n");                                        // off by 1 and 0
  FakeContext context;
  context.given["samples"] = {train.node("train")};
  context.given["test"] = {test.node("test")};
  const auto node = fit("linear", {{"test", "test"}});
  node->check(context);
  node->run(context);

  const Table scores = read_table(context.folder() / "scores.csv");
  const auto score = [&](std::size_t row, const char* column) {
    return number(scores.rows.at(row).at(scores.column(column)));
  };
  ASSERT_EQ(scores.rows.size(), 2u);
  EXPECT_EQ(score(0, "samples"), 5);
  EXPECT_NEAR(score(0, "rmse"), 0, 1e-9);
  EXPECT_NEAR(score(0, "r2"), 1, 1e-9);
  EXPECT_NEAR(score(1, "rmse"), std::sqrt(0.5), 1e-9);
  EXPECT_NEAR(score(1, "r2"), 1 - 1.0 / 0.5, 1e-9) << "worse than the mean of the test set";

  const FunctionFile file = read_function_file(context.folder() / kFunctionFile);
  EXPECT_EQ(file.inputs, (std::vector<std::string>{"x1", "x2"}));
  EXPECT_EQ(file.output, "y");
  double y = 0;
  make_function(file)->predict(std::vector<double>{10, 1}, std::span(&y, 1));
  EXPECT_NEAR(y, 20, 1e-8);
}

TEST(Fit, TakesTheSamplesOfAllReplicates) {
  const Data first("x1,x2,y\n0,0,1\n1,0,3\n"), second("y,x1,x2\n0,0,1\n2,1,1\n4,2,1\n");  // y = 1 + 2 x1 - x2
  FakeContext context;
  context.given["samples"] = {first.node("train"), second.node("train")};
  const auto node = fit("linear");
  EXPECT_TRUE(node->gathers_replicates("samples"));
  node->run(context);
  const Table scores = read_table(context.folder() / "scores.csv");
  EXPECT_EQ(number(scores.rows.at(0).at(scores.column("samples"))), 5);
  EXPECT_NEAR(number(scores.rows.at(0).at(scores.column("rmse"))), 0, 1e-9);
}

TEST(Fit, NamesTheCellThatIsNoNumber) {
  const Data train("x1,x2,y\n0,0,1\n0,,2\n");
  FakeContext context;
  context.given["samples"] = {train.node("train")};
  EXPECT_THAT(error_of([&] { fit("constant")->run(context); }),
              AllOf(HasSubstr("dataset.csv:3"), HasSubstr("x2")));
}

TEST(Fit, NamesTheColumnThatIsNotThere) {
  const Data train("x1,x3,y\n0,0,1\n");
  FakeContext context;
  context.given["samples"] = {train.node("train")};
  EXPECT_THAT(error_of([&] { fit("constant")->run(context); }),
              AllOf(HasSubstr("no column 'x2'"), HasSubstr("x3")));
}

TEST(Fit, ChecksColumnsThatAreKnownBeforeItRuns) {
  FakeContext context;
  InputNode train, test;
  train.element = test.element = shared(element("collect", {}));
  train.id = "train";
  train.columns = {"x1", "x3", "z"};
  test.id = "test";
  test.columns = {"x1", "x2", "y"};
  context.given["samples"] = {train};
  context.given["test"] = {test};
  EXPECT_THAT(error_of([&] {
                fit("constant", {{"test", "test"}})->check(context);
              }),
              AllOf(HasSubstr("inputs: the dataset 'train' has no column 'x2'"), HasSubstr("did you mean"),
                    HasSubstr("output: the dataset 'train' has no column 'y'"), Not(HasSubstr("'test'"))));
  context.given["samples"].front().columns = {};  // unknown
  EXPECT_EQ(error_of([&] { fit("constant", {{"test", "test"}})->check(context); }), "");
}

TEST(Fit, RefusesATestSetFromTheDrawsOfTheSamples) {
  FakeContext context;
  InputNode train, test;
  train.element = test.element = shared(element("collect", {}));
  train.id = "train";
  train.streams = {"collect 0"};
  test.id = "test";
  test.streams = {"collect 0"};
  context.given["samples"] = {train};
  context.given["test"] = {test};
  EXPECT_THAT(error_of([&] {
                fit("constant", {{"test", "test"}})->check(context);
              }),
              HasSubstr("seed_label"));
  train.streams = {"collect 1"};
  context.given["samples"].insert(context.given["samples"].begin(), train);  // one replicate of two is enough
  EXPECT_THAT(error_of([&] {
                fit("constant", {{"test", "test"}})->check(context);
              }),
              HasSubstr("same draws (collect 0)"));
  context.given["test"].front().streams = {"test 0", "train 0",
                                           "collect 0"};  // only its policy saw the samples
  EXPECT_EQ(error_of([&] { fit("constant", {{"test", "test"}})->check(context); }), "");
}

TEST(Fit, RefusesTheSameFileAsTest) {
  FakeContext context;
  InputNode one, two;
  one.element = shared(element("dataset", {{"id", "one"}, {"file", "/data/a.csv"}}));
  two.element = shared(element("dataset", {{"id", "two"}, {"file", "/data/a.csv"}}));
  context.given["samples"] = {one};
  context.given["test"] = {two};
  EXPECT_THAT(error_of([&] {
                fit("constant", {{"test", "test"}})->check(context);
              }),
              HasSubstr("the same file"));
  two.element = shared(element("dataset", {{"id", "two"}, {"file", "/data/b.csv"}}));
  context.given["test"] = {two};
  EXPECT_EQ(error_of([&] { fit("constant", {{"test", "test"}})->check(context); }), "");
}

TEST(Fit, RefusesAnOutputThatIsAnInput) {
  const auto error = [](const std::string& inputs, const std::string& output) {
    return error_of([&] {
      make_node(element("fit", {{"id", "f"}, {"samples", "s"}, {"inputs", inputs}, {"output", output}},
                        {element("constant", {})}));
    });
  };
  EXPECT_THAT(error("a, b", "b"), HasSubstr("input and output"));
  EXPECT_THAT(error("a, a", "b"), HasSubstr("twice"));
}

}  // namespace
}  // namespace coppice::testing
