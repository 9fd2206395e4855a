#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "engine/data/table_file.h"
#include "engine/graph/artifacts.h"
#include "tests/engine/graph/nodes/fake_context.h"

namespace coppice::testing {
namespace {

using ::testing::HasSubstr;
using Attributes = std::vector<std::pair<std::string, std::string>>;
using Values = std::vector<double>;

class CompareTest : public ::testing::Test {
 protected:
  /// An evaluation of so many episodes, the first `terminal` of which end in a terminal state.
  void give_rate(const std::string& policy, std::optional<int> replicate, int terminal, int n,
                 const std::string& training = {}) {
    give(policy, replicate, Values(static_cast<std::size_t>(n), 0));
    InputNode& node = context.given["of"].back();
    node.training = training;
    std::string episodes = "scenario,return,discounted_return,steps,terminal\n";
    for (int i = 0; i < n; ++i) episodes += i < terminal ? "0,0,0,1,1\n" : "0,0,0,1,0\n";
    write_file(node.folder / kReturnsFile, episodes);
    write_file(node.folder / kEvaluationFile, "episodes,terminal_rate\n" + cell_text(std::int64_t{n}) + "," +
                                                  cell_text(static_cast<double>(terminal) / n) + "\n");
  }
  /// An evaluation whose episodes have these returns.
  void give(const std::string& policy, std::optional<int> replicate, const Values& returns,
            const std::string& variant = "HA") {
    InputNode& node = context.given["of"].emplace_back();
    node.id = "scores";
    node.makes = {"evaluation", "score", "timing"};
    node.replicate = replicate;
    node.labels = {{"variant", variant}, {"policy", policy}};
    node.streams = {"evaluate " + std::to_string(replicate.value_or(0))};
    node.folder = context.folder() / std::to_string(context.given["of"].size());
    std::filesystem::create_directory(node.folder);
    double sum = 0, squares = 0;
    std::string episodes = "scenario,return,discounted_return,steps,terminal\n";
    for (const double value : returns) {
      sum += value;
      episodes += "0," + cell_text(value) + ",0,1,0\n";
    }
    const double n = static_cast<double>(returns.size());
    for (const double value : returns) squares += (value - sum / n) * (value - sum / n);
    write_file(node.folder / kReturnsFile, episodes);
    write_file(node.folder / kEvaluationFile, "episodes,mean_return,sd,skewness\n" + cell_text(n) + "," +
                                                  cell_text(sum / n) + "," +
                                                  cell_text(std::sqrt(squares / (n - 1))) + ",0\n");
  }
  Table made(Attributes attributes = {}) {
    attributes.insert(attributes.begin(), {{"id", "c"}, {"of", "scores"}, {"metric", "return"}});
    const Sub<Node> node = make_node(element("compare", attributes));
    node->check(context);
    node->run(context);
    return read_table(context.folder() / kTableFile);
  }
  static double value(const Table& table, std::size_t row, const char* column) {
    return number(table.rows.at(row).at(table.column(column)));
  }
  static std::string text(const Table& table, std::size_t row, const char* column) {
    return cell_text(table.rows.at(row).at(table.column(column)));
  }

  FakeContext context;
};

// Student's sleep data, the example of R's t.test (see mean_estimate_test.cpp), without its skewness.
const Values kFirst = {0.7, -1.6, -0.2, -1.2, -0.1, 3.4, 3.7, 0.8, 0.0};
const Values kSecond = {1.9, 0.8, 1.1, 0.1, -0.1, 4.4, 5.5, 1.6, 4.6};

TEST_F(CompareTest, PairsScenariosOfPoliciesThatWereNotLearned) {
  give("a", {}, kFirst);
  give("b", {}, kSecond);
  const Table table = made();
  EXPECT_EQ(text(table, 0, "method"), "paired episodes");
  // Nine differences of mean -1.6, variance 1.6975: t(0.975, 8) = 2.306004.
  const double half = 2.306004135204 * std::sqrt(1.6975 / 9);
  EXPECT_NEAR(value(table, 0, "difference"), -1.6, 1e-12);
  EXPECT_NEAR(value(table, 0, "ci95_low"), -1.6 - half, 1e-9);
  EXPECT_NEAR(value(table, 0, "ci95_high"), -1.6 + half, 1e-9);
  EXPECT_THAT(text(table, 0, "caution"), HasSubstr("only 9 pairs"));
  EXPECT_LT(value(table, 0, "improvement"), 0.5);
  EXPECT_GT(value(made({{"metric", "cost"}}), 0, "difference"), 0) << "costs are minus returns";
}

TEST_F(CompareTest, TakesScenariosOfOtherDrawsAsIndependent) {
  give("a", {}, kFirst);
  give("b", {}, kSecond);
  context.given["of"][1].streams = {"another 0"};
  EXPECT_EQ(text(made(), 0, "method"), "Welch");
}

TEST_F(CompareTest, PairsTrainingRunsAndCorrectsForTheNumberOfTests) {
  for (int r = 0; r < 9; ++r) {
    const auto i = static_cast<std::size_t>(r);
    give("a", r, {kFirst[i] - 1, kFirst[i] + 1});
    give("b", r, {kSecond[i] - 5, kSecond[i] + 5});
  }
  give("fixed", {}, {2, 4, 3, 3});
  const Table table = made();
  ASSERT_EQ(table.rows.size(), 3u);
  EXPECT_EQ(text(table, 0, "method"), "paired runs");
  EXPECT_EQ(value(table, 0, "n_replicates"), 9);
  const double half = 2.306004135204 * std::sqrt(1.6975 / 9);
  EXPECT_NEAR(value(table, 0, "ci95_low"), -1.6 - half, 1e-9) << "episodes play no part";
  EXPECT_EQ(text(table, 1, "method"), "Welch");
  EXPECT_NEAR(value(table, 1, "improvement"), 2.0 / 9, 1e-12) << "two runs of a are better than 3";
  EXPECT_NEAR(value(table, 2, "improvement"), 3.0 / 9, 1e-12);
  double least = 1, least_adjusted = 1;
  for (std::size_t row = 0; row < 3; ++row) {
    EXPECT_GE(value(table, row, "p_holm"), value(table, row, "p_value"));
    least = std::fmin(least, value(table, row, "p_value"));
    least_adjusted = std::fmin(least_adjusted, value(table, row, "p_holm"));
  }
  EXPECT_NEAR(least_adjusted, 3 * least, 1e-12);
}

TEST_F(CompareTest, SaysNothingOfOtherTrainingRunsFromTheEpisodesOfOne) {
  give("learned", {}, kFirst);
  give("fixed", {}, kSecond);
  context.given["of"][0].training = "key of learned";
  const Table table = made();
  EXPECT_EQ(text(table, 0, "method"), "Welch");
  EXPECT_EQ(value(table, 0, "n_replicates"), 1);
  EXPECT_EQ(text(table, 0, "ci95_low"), "");
  EXPECT_EQ(text(table, 0, "p_value"), "");
  EXPECT_THAT(text(table, 0, "caution"), HasSubstr("one of the training runs"));
}

TEST_F(CompareTest, RenamesKeysThatHaveTheNameOfAnotherColumn) {
  give("a", {}, kFirst);
  give("b", {}, kSecond);
  for (InputNode& node : context.given["of"]) node.labels.emplace_back("episodes", "50");
  const Table table = made({{"within", "episodes"}});
  EXPECT_EQ(text(table, 0, "sweep_episodes"), "50");
  EXPECT_EQ(value(table, 0, "episodes"), 9);
}

TEST_F(CompareTest, ComparesWithinGroupsAndWithABaseline) {
  for (const std::string variant : {"HA", "ANHA"}) {
    give("a", {}, kFirst, variant);
    give("b", {}, kSecond, variant);
    give("c", {}, kSecond, variant);
  }
  EXPECT_EQ(made({{"within", "variant"}}).rows.size(), 6u);
  const Table table = made({{"within", "variant"}, {"baseline", "a"}});
  ASSERT_EQ(table.rows.size(), 4u);
  EXPECT_EQ(text(table, 0, "first"), "b");
  EXPECT_EQ(text(table, 0, "second"), "a");
  EXPECT_EQ(text(table, 2, "variant"), "ANHA");
  EXPECT_EQ(made({{"by", "variant, policy"}}).rows.size(), 15u);
}

TEST_F(CompareTest, IsNeverCertainOfRates) {
  const Attributes attributes = {{"metric", "terminal_rate"}, {"better", "higher"}};
  give_rate("a", {}, 0, 20);
  give_rate("b", {}, 20, 20);
  Table table = made(attributes);
  EXPECT_EQ(text(table, 0, "method"), "paired episodes");
  EXPECT_EQ(value(table, 0, "difference"), -1);
  EXPECT_EQ(value(table, 0, "ci95_low"), -1);
  EXPECT_NEAR(value(table, 0, "ci95_high"), -0.7721, 5e-5) << "Newcombe's interval of 0/20 - 20/20";
  EXPECT_GT(value(table, 0, "p_value"), 0);
  context.given["of"].clear();
  give_rate("a", {}, 1, 30);
  give_rate("b", {}, 1, 30);
  table = made(attributes);
  EXPECT_LT(value(table, 0, "ci95_low"), -0.05);
  EXPECT_GT(value(table, 0, "ci95_high"), 0.05);
  EXPECT_EQ(value(table, 0, "p_value"), 1);
}

TEST_F(CompareTest, KeepsDifferencesOfRatesOfRunsWithinTheirBounds) {
  const Attributes attributes = {{"metric", "terminal_rate"}, {"better", "higher"}};
  for (int r = 0; r < 6; ++r) {
    give_rate("a", r, 10, 10, "a" + std::to_string(r));
    give_rate("b", r, 0, 10, "b" + std::to_string(r));
    give_rate("c", r, r == 0 ? 1 : 0, 10, "c" + std::to_string(r));
  }
  give_rate("d", {}, 5, 10);
  const Table table = made(attributes);
  ASSERT_EQ(table.rows.size(), 6u);
  EXPECT_EQ(text(table, 0, "method"), "paired runs");
  EXPECT_LT(value(table, 0, "ci95_low"), 0.6) << "six trainings of each";
  EXPECT_THAT(text(table, 0, "caution"), HasSubstr("all 6 pairs of training runs are equal"));
  EXPECT_EQ(value(table, 1, "ci95_high"), 1);
  EXPECT_EQ(text(table, 2, "method"), "Newcombe");
  for (std::size_t row = 0; row < 6; ++row) {
    EXPECT_LT(value(table, row, "ci95_low"), value(table, row, "ci95_high")) << row;
    EXPECT_GE(value(table, row, "ci95_low"), -1) << row;
    EXPECT_LE(value(table, row, "ci95_high"), 1) << row;
  }
}

TEST_F(CompareTest, AsksWhetherLongEpisodesAreGood) {
  give("a", {}, kFirst);
  give("b", {}, kSecond);
  EXPECT_THAT(error_of([&] { made({{"metric", "steps"}}); }), HasSubstr("better=\"higher\""));
  const double high = value(made({{"better", "higher"}}), 0, "improvement");
  EXPECT_EQ(value(made(), 0, "improvement"), high);
  EXPECT_NEAR(value(made({{"better", "lower"}}), 0, "improvement"), 1 - high, 1e-12);
}

TEST_F(CompareTest, SaysWhatIsWrong) {
  give("alpha", {}, kFirst);
  EXPECT_THAT(error_of([&] { made(); }), HasSubstr("nothing to compare"));
  give("beta", {}, kFirst);
  EXPECT_THAT(error_of([&] { made({{"baseline", "alpa"}}); }), HasSubstr("did you mean 'alpha'"));
  EXPECT_THAT(error_of([&] { made({{"by", "polcy"}}); }), HasSubstr("by and within: nothing here has"));
  give("beta", {}, kFirst, "ANHA");
  EXPECT_THAT(error_of([&] { made(); }), HasSubstr("by and within do not tell variant"));
}

}  // namespace
}  // namespace coppice::testing
