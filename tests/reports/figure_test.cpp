#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "engine/data/table_file.h"
#include "engine/graph/artifacts.h"
#include "tests/engine/graph/nodes/fake_context.h"

namespace coppice::testing {
namespace {

using ::testing::HasSubstr;
using Attributes = std::vector<std::pair<std::string, std::string>>;

class FigureTest : public ::testing::Test {
 protected:
  InputNode& give(const std::string& artifact, std::optional<int> replicate, const std::string& variant) {
    InputNode& node = context.given["of"].emplace_back();
    node.id = "n";
    node.element = shared(element("evaluate", {{"id", "n"}}));
    node.makes = {artifact, "timing"};
    if (artifact == "evaluation") node.makes.push_back("score");
    node.replicate = replicate;
    node.labels = {{"variant", variant}};
    node.folder = context.folder() / std::to_string(context.given["of"].size());
    std::filesystem::create_directory(node.folder);
    return node;
  }
  void learning(int replicate, const std::string& progress, double cpu_s) {
    const InputNode& node = give("progress", replicate, "HA");
    write_file(node.folder / kProgressFile, "iteration,cost\n" + progress);
    write_file(node.folder / "timing.csv", "wall_s,cpu_s\n9," + cell_text(cpu_s) + "\n");
  }
  void evaluation(int replicate, const std::string& variant, double mean_return) {
    const InputNode& node = give("evaluation", replicate, variant);
    write_file(node.folder / kEvaluationFile,
               "episodes,mean_return,sd,skewness\n5," + cell_text(mean_return) + ",1,0\n");
  }
  void dataset(const std::string& parameter, const std::string& id, const std::string& csv) {
    InputNode& node = context.given[parameter].emplace_back();
    node.id = id;
    node.makes = {"dataset", "timing"};
    node.columns = {"x", "y"};
    node.folder = context.folder() / (parameter + id);
    std::filesystem::create_directory(node.folder);
    write_file(node.folder / kDatasetFile, "x,y\n" + csv);
  }
  Table made(Attributes attributes) {
    attributes.insert(attributes.begin(), {{"id", "f"}, {"of", "n"}});
    const Sub<Node> node = make_node(element("figure", attributes));
    node->check(context);
    node->run(context);
    drawing = nlohmann::json::parse(text_of(context.folder() / "table.vl.json"));
    return read_table(context.folder() / kTableFile);
  }
  static double value(const Table& table, std::size_t row, const char* column) {
    return number(table.rows.at(row).at(table.column(column)));
  }

  FakeContext context;
  nlohmann::json drawing;
};

TEST_F(FigureTest, HoldsTheLastValueOfARunThatEndedEarly) {
  learning(0, "1,10\n2,8\n3,6\n", 3);
  learning(1, "1,20\n2,12\n", 4);
  const Table table = made({{"by", "variant"}});
  ASSERT_EQ(table.rows.size(), 3u);
  EXPECT_EQ(value(table, 0, "mean"), 15);
  EXPECT_EQ(value(table, 2, "iteration"), 3);
  EXPECT_EQ(value(table, 2, "mean"), 9) << "of 6 and 12";
  EXPECT_EQ(value(table, 2, "n"), 2);
  EXPECT_LT(value(table, 2, "ci95_low"), 9);
  EXPECT_FALSE(drawing.contains("usermeta"));
  EXPECT_EQ(drawing.at("data").at("values").size(), 3u);
  EXPECT_EQ(drawing.at("data").at("values").at(2).at("mean"), 9);
  EXPECT_EQ(drawing.at("encoding").at("color").at("field"), "variant");
  EXPECT_EQ(drawing.at("encoding").at("x").at("field"), "iteration");
}

TEST_F(FigureTest, JoinsTimesAndSaysSo) {
  learning(0, "1,10\n2,8\n3,6\n", 3);
  learning(1, "1,20\n2,12\n", 4);
  const Table table = made({{"x", "cpu_s"}});
  ASSERT_EQ(table.rows.size(), 200u);
  EXPECT_EQ(table.columns[0].name, "cpu_s");
  EXPECT_EQ(table.columns[0].unit, "s");
  EXPECT_EQ(value(table, 0, "cpu_s"), 2) << "from there both have a value";
  EXPECT_EQ(value(table, 0, "mean"), (8 + 20) / 2.0);
  EXPECT_EQ(value(table, 199, "cpu_s"), 4);
  EXPECT_EQ(value(table, 199, "mean"), (6 + 12) / 2.0);
  EXPECT_EQ(drawing.at("usermeta").at("reproducible"), false);
}

TEST_F(FigureTest, DrawsEvaluationsOverASweep) {
  for (int r = 0; r < 3; ++r) {
    evaluation(r, "50", -10 - r);
    evaluation(r, "100", -5);
  }
  const Table table = made({{"x", "variant"}});
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_EQ(value(table, 0, "variant"), 50);
  EXPECT_EQ(value(table, 0, "mean"), 11);
  EXPECT_EQ(value(table, 1, "mean"), 5);
  EXPECT_EQ(value(table, 1, "n"), 3);
  EXPECT_EQ(drawing.at("layer").at(1).at("mark").at("point"), true) << "two points, or one, are no line";
}

TEST_F(FigureTest, DrawsLinesOfDatasetsBesideObservations) {
  dataset("of", "truth", "2,4\n0,0\n1,1\n");
  dataset("of", "learned", "0,1\n2,5\n");
  dataset("observations", "seen", "1.5,2\n0.5,0\n");
  const Table table = made({{"observations", "seen"}, {"x", "x"}, {"y", "y"}, {"by", "node"}});
  ASSERT_EQ(table.rows.size(), 3u + 2u + 2u);
  EXPECT_EQ(value(table, 1, "x"), 1) << "in the order of x";
  EXPECT_EQ(value(table, 2, "mean"), 4);
  EXPECT_EQ(cell_text(table.rows[4][table.column("node")]), "learned");
  EXPECT_EQ(cell_text(table.rows[4][table.column("drawn")]), "line");
  EXPECT_EQ(cell_text(table.rows[5][table.column("node")]), "seen");
  EXPECT_EQ(cell_text(table.rows[5][table.column("drawn")]), "point");
  EXPECT_EQ(value(table, 5, "x"), 1.5);
  const nlohmann::json& layers = drawing.at("layer");
  EXPECT_EQ(layers.front().at("mark").at("type"), "line");
  EXPECT_EQ(layers.front().at("transform").at(0).at("filter").at("equal"), "line");
  EXPECT_EQ(layers.back().at("mark"), "point");
  EXPECT_EQ(layers.back().at("encoding").at("y").at("field"), "mean");
}

TEST_F(FigureTest, RefusesColumnsThatADatasetHasNot) {
  dataset("of", "truth", "0,0\n");
  EXPECT_THROW(made({{"x", "z"}, {"y", "y"}}), std::invalid_argument);
  EXPECT_THROW(made({{"x", "x"}, {"y", "cost"}}), std::invalid_argument);
  EXPECT_THROW(made({{"y", "y"}}), std::invalid_argument);
  EXPECT_THROW(made({{"kind", "histogram"}, {"y", "y"}}), std::invalid_argument);
}

TEST_F(FigureTest, CountsEveryRunOnceInAHistogram) {
  for (int r = 0; r < 10; ++r) evaluation(r, "HA", -r);
  const Table table = made({{"kind", "histogram"}, {"bins", "3"}, {"by", "variant"}});
  ASSERT_EQ(table.rows.size(), 3u);
  EXPECT_EQ(value(table, 0, "bin_low"), 0);
  EXPECT_EQ(value(table, 2, "bin_high"), 9);
  EXPECT_EQ(value(table, 0, "count"), 3);
  EXPECT_EQ(value(table, 1, "count"), 3);
  EXPECT_EQ(value(table, 2, "count"), 4) << "the last bin holds its end";
  EXPECT_EQ(drawing.at("spec").at("mark"), "bar");
  EXPECT_EQ(drawing.at("facet").at("row").at("field"), "variant") << "one below the other";
}

TEST_F(FigureTest, GivesWholeNumbersBinsOfWholeWidth) {
  for (int r = 0; r < 40; ++r) evaluation(r, "HA", -19 - r % 5);
  const Table table = made({{"kind", "histogram"}, {"by", "variant"}});
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    EXPECT_EQ(value(table, row, "bin_low"), 18.5 + static_cast<double>(row));
    EXPECT_EQ(value(table, row, "count"), 8);
  }
  EXPECT_EQ(table.rows.size(), 5u) << "19 to 23 steps";
}

TEST_F(FigureTest, ShowsIntervalsAndProfiles) {
  for (int r = 0; r < 10; ++r) evaluation(r, "HA", -r);
  const Table intervals = made({{"kind", "interval"}, {"by", "variant"}});
  EXPECT_EQ(value(intervals, 0, "mean"), 4.5);
  EXPECT_EQ(drawing.at("layer").size(), 2u);
  const Table profile = made({{"kind", "profile"}, {"by", "variant"}});
  EXPECT_EQ(value(profile, 0, "share"), 0) << "no cost is below the least";
  EXPECT_EQ(value(profile, profile.rows.size() - 1, "share"), 0.9);
}

TEST_F(FigureTest, TakesALearnedPolicyWithoutReplicatesAsOneRun) {
  evaluation(0, "HA", -1);
  InputNode& node = context.given["of"][0];
  node.replicate.reset();
  node.training = "its key";
  write_file(node.folder / kReturnsFile, "scenario,return\n0,-1\n1,0\n2,-2\n");
  EXPECT_EQ(value(made({{"kind", "histogram"}, {"bins", "1"}, {"by", "variant"}}), 0, "count"), 1);
  node.training.clear();
  EXPECT_EQ(value(made({{"kind", "histogram"}, {"bins", "1"}, {"by", "variant"}}), 0, "count"), 3);
}

TEST_F(FigureTest, KeepsTheBandsOfDashedLinesApart) {
  evaluation(0, "HA", -1);
  context.given["of"][0].labels = {{"a", "1"}, {"b", "2"}, {"c", "3"}, {"d", "4"}, {"e", "5"}, {"x", "6"}};
  made({{"x", "x"}, {"by", "a, b, c, d, e"}});
  EXPECT_EQ(drawing.at("facet").at("row").at("field"), "c");
  EXPECT_EQ(drawing.at("facet").at("column").at("field"), "d");
  EXPECT_EQ(drawing.at("spec").at("layer").size(), 1u) << "one run has no interval";
  evaluation(1, "HA", -2);
  context.given["of"][1].labels = context.given["of"][0].labels;
  made({{"x", "x"}, {"by", "a, b, c, d, e"}});
  const nlohmann::json& layers = drawing.at("spec").at("layer");
  EXPECT_EQ(layers.at(1).at("encoding").at("strokeDash").at("field"), "b");
  const nlohmann::json& band = layers.at(0).at("encoding");
  EXPECT_FALSE(band.contains("strokeDash")) << "an area has none";
  EXPECT_EQ(band.at("detail").at(0).at("field"), "e");
  EXPECT_EQ(band.at("detail").at(1).at("field"), "b");
}

TEST_F(FigureTest, RenamesKeysThatHaveTheNameOfAnotherColumn) {
  evaluation(0, "HA", -1);
  context.given["of"][0].labels = {{"mean", "4"}, {"n", "7"}};
  const Table table = made({{"x", "mean"}, {"by", "n"}});
  EXPECT_EQ(value(table, 0, "sweep_mean"), 4);
  EXPECT_EQ(value(table, 0, "sweep_n"), 7);
  EXPECT_EQ(value(table, 0, "mean"), 1);
  EXPECT_EQ(drawing.at("encoding").at("x").at("field"), "sweep_mean");
  EXPECT_EQ(drawing.at("encoding").at("color").at("field"), "sweep_n");
}

TEST_F(FigureTest, SaysWhatIsWrong) {
  evaluation(0, "HA", -1);
  EXPECT_THAT(error_of([&] { made({{"x", "varant"}}); }), HasSubstr("did you mean 'variant'"));
  EXPECT_THAT(error_of([&] { made({{"x", "cpu_s"}}); }), HasSubstr("give x, a column of a sweep"));
  EXPECT_THAT(error_of([&] { made({{"x", "variant"}, {"y", "costs"}}); }), HasSubstr("did you mean 'cost'"));
  learning(0, "1,2\n", 1);
  EXPECT_THAT(error_of([&] { made({{"x", "variant"}}); }), HasSubstr("do not go into one figure"));
  context.given["of"].erase(context.given["of"].begin());
  EXPECT_THAT(error_of([&] { made({{"y", "csot"}}); }), HasSubstr("did you mean 'cost'"));
  EXPECT_THAT(error_of([&] { made({{"kind", "profile"}}); }), HasSubstr("evaluate what was learned"));
  EXPECT_THAT(error_of([&] { made({{"x", "ci95_low"}}); }), HasSubstr("has a column 'ci95_low' of its own"));
}

TEST_F(FigureTest, RefusesWhatItsKindDoesNotHeed) {
  evaluation(0, "HA", -1);
  EXPECT_THAT(error_of([&] {
                made({{"kind", "interval"}, {"bins", "3"}, {"by", "variant"}});
              }),
              HasSubstr("only a histogram has bins"));
  EXPECT_THAT(error_of([&] {
                made({{"kind", "interval"}, {"better", "lower"}, {"by", "variant"}});
              }),
              HasSubstr("only of a profile"));
  EXPECT_THAT(error_of([&] {
                made({{"kind", "profile"}, {"y", "steps"}, {"by", "variant"}});
              }),
              HasSubstr("better=\"higher\""));
  const Table table = made({{"kind", "profile"}, {"better", "higher"}, {"by", "variant"}});
  EXPECT_EQ(value(table, 0, "share"), 1) << "1 is a higher cost than the threshold";
}

TEST_F(FigureTest, DrawsNumbersAsNumbersHoweverTheyAreWritten) {
  evaluation(0, "0.5", -1);
  evaluation(0, "1.0", -2);
  const Table table = made({{"x", "variant"}});
  EXPECT_EQ(table.columns[0].type, ColumnInfo::Type::number);
  EXPECT_EQ(cell_text(table.rows[1][0]), "1");
  EXPECT_EQ(drawing.at("encoding").at("x").at("type"), "quantitative");
}

TEST_F(FigureTest, RefusesToTakeAMeanForAnEpisode) {
  InputNode& node = give("evaluation", {}, "HA");
  node.element = shared(element("evaluate", {{"returns", "false"}}));
  write_file(node.folder / kEvaluationFile, "episodes,mean_return,sd,skewness\n5,-1,1,0\n");
  for (const char* kind : {"histogram", "profile"}) {
    EXPECT_THAT(error_of([&] {
                  made({{"kind", kind}, {"by", "variant"}});
                }),
                HasSubstr("does not keep the episodes"));
  }
  EXPECT_EQ(value(made({{"kind", "interval"}, {"by", "variant"}}), 0, "mean"), 1);
  node.training = "key of the training";  // whose run has one value, its mean
  EXPECT_EQ(value(made({{"kind", "histogram"}, {"bins", "1"}, {"by", "variant"}}), 0, "count"), 1);
}

TEST_F(FigureTest, KnowsWhenPlannedWhichColumnsProgressWillHave) {
  learning(0, "1,2\n", 1);
  context.given["of"][0].progress_columns = {"iteration", "cost", "spread"};
  const auto error = [&](Attributes attributes) {
    attributes.insert(attributes.begin(), {{"id", "f"}, {"of", "n"}});
    return error_of([&] { make_node(element("figure", attributes))->check(context); });
  };
  EXPECT_EQ(error({}), "") << "y is cost";
  EXPECT_EQ(error({{"y", "spread"}, {"x", "cpu_s"}}), "");
  EXPECT_THAT(
      error({{"y", "spead"}, {"x", "iteratoin"}}),
      AllOf(HasSubstr("y: the progress of 'n' has no column 'spead'"), HasSubstr("did you mean 'spread'?"),
            HasSubstr("x: the progress of 'n' has no column 'iteratoin'"),
            HasSubstr("did you mean 'iteration'?")));
  context.given["of"][0].progress_columns.clear();
  EXPECT_EQ(error({{"y", "spead"}}), "") << "nothing is known, so it is found when the figure is made";
}

}  // namespace
}  // namespace coppice::testing
