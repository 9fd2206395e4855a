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
using Attributes = std::vector<std::pair<std::string, std::string>>;

/// An evaluation made by hand.
struct Evaluation {
  std::string policy;
  std::optional<int> replicate;
  double mean_return = 0, sd = 0;
  std::int64_t episodes = 1;
  double terminal_rate = 0, skewness = 0;
  std::string training = {};
};

class TableTest : public ::testing::Test {
 protected:
  void give(const std::vector<Evaluation>& evaluations) {
    std::vector<InputNode>& nodes = context.given["of"];
    for (const Evaluation& made : evaluations) {
      InputNode& node = nodes.emplace_back();
      node.id = "scores";
      node.makes = {"evaluation", "score", "timing"};
      node.replicate = made.replicate;
      node.training = made.training;
      node.labels = {{"problem", "car"}, {"policy", made.policy}};
      node.folder = context.folder() / std::to_string(nodes.size());
      std::filesystem::create_directory(node.folder);
      write_file(node.folder / kEvaluationFile,
                 "episodes,mean_return,sd,mean_discounted_return,sd_discounted_return,mean_steps,sd_steps,"
                 "terminal_rate,skewness,skewness_discounted_return,skewness_steps\n" +
                     cell_text(made.episodes) + "," + cell_text(made.mean_return) + "," + cell_text(made.sd) +
                     ",-2,,7,," + cell_text(made.terminal_rate) + "," + cell_text(made.skewness) + ",0,0\n");
    }
  }
  /// Makes the table and returns it.
  Table made(Attributes attributes = {}) {
    const bool given = !attributes.empty() && attributes.front().first == "rows";
    if (!given) attributes.insert(attributes.begin(), {"rows", "policy"});
    attributes.insert(attributes.begin(), {{"id", "t"}, {"of", "scores"}});
    const Sub<Node> node = make_node(element("table", attributes));
    node->check(context);
    node->run(context);
    return read_table(context.folder() / kTableFile);
  }
  static double value(const Table& table, std::size_t row, const char* column) {
    return number(table.rows.at(row).at(table.column(column)));
  }
  std::string file(const std::string& name, const std::string& text) {
    write_file(context.folder() / name, text);
    return (context.folder() / name).string();
  }

  FakeContext context;
};

TEST_F(TableTest, SummarizesFitsOnTheirTestSets) {
  for (int r = 0; r < 2; ++r) {
    InputNode& node = context.given["of"].emplace_back();
    node.id = "forest";
    node.makes = {"function", "fit", "score", "timing"};
    node.replicate = r;
    node.folder = context.folder() / std::to_string(r);
    std::filesystem::create_directory(node.folder);
    write_file(node.folder / kScoresFile,
               "set,samples,rmse,r2,leaves\ntrain,9,0,1,7\ntest,50," + cell_text(1.0 + r) + ",0.5,7\n");
  }
  const Table table = made({{"rows", "node"}, {"metric", "rmse"}});
  ASSERT_EQ(table.rows.size(), 1u);
  EXPECT_EQ(value(table, 0, "mean"), 1.5);
  EXPECT_EQ(value(table, 0, "n_replicates"), 2);
  EXPECT_EQ(value(table, 0, "episodes"), 50);
  EXPECT_EQ(value(table, 0, "worst"), 2);
  EXPECT_NEAR(value(table, 0, "ci95_high"), 1.5 + 12.7062 * std::sqrt(0.5) / std::sqrt(2), 1e-4);
  EXPECT_EQ(value(made({{"rows", "node"}, {"metric", "leaves"}}), 0, "mean"), 7);
  EXPECT_THROW(made({{"rows", "node"}, {"metric", "cost"}}), std::invalid_argument);
  context.given["of"].pop_back();
  EXPECT_TRUE(std::isnan(value(made({{"rows", "node"}, {"metric", "rmse"}}), 0, "ci95_low")))
      << "one training run has no interval";
}

TEST_F(TableTest, SummarizesTrainingRuns) {
  // Costs 1, 2, 3, 6: mean 3, deviation sqrt(14/3), t(0.975, 3) = 3.182446, interquartile mean of 2 and 3.
  give({{"fpf", 0, -1, 9, 10}, {"fpf", 1, -2, 9, 10}, {"fpf", 2, -6, 9, 10}, {"fpf", 3, -3, 9, 10}});
  const Table table = made();
  ASSERT_EQ(table.rows.size(), 1u);
  EXPECT_EQ(cell_text(table.rows[0][0]), "fpf");
  EXPECT_EQ(value(table, 0, "n_replicates"), 4);
  EXPECT_EQ(value(table, 0, "episodes"), 10);
  EXPECT_NEAR(value(table, 0, "mean"), 3, 1e-12);
  const double half = 3.182446305284 * std::sqrt(14.0 / 3 / 4);
  EXPECT_NEAR(value(table, 0, "ci95_low"), 3 - half, 1e-9) << "the deviation over episodes plays no part";
  EXPECT_NEAR(value(table, 0, "ci95_high"), 3 + half, 1e-9);
  EXPECT_NEAR(value(table, 0, "iqm"), 2.5, 1e-12);
  EXPECT_NEAR(value(table, 0, "median"), 2.5, 1e-12);
  EXPECT_EQ(value(table, 0, "worst"), 6);
  EXPECT_EQ(value(table, 0, "best"), 1);
}

TEST_F(TableTest, TakesEpisodesAsUnitWhereThereAreNoReplicates) {
  give({{"lqr", {}, -3, 2, 16}});
  const Table table = made();
  const double half = 2.131449545559 * 2 / 4;  // t(0.975, 15)
  EXPECT_EQ(value(table, 0, "n_replicates"), 1);
  EXPECT_NEAR(value(table, 0, "ci95_low"), 3 - half, 1e-9);
  EXPECT_NEAR(value(table, 0, "ci95_high"), 3 + half, 1e-9);
}

TEST_F(TableTest, GivesNoIntervalForOneTrainingRun) {
  give({{"fpf", 0, -3, 2, 16}});
  EXPECT_TRUE(std::isnan(value(made(), 0, "ci95_low"))) << "its episodes say nothing of other training runs";
}

TEST_F(TableTest, TakesTheTrainingRunAsUnitAlsoWithoutReplicates) {
  give({{"fpf", {}, -3, 2, 16, 0, 0, "key of fpf"}, {"lqr", {}, -3, 2, 16}});
  const Table table = made();
  EXPECT_EQ(value(table, 0, "n_replicates"), 1);
  EXPECT_EQ(value(table, 0, "mean"), 3);
  EXPECT_TRUE(std::isnan(value(table, 0, "ci95_low")));
  EXPECT_TRUE(std::isnan(value(table, 0, "ci95_high")));
  EXPECT_THAT(cell_text(table.rows[0][table.column("caution")]), HasSubstr("one of the training runs"));
  EXPECT_LT(value(table, 1, "ci95_low"), 3);
}

TEST_F(TableTest, CountsATrainingRunOnceHoweverOftenItIsEvaluated) {
  give({{"fpf", 0, -1, 2, 16, 0, 0, "first"},
        {"fpf", 1, -3, 2, 16, 0, 0, "first"},
        {"fpf", 2, -6, 2, 16, 0, 0, "second"}});
  const Table table = made();
  EXPECT_EQ(value(table, 0, "n_replicates"), 2);
  EXPECT_EQ(value(table, 0, "best"), 2) << "of 1 and 3";
  EXPECT_EQ(value(table, 0, "mean"), 4);
}

TEST_F(TableTest, RenamesKeysThatHaveTheNameOfAnotherColumn) {
  give({{"fpf", 0, -1}});
  context.given["of"][0].labels = {{"episodes", "50"}, {"policy", "fpf"}};
  const Table table = made({{"columns", "episodes"}});
  EXPECT_EQ(value(table, 0, "sweep_episodes"), 50);
  EXPECT_EQ(value(table, 0, "episodes"), 1);
  EXPECT_EQ(cell_text(table.rows[0][table.column("policy")]), "fpf");
}

TEST_F(TableTest, WarnsOfSmallAndSkewedSamples) {
  give({{"fpf", 0, -1}, {"fpf", 1, -2}, {"lqr", {}, -1, 1, 40, 0, -2}, {"mre", {}, -1, 1, 40}});
  const Table table = made();
  const auto caution = [&](std::size_t row) { return cell_text(table.rows[row][table.column("caution")]); };
  EXPECT_THAT(caution(0), HasSubstr("only 2 training runs"));
  EXPECT_THAT(caution(1), HasSubstr("skewness 2")) << "of costs, that is minus the returns";
  EXPECT_EQ(caution(2), "") << "40 symmetric values";
}

TEST_F(TableTest, GivesTheGapToTheReferenceAndTheIntervalOfTheInterquartileMean) {
  give({{"fpf", 0, -1},
        {"fpf", 1, -2},
        {"fpf", 2, -6},
        {"fpf", 3, -3},
        {"fpf", 4, -3.5},
        {"fpf", 5, -2},
        {"fpf", 6, -1},
        {"fpf", 7, -2.5},
        {"fpf", 8, -2},
        {"fpf", 9, -2.25}});
  const Table table = made({{"reference", "2.5"}});
  EXPECT_NEAR(value(table, 0, "optimality_gap"), (3.5 + 0.5 + 1) / 10, 1e-12);
  EXPECT_LT(value(table, 0, "iqm_ci95_low"), value(table, 0, "iqm"));
  EXPECT_GT(value(table, 0, "iqm_ci95_high"), value(table, 0, "iqm"));
  EXPECT_TRUE(std::isnan(value(made(), 0, "optimality_gap"))) << "without a reference there is none";
}

TEST_F(TableTest, BootstrapsRunsAndTheirEpisodesWhenAsked) {
  std::vector<Evaluation> runs;
  for (int r = 0; r < 12; ++r) runs.push_back({"fpf", r, -1.0 - 0.5 * (r % 5), 1, 3});
  give(runs);
  const Table plain = made();
  const Table of_runs = made({{"interval", "bootstrap"}});
  EXPECT_EQ(value(of_runs, 0, "mean"), value(plain, 0, "mean"));
  EXPECT_NE(value(of_runs, 0, "ci95_low"), value(plain, 0, "ci95_low"));
  EXPECT_NEAR(value(of_runs, 0, "ci95_low"), value(plain, 0, "ci95_low"), 0.15);
  EXPECT_NEAR(value(of_runs, 0, "ci95_high"), value(plain, 0, "ci95_high"), 0.15);
  // The same means, of episodes that were kept: these are drawn again, too.
  for (const InputNode& node : context.given["of"]) {
    const double mean = number(read_table(node.folder / kEvaluationFile).rows[0][1]);
    write_file(node.folder / kReturnsFile, "scenario,return\n0," + cell_text(mean - 2) + "\n1," +
                                               cell_text(mean) + "\n2," + cell_text(mean + 2) + "\n");
  }
  const Table nested = made({{"interval", "bootstrap"}});
  EXPECT_NE(value(nested, 0, "ci95_low"), value(of_runs, 0, "ci95_low"));
  EXPECT_NEAR(value(nested, 0, "ci95_low"), value(plain, 0, "ci95_low"), 0.15);
  context.given["of"].resize(9);
  EXPECT_TRUE(std::isnan(value(made({{"interval", "bootstrap"}}), 0, "ci95_low"))) << "too few runs";
}

TEST_F(TableTest, KnowsWhichEndIsGood) {
  give({{"fpf", 0, -1}, {"fpf", 1, -2}});
  const Table returns = made({{"metric", "return"}});
  EXPECT_EQ(value(returns, 0, "mean"), -1.5);
  EXPECT_EQ(value(returns, 0, "worst"), -2);
  EXPECT_EQ(value(returns, 0, "best"), -1);
  EXPECT_EQ(value(made({{"metric", "discounted_cost"}}), 0, "mean"), 2);
  EXPECT_EQ(value(made({{"metric", "steps"}}), 0, "mean"), 7);
}

TEST_F(TableTest, DoesNotGuessWhetherLongEpisodesAreGood) {
  give({{"fpf", 0, -1, 1, 10, 0.25}, {"fpf", 1, -2, 1, 10, 0.75}});
  const Table neither = made({{"metric", "terminal_rate"}});
  EXPECT_EQ(value(neither, 0, "mean"), 0.5);
  EXPECT_EQ(cell_text(neither.rows[0][neither.column("worst")]), "");
  EXPECT_EQ(cell_text(neither.rows[0][neither.column("best")]), "");
  for (const char* metric : {"steps", "terminal_rate"}) {
    EXPECT_THAT(error_of([&] {
                  made({{"metric", metric}, {"reference", "1"}});
                }),
                AllOf(HasSubstr(metric), HasSubstr("better=\"higher\" or better=\"lower\"")));
  }
  const Table goal = made({{"metric", "terminal_rate"}, {"better", "higher"}, {"reference", "1"}});
  EXPECT_EQ(value(goal, 0, "worst"), 0.25);
  EXPECT_EQ(value(goal, 0, "optimality_gap"), 0.5);
  const Table failure = made({{"metric", "terminal_rate"}, {"better", "lower"}, {"reference", "0"}});
  EXPECT_EQ(value(failure, 0, "worst"), 0.75);
  EXPECT_EQ(value(failure, 0, "optimality_gap"), 0.5);
}

TEST_F(TableTest, RefusesKnownValuesOfAnotherDimension) {
  give({{"fpf", 0, -1}, {"fpf", 0, -2}});
  for (std::size_t i = 0; i < 2; ++i) {
    context.given["of"][i].labels = {{"mass", i == 0 ? "1" : "2"}};
    context.given["of"][i].units = {{"mass", "kg"}};
  }
  const std::string wrong = file("wrong.csv", "mass,value\n1 m,7\n");
  EXPECT_THAT(error_of([&] {
                made({{"rows", "mass"}, {"published", wrong}});
              }),
              AllOf(HasSubstr("'1 m' is a length"), HasSubstr("'mass' is a mass")));
  const std::string right = file("right.csv", "mass,value\n1000 g,7\n");
  EXPECT_EQ(value(made({{"rows", "mass"}, {"published", right}}), 0, "published"), 7);
}

TEST_F(TableTest, HasNoReplicatesOfItsOwn) {
  give({{"fpf", 0, -1}});
  EXPECT_THAT(error_of([&] { made({{"replicates", "2"}}); }), HasSubstr("takes all replicates"));
}

TEST_F(TableTest, KeepsTheIntervalOfARateWithinItsBounds) {
  for (const std::string interval : {"t", "bootstrap"}) {
    context.given["of"].clear();
    std::vector<Evaluation> all, few;
    for (int r = 0; r < 12; ++r) {
      all.push_back({"all", r, -1, 1, 50, 1, 0, "a" + std::to_string(r)});
      few.push_back(
          {"few", r, -1, 1, 50, interval == "t" ? (r < 2 ? 0.5 : 0) : 0.02 * r, 0, "f" + std::to_string(r)});
    }
    give(all);
    give(few);
    const Table table = made({{"metric", "terminal_rate"}, {"interval", interval}});
    EXPECT_THAT(cell_text(table.rows[0][table.column("caution")]), HasSubstr("12 training runs")) << interval;
    EXPECT_GE(value(table, 1, "ci95_low"), 0) << interval;
    EXPECT_LT(value(table, 1, "ci95_low"), value(table, 1, "mean")) << interval;
    EXPECT_LE(value(table, 1, "ci95_high"), 1) << interval;
    EXPECT_TRUE(!(value(table, 0, "iqm_ci95_low") == value(table, 0, "iqm_ci95_high"))) << interval;
    EXPECT_FALSE(value(table, 0, "ci95_low") == 1) << interval;
  }
  const Table table = made({{"metric", "terminal_rate"}});
  const double z2 = 1.959963984540 * 1.959963984540;
  EXPECT_NEAR(value(table, 0, "ci95_low"), 12 / (12 + z2), 1e-9) << "twelve trainings, not 600 episodes";
  EXPECT_EQ(value(table, 0, "ci95_high"), 1);
  EXPECT_EQ(value(table, 0, "mean"), 1);
}

TEST_F(TableTest, TakesTheEpisodesOfAllRepetitionsOfWhatWasNotLearned) {
  give({{"lqr", 0, -1, 0, 20, 0}, {"lqr", 1, -1, 0, 20, 0}});
  const Table table = made({{"metric", "terminal_rate"}});
  const double z2 = 1.959963984540 * 1.959963984540;
  EXPECT_NEAR(value(table, 0, "ci95_high"), z2 / (40 + z2), 1e-9);
}

TEST_F(TableTest, SaysWhyTheBootstrapHasNoInterval) {
  give({{"lqr", {}, -1, 2, 40}, {"fpf", 0, -1}, {"fpf", 1, -2}});
  const Table table = made({{"interval", "bootstrap"}});
  EXPECT_EQ(cell_text(table.rows[0][table.column("ci95_low")]), "");
  EXPECT_THAT(cell_text(table.rows[0][table.column("caution")]), HasSubstr("did not keep its episodes"));
  EXPECT_THAT(cell_text(table.rows[1][table.column("caution")]), HasSubstr("only 2 training runs, and the"));
}

TEST_F(TableTest, SaysThatEqualRunsSayLittle) {
  std::vector<Evaluation> runs;
  for (int r = 0; r < 60; ++r) runs.push_back({"fpf", r, -1});
  give(runs);
  const Table table = made();
  EXPECT_THAT(cell_text(table.rows[0][table.column("caution")]), HasSubstr("all 60 training runs are equal"));
}

TEST_F(TableTest, DoubtsARateThatWasAlwaysZero) {
  give({{"lqr", {}, -1, 0, 20, 0}});
  const Table table = made({{"metric", "terminal_rate"}});
  EXPECT_NEAR(value(table, 0, "ci95_low"), 0, 1e-12);
  const double z2 = 1.959963984540 * 1.959963984540;
  EXPECT_NEAR(value(table, 0, "ci95_high"), z2 / (20 + z2), 1e-9) << "Wilson's interval for 0 of n";
}

TEST_F(TableTest, PutsPublishedAndReferenceValuesBeside) {
  give({{"fpf", 0, -1}, {"lqr", {}, -1}});
  const std::string published = file("published.csv", "policy,value,source\nfpf,3.5,thesis\nother,1,\n");
  const Table table = made({{"published", published}, {"reference", "3.4227"}});
  EXPECT_EQ(value(table, 0, "published"), 3.5);
  EXPECT_EQ(cell_text(table.rows[1][table.column("published")]), "");
  EXPECT_EQ(value(table, 1, "reference"), 3.4227);
  const std::string everywhere = file("best.csv", "value\n2\n");
  EXPECT_EQ(value(made({{"reference_file", everywhere}}), 1, "reference"), 2);
}

TEST_F(TableTest, FindsKnownValuesByKeysThatHaveTheNameOfAColumnOfTheirFile) {
  give({{"fpf", 0, -1}, {"fpf", 0, -2}});
  context.given["of"][0].labels = {{"value", "1"}, {"source", "a"}};
  context.given["of"][1].labels = {{"value", "2"}, {"source", "b"}};
  const std::string published = file("published.csv", "sweep_value,sweep_source,value\n2,b,20\n1,a,10\n");
  const Table table = made({{"rows", "value, source"}, {"published", published}});
  EXPECT_EQ(value(table, 0, "published"), 10);
  EXPECT_EQ(value(table, 1, "published"), 20);
}

TEST_F(TableTest, SaysWhatIsWrongWithKnownValues) {
  give({{"fpf", 0, -1}});
  const auto error = [&](const std::string& csv) {
    return error_of([&] { made({{"published", file("known.csv", csv)}}); });
  };
  EXPECT_THAT(error("polcy,value\nfpf,1\n"),
              AllOf(HasSubstr("known.csv"), HasSubstr("did you mean 'policy'")));
  EXPECT_THAT(error("policy\nfpf\n"), HasSubstr("no column 'value'"));
  EXPECT_THAT(error("policy,value\nfqi,1\n"), HasSubstr("none of its rows"));
  EXPECT_THAT(error("policy,value\nfpf,1\nfpf,2\n"), HasSubstr("two values for fpf"));
  EXPECT_THAT(error("policy,value\nfpf,1\nother,abc\n"),
              AllOf(HasSubstr("known.csv:3:7"), HasSubstr("'value': 'abc' is not a finite number")));
  EXPECT_THAT(error("value,note\n1,\n2,\n"),
              AllOf(HasSubstr("known.csv: its 2 rows have no key"), HasSubstr("add a column policy")));
  context.given["of"][0].labels = {{"note", "7"}, {"policy", "fpf"}};
  const auto of_note = [&](const std::string& csv) {
    return error_of([&] { made({{"columns", "note"}, {"published", file("known.csv", csv)}}); });
  };
  EXPECT_THAT(of_note("note,value\n7,1\n"),
              HasSubstr("'note' is a remark here; the key 'note' is called 'sweep_note' in this file"));
  EXPECT_EQ(of_note("sweep_note,note,value\n7,as printed,1\n"), "");
  EXPECT_THAT(error_of([&] {
                made({{"reference", "1"}, {"reference_file", file("r.csv", "value\n1\n")}});
              }),
              HasSubstr("either reference"));
}

}  // namespace
}  // namespace coppice::testing
