// A short trace of each problem is kept in tests/golden/problems; one that changes must be meant, and is then
// said by raising the component's version. COPPICE_UPDATE_GOLDENS=1 writes the traces.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "engine/data/table_file.h"
#include "engine/vocabulary/problem.h"
#include "tests/support/example.h"
#include "tests/support/make.h"
#include "tests/support/temporary_folder.h"

namespace coppice {
namespace {

/// COPPICE_GOLDEN_DIR names another folder of goldens (for components from elsewhere).
std::filesystem::path golden_folder() {
  const char* given = std::getenv("COPPICE_GOLDEN_DIR");
  const std::filesystem::path own = std::filesystem::path(COPPICE_SOURCE_DIR) / "tests/golden";
  return (given != nullptr ? std::filesystem::path(given) : own) / "problems";
}
const std::filesystem::path kFolder = golden_folder();
constexpr double kTolerance = 1e-9;  // relative; across compilers and machines

int version(const std::string& problem) {
  return Catalogue::instance().find("problem", problem)->version;
}

/// Three episodes of random actions, with the component's version in a column of its own.
Table trace(const std::string& name) {
  const Sub<Problem> problem = make_example<Problem>(name);
  const Sub<Policy> policy = make_from_xml<Policy>("<random/>");
  policy.object->prepare(problem->spaces(), nullptr);
  DatasetRecorder recorder(problem->spaces(), 3);
  Simulation simulation;
  simulation.policy = policy.object.get();
  simulation.rollouts = 3;
  simulation.horizon = 12;
  simulation.recorder = &recorder;
  Serial serial;
  problem->episodes(simulation, Draws(2017, "golden", 0), serial);
  const TemporaryFolder folder;
  write_dataset(folder / "trace.csv", recorder.dataset());
  Table table = read_table(folder / "trace.csv");
  table.columns.push_back({"version", ColumnInfo::Type::integer, "", "Version of the component."});
  for (std::vector<Cell>& row : table.rows) row.emplace_back(std::int64_t{version(name)});
  return table;
}

/// Where two traces differ; empty when they do not.
std::string difference(const Table& golden, const Table& now) {
  for (const ColumnInfo& column : now.columns) {
    if (!golden.has(column.name)) return "the golden has no column '" + column.name + "'";
  }
  if (golden.columns.size() != now.columns.size()) return "the golden has more columns";
  if (golden.rows.size() != now.rows.size()) return "the golden has another number of rows";
  for (std::size_t row = 0; row < now.rows.size(); ++row) {
    for (std::size_t c = 0; c < now.columns.size(); ++c) {
      const double was = number(golden.rows[row][golden.column(now.columns[c].name)]);
      const double is = number(now.rows[row][c]);
      const bool equal = (std::isnan(was) && std::isnan(is)) ||
                         std::fabs(was - is) <= kTolerance * std::max(1.0, std::fabs(was));
      if (!equal) return fmt::format("row {}: {} was {}, is {}", row + 1, now.columns[c].name, was, is);
    }
  }
  return "";
}

class ProblemGoldens : public testing::TestWithParam<std::string> {};

TEST_P(ProblemGoldens, TraceIsTheRecordedOne) {
  const std::filesystem::path file = kFolder / (GetParam() + ".csv");
  const bool update = std::getenv("COPPICE_UPDATE_GOLDENS") != nullptr;
  const Table now = trace(GetParam());
  ASSERT_TRUE(update || std::filesystem::exists(file))
      << GetParam() << " has no golden; COPPICE_UPDATE_GOLDENS=1 "
      << "build/test_conformance writes it";
  if (std::filesystem::exists(file)) {
    const Table golden = read_table(file);
    const std::string what = difference(golden, now);
    if (what.empty()) return;
    ASSERT_TRUE(update) << what << "; if this is meant, raise the component's version and update the golden";
    const double last =
        golden.rows.empty() || !golden.has("version") ? 0 : number(golden.rows[0][golden.column("version")]);
    EXPECT_GT(version(GetParam()), last)
        << what << ": raise the component's version, or cached results stay old";
  }
  write_table(file, now);
  std::filesystem::remove(kFolder / (GetParam() + ".schema.json"));
}

TEST(GoldenFolder, HoldsTracesOfProblemsOnly) {
  for (const auto& entry : std::filesystem::directory_iterator(kFolder)) {
    EXPECT_EQ(entry.path().extension(), ".csv") << entry.path();
    EXPECT_NE(Catalogue::instance().find("problem", entry.path().stem().string()), nullptr) << entry.path();
  }
}

INSTANTIATE_TEST_SUITE_P(All, ProblemGoldens, testing::ValuesIn(Catalogue::instance().names("problem")),
                         component_name);

}  // namespace
}  // namespace coppice
