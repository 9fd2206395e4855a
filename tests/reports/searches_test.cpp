#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>

#include "engine/data/table_file.h"
#include "engine/graph/artifacts.h"
#include "tests/engine/graph/nodes/fake_context.h"

namespace coppice::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Attributes = std::vector<std::pair<std::string, std::string>>;

/// Adds a search of the function of `n` inputs, as the optimize node writes it.
void add_search(FakeContext& context, int replicate, const std::string& function, int n, int evaluations,
                const std::string& improvements, const std::string& gap, bool known = true) {
  InputNode& node = context.given["of"].emplace_back();
  node.id = "cma_es";
  node.kind = "optimize";
  node.replicate = replicate;
  node.labels = {{"n", std::to_string(n)}, {"function", function}, {"objective", "f"}};
  node.progress_columns = {"iteration", "best_value"};
  if (known) node.progress_columns.emplace_back("gap");
  node.folder = context.folder() / ("in" + std::to_string(context.given["of"].size()));
  std::filesystem::create_directory(node.folder);
  write_file(node.folder / "search.csv",
             "evaluations,gap\n" + std::to_string(evaluations) + "," + gap + "\n");
  write_file(node.folder / "improvements.csv",
             std::string("evaluations,") + (known ? "gap" : "value") + "\n" + improvements);
  std::string optimum = "parameter,value\n";
  for (int i = 0; i < n; ++i) optimum += "x" + std::to_string(i) + ",0\n";
  write_file(node.folder / "optimum.csv", optimum);
}

Table made(FakeContext& context, const std::string& kind, Attributes attributes) {
  attributes.insert(attributes.begin(), {{"id", "t"}, {"of", "cma_es"}});
  const Sub<Node> node = make_node(element(kind, attributes));
  node->check(context);
  node->run(context);
  return read_table(context.folder() / kTableFile);
}
double value(const Table& table, std::size_t row, const char* column) {
  return number(table.rows.at(row).at(table.column(column)));
}
bool is_empty(const Table& table, std::size_t row, const char* column) {
  return std::holds_alternative<std::monostate>(table.rows.at(row).at(table.column(column)));
}

TEST(Runtimes, CountEvaluationsAndSuccessesOfEachTarget) {
  FakeContext context;
  add_search(context, 0, "sphere", 2, 100, "1,40\n10,4\n50,0.5\n", "0.5");
  add_search(context, 1, "sphere", 2, 200, "1,20\n30,2\n", "2");
  add_search(context, 2, "sphere", 2, 100, "1,8\n20,1\n", "1");
  const Table table = made(context, "runtimes", {{"rows", "function, n"}, {"targets", "10, 1, 0.1"}});
  ASSERT_EQ(table.rows.size(), 3u);
  EXPECT_THAT((std::vector<double>{value(table, 0, "n_replicates"), value(table, 0, "successes"),
                                   value(table, 1, "successes"), value(table, 2, "successes")}),
              ElementsAre(3, 3, 2, 0));
  EXPECT_EQ(value(table, 0, "ert"), (10 + 30 + 1) / 3.0);
  EXPECT_EQ(value(table, 1, "ert"), (50 + 200 + 20) / 2.0);
  EXPECT_TRUE(is_empty(table, 2, "ert"));
  EXPECT_EQ(value(table, 0, "median"), 10);
  EXPECT_EQ(value(table, 1, "median"), 50) << "20, 50, never";
  EXPECT_TRUE(is_empty(table, 2, "median"));
  EXPECT_TRUE(is_empty(table, 0, "median_high95")) << "three are too few";
  // Wilson's interval of 3 of 3 begins at 3 / (3 + z^2).
  EXPECT_NEAR(value(table, 0, "success_ci95_low"), 3 / (3 + 1.959963984540054 * 1.959963984540054), 1e-9);
  EXPECT_EQ(value(table, 0, "success_ci95_high"), 1);
  EXPECT_TRUE(is_empty(table, 0, "ert_ci95_low")) << "three are too few";
}

TEST(Runtimes, HaveIntervalsFromTenSearchesOn) {
  FakeContext context;
  for (int r = 0; r < 11; ++r) {
    add_search(context, r, "sphere", 2, 1000, std::to_string(10 * (r + 1)) + ",0.5\n", "0.5");
  }
  const Table table = made(context, "runtimes", {{"rows", "function"}, {"targets", "1"}});
  EXPECT_EQ(value(table, 0, "ert"), 60);
  EXPECT_EQ(value(table, 0, "median"), 60);
  EXPECT_EQ(value(table, 0, "median_high95"), 90);  // the ninth of eleven
  // The mean's standard error is 10; the percentile interval is about 60 +- 1.96 * 10 * sqrt(10 / 11).
  EXPECT_NEAR(value(table, 0, "ert_ci95_low"), 60 - 18.7, 3);
  EXPECT_NEAR(value(table, 0, "ert_ci95_high"), 60 + 18.7, 3);
}

TEST(Runtimes, RefuseSearchesWithoutAKnownOptimum) {
  FakeContext context;
  add_search(context, 0, "sphere", 2, 100, "1,40\n", "", false);
  for (const char* kind : {"runtimes", "gaps"}) {
    EXPECT_THAT(error_of([&] { made(context, kind, {{"rows", "function"}}); }), HasSubstr("is not known"));
  }
}

TEST(Gaps, SummarizeThePointsReturned) {
  FakeContext context;
  const std::vector<std::string> gaps = {"5", "1", "3", "4", "2"};
  for (int r = 0; r < 5; ++r) {
    add_search(context, r, "sphere", 2, 100 + r, "1,0.1\n", gaps[static_cast<std::size_t>(r)]);
  }
  const Table table = made(context, "gaps", {{"rows", "function"}});
  EXPECT_EQ(value(table, 0, "n_replicates"), 5);
  EXPECT_EQ(value(table, 0, "evaluations"), 102);
  EXPECT_EQ(value(table, 0, "median"), 3);
  EXPECT_EQ(value(table, 0, "median_high95"), 5);
  EXPECT_EQ(value(table, 0, "mean"), 3);
  EXPECT_EQ(value(table, 0, "worst"), 5);
  EXPECT_EQ(value(table, 0, "best"), 1);
}

/// One dimension of one function as IOHanalyzer's definition of its two-column format has it
/// (inst/shiny-server/markdown/dataformat.md there), read from the file of meta-data on.
struct Scenario {
  std::map<std::string, std::string> header;
  std::vector<std::string> runs;                                ///< "instance:evaluations|value"
  std::vector<std::vector<std::pair<double, double>>> records;  ///< of each run
};

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" '");
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" '") - first + 1);
}
std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> items;
  std::istringstream in(text);
  for (std::string item; std::getline(in, item, ',');) items.push_back(trimmed(item));
  return items;
}

std::vector<Scenario> read_log(const std::filesystem::path& info) {
  std::vector<Scenario> scenarios;
  std::ifstream in(info);
  for (std::string header, comment, data; std::getline(in, header);) {
    std::getline(in, comment);
    std::getline(in, data);
    EXPECT_EQ(comment.front(), '%');
    Scenario& scenario = scenarios.emplace_back();
    for (const std::string& pair : split(header)) {
      const std::size_t equal = pair.find('=');
      scenario.header[trimmed(pair.substr(0, equal))] = trimmed(pair.substr(equal + 1));
    }
    scenario.runs = split(data);
    std::ifstream records(info.parent_path() / scenario.runs.front());
    scenario.runs.erase(scenario.runs.begin());
    for (std::string line; std::getline(records, line);) {
      if (line.starts_with('"')) {
        EXPECT_EQ(line, "\"function evaluation\" \"best-so-far f(x)\"");
        scenario.records.emplace_back();
        continue;
      }
      std::istringstream numbers(line);
      std::pair<double, double> record;
      EXPECT_TRUE(numbers >> record.first >> record.second) << line;
      scenario.records.back().push_back(record);
    }
  }
  return scenarios;
}

TEST(Iohprofiler, WritesWhatTheDefinitionOfTheFormatReads) {
  FakeContext context;
  add_search(context, 0, "sphere", 2, 100, "1,40\n10,4.5\n50,1e-09\n", "1e-09");
  add_search(context, 1, "sphere", 2, 70, "1,20\n70,2\n", "2");
  add_search(context, 0, "sphere", 3, 300, "2,7\n", "7");
  add_search(context, 0, "step", 2, 80, "3,6\n", "6");
  const Sub<Node> node = make_node(element(
      "iohprofiler", {{"id", "log"}, {"of", "cma_es"}, {"function", "function"}, {"dimension", "n"}}));
  node->check(context);
  node->run(context);
  const std::filesystem::path folder = context.folder() / "iohprofiler/cma_es";
  const std::vector<Scenario> sphere = read_log(folder / "IOHprofiler_f1_sphere.info");
  ASSERT_EQ(sphere.size(), 2u);
  EXPECT_EQ(sphere[0].header.at("funcId"), "1");
  EXPECT_EQ(sphere[0].header.at("funcName"), "sphere");
  EXPECT_EQ(sphere[0].header.at("DIM"), "2");
  EXPECT_EQ(sphere[0].header.at("algId"), "cma_es");
  EXPECT_EQ(sphere[0].header.at("maximization"), "F");
  EXPECT_THAT(sphere[0].runs, ElementsAre("1:100|1e-09", "2:70|2"));
  using Records = std::vector<std::pair<double, double>>;
  ASSERT_EQ(sphere[0].records.size(), 2u);
  EXPECT_EQ(sphere[0].records[0], (Records{{1, 40}, {10, 4.5}, {50, 1e-9}, {100, 1e-9}}))
      << "each block ends with the last evaluation";
  EXPECT_EQ(sphere[0].records[1], (Records{{1, 20}, {70, 2}}));
  EXPECT_EQ(sphere[1].header.at("DIM"), "3");
  EXPECT_EQ(sphere[1].records[0], (Records{{2, 7}, {300, 7}}));
  const std::vector<Scenario> step = read_log(folder / "IOHprofiler_f2_step.info");
  ASSERT_EQ(step.size(), 1u);
  EXPECT_EQ(step[0].header.at("funcId"), "2");
}

TEST(Iohprofiler, LogsValuesToBeMaximizedWhereNoOptimumIsKnown) {
  FakeContext context;
  add_search(context, 0, "swing, up", 2, 100, "1,-40\n10,-4\n", "", false);
  const Sub<Node> node =
      make_node(element("iohprofiler", {{"id", "log"}, {"of", "cma_es"}, {"function", "function"}}));
  node->check(context);
  node->run(context);
  const std::vector<Scenario> log =
      read_log(context.folder() / "iohprofiler/cma_es/IOHprofiler_f1_swing__up.info");
  ASSERT_EQ(log.size(), 1u);
  EXPECT_EQ(log[0].header.at("maximization"), "T");
  EXPECT_EQ(log[0].header.at("funcName"), "swing  up") << "a comma would begin the next pair";
  EXPECT_EQ(log[0].records[0].back(), (std::pair<double, double>{100, -4}));
}

}  // namespace
}  // namespace coppice::testing
