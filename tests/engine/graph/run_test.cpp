#include "engine/graph/run.h"

#include <gtest/gtest.h>

#include <ctime>
#include <fstream>
#include <map>
#include <set>

#include "engine/data/file_system.h"
#include "engine/data/table_file.h"
#include "engine/graph/run_folder.h"
#include "tests/engine/graph/experiments.h"

namespace coppice::testing {
namespace {

namespace fs = std::filesystem;

constexpr const char* kChain =
    "<fake_constant id='c'/><fake_source id='x' amount='5' replicates='3'/>"
    "<fake_step id='y' replicates='3' from='x' constant='c'/><fake_score id='e' of='y, x'/>"
    "<fake_report id='t' of='e'/>";
constexpr std::size_t kChainNodes = 13;

/// Notes the names of the nodes that ran.
class NodeNames : public RunListener {
 public:
  void finished(const NodeReport& report, const RunTotals&) override { ran.insert(report.node->name); }
  void failed(const NodeReport& report, const RunTotals&) override { failures.insert(report.node->name); }
  void skipped(const NodeReport& report, const RunTotals&) override { skips.insert(report.node->name); }
  std::set<std::string> ran, failures, skips;
};

class Run : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    out_ = fs::path(::testing::TempDir()) / ("coppice_run_" + std::string(info->name()));
    fs::remove_all(out_);
  }
  void TearDown() override { fs::remove_all(out_); }

  static Plan plan(const std::string& nodes, std::vector<SweepPoints> sweeps = {}) {
    return make_plan(experiment("<experiment name='test'>" + nodes + "</experiment>", std::move(sweeps)));
  }

  RunOutcome go(const std::string& nodes, RunOptions options = {}, std::vector<SweepPoints> sweeps = {}) {
    const Plan planned = plan(nodes, std::move(sweeps));
    listener_ = NodeNames();
    options.out = out_;
    if (options.threads == 0) options.threads = 2;
    if (options.listener == nullptr) options.listener = &listener_;
    std::set<std::string> promised;
    const std::vector<NodeStatus> statuses = inspect(planned, options.selection, out_);
    for (std::size_t i = 0; i < statuses.size(); ++i) {
      if (statuses[i].runs) promised.insert(planned.nodes[i].name);
    }
    std::vector<Plan> plans;
    plans.push_back(planned);
    RunOutcome outcome = run(plans, options);
    if (options.listener == &listener_ && outcome.exit_status() == 0) {
      EXPECT_EQ(listener_.ran, promised);
    }
    return outcome;
  }

  fs::path file(const std::string& path) const { return out_ / "test" / path; }

  /// Content of every file below the run folder that must be reproducible.
  std::map<std::string, std::string> results() const { return results_in(out_); }
  static std::map<std::string, std::string> results_in(const fs::path& out) {
    std::map<std::string, std::string> files;
    for (const char* part : {"nodes", "tables"}) {
      if (!fs::exists(out / "test" / part)) continue;
      for (const fs::directory_entry& entry : fs::recursive_directory_iterator(out / "test" / part)) {
        if (!entry.is_regular_file() || entry.path().filename() == "timing.csv") continue;
        files[entry.path().lexically_relative(out).string()] = read_file(entry.path());
      }
    }
    return files;
  }

  /// When each file below the output folder was written, and where it lies on the disk.
  std::map<std::string, fs::file_time_type> times() const {
    std::map<std::string, fs::file_time_type> all;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(out_)) {
      if (entry.path().filename() != "lock") all[entry.path().string()] = entry.last_write_time();
    }
    return all;
  }

  fs::path out_;
  NodeNames listener_;
};

TEST_F(Run, ComputesEveryNodeAndIsThenUpToDateWithoutTouchingAFile) {
  const RunOutcome first = go(kChain);
  EXPECT_EQ(first.exit_status(), 0);
  EXPECT_EQ(first.totals.finished, kChainNodes);
  EXPECT_TRUE(fs::exists(file("nodes/e/y/r002/score.csv")));
  EXPECT_TRUE(fs::exists(file("nodes/x/r000/timing.csv")));
  EXPECT_TRUE(fs::exists(file("tables/t.csv")));
  EXPECT_TRUE(fs::exists(file("resolved.xml")));
  EXPECT_TRUE(fs::exists(file("provenance.json")));
  const auto before = times();
  const RunOutcome second = go(kChain);
  EXPECT_EQ(second.totals.to_run, 0u);
  EXPECT_EQ(second.totals.up_to_date, kChainNodes);
  EXPECT_EQ(times(), before);
}

TEST_F(Run, MakesWhatEqualNodesShareOnce) {
  const std::string pair = "<fake_source id='a' amount='5'/><fake_source id='b' amount='5'/>";
  const std::vector<NodeStatus> planned = inspect(plan(pair), {}, out_);
  EXPECT_EQ(to_text(planned[0]), "new");
  EXPECT_EQ(to_text(planned[1]), "the same as a");
  const RunOutcome outcome = go(pair);
  EXPECT_EQ(outcome.totals.to_run, 1U);
  EXPECT_EQ(outcome.totals.up_to_date, 1U);
  EXPECT_EQ(listener_.ran, std::set<std::string>{"a"});
  EXPECT_TRUE(fs::exists(file("nodes/b/timing.csv")));
  EXPECT_EQ(go(pair).totals.to_run, 0U);
  RunOptions force;
  force.selection.force = {"b"};
  EXPECT_EQ(go(pair, force).totals.to_run, 1U);
  EXPECT_EQ(listener_.ran, std::set<std::string>{"b"});
}

TEST_F(Run, GivesEqualBytesForOneAndTwoThreadsAndInAnyFolder) {
  RunOptions one;
  one.threads = 1;
  go(kChain, one);
  const auto first = results();
  fs::rename(out_, out_.string() + "_moved");
  go(kChain);
  EXPECT_EQ(results(), first);
  EXPECT_EQ(results_in(out_.string() + "_moved"), first);
  fs::remove_all(out_.string() + "_moved");
}

TEST_F(Run, RerunsOnlyWhatDependsOnAChange) {
  go(kChain);
  std::string changed = kChain;
  changed.replace(changed.find("from='x'"), 8, "factor='7' from='x'");
  const std::vector<NodeStatus> statuses = inspect(plan(changed), {}, out_);
  EXPECT_EQ(to_text(statuses[plan(changed).find("y r000").front()]), "changed: factor: 2 -> 7");
  EXPECT_EQ(to_text(statuses[plan(changed).find("x r000").front()]), "up to date");
  go(changed);
  EXPECT_EQ(listener_.ran,
            (std::set<std::string>{"y r000", "y r001", "y r002", "e y r000", "e y r001", "e y r002", "t"}));
  go(kChain);
  EXPECT_TRUE(listener_.ran.empty()) << "the store still has the old results";
}

TEST_F(Run, NamesTheChangedParameterOfADefinition) {
  go(kChain);
  std::string changed = kChain;
  changed.replace(changed.find("id='c'"), 6, "id='c' value='9'");
  const Plan planned = plan(changed);
  const std::vector<Explanation> why = explain(planned, "y r001", out_);
  ASSERT_EQ(why.size(), 1u);
  EXPECT_EQ(to_text(why.front().status), "changed: constant.value: 1 -> 9");
  EXPECT_EQ(why.front().key, named(planned, "y r001").key);
  EXPECT_TRUE(contains(why.front().key_text, "input.constant.value = 9\n"));
  EXPECT_THROW(explain(planned, "z", out_), ConfigError);
}

TEST_F(Run, RenamingAndReorderingComputesNothingAnew) {
  go(kChain);
  const std::string score = read_file(file("nodes/e/y/r001/score.csv"));
  const RunOutcome renamed =
      go("<fake_source id='first' amount='5' replicates='3'/><fake_constant id='number'/>"
         "<fake_score id='points' of='second'/>"
         "<fake_step id='second' replicates='3' from='first' constant='number'/>");
  EXPECT_EQ(renamed.totals.to_run, 0u);
  EXPECT_EQ(read_file(file("nodes/points/second/r001/score.csv")), score);
  EXPECT_FALSE(fs::exists(file("nodes/x"))) << "what the config no longer has is removed";
  EXPECT_FALSE(fs::exists(file("tables")));
}

TEST_F(Run, ComputesEqualKeysOnce) {
  const RunOutcome outcome = go("<fake_source id='a'/><fake_source id='b'/>");
  EXPECT_EQ(outcome.totals.finished, 1u);
  EXPECT_EQ(read_file(file("nodes/a/data.txt")), read_file(file("nodes/b/data.txt")));
}

TEST_F(Run, SharesTheStoreBetweenExperiments) {
  go("<fake_source id='a'/>");
  std::vector<Plan> plans;
  plans.push_back(make_plan(experiment("<experiment name='one'><fake_source id='a'/></experiment>")));
  plans.push_back(
      make_plan(experiment("<experiment name='two'><fake_source id='b' amount='2'/></experiment>")));
  RunOptions options;
  options.out = out_;
  const RunOutcome outcome = run(plans, options);
  EXPECT_EQ(outcome.totals.finished, 1u);
  EXPECT_TRUE(fs::exists(out_ / "one/nodes/a/data.txt"));
  EXPECT_TRUE(fs::exists(out_ / "two/nodes/b/data.txt"));
}

TEST_F(Run, AFailureSkipsWhatDependsOnItAndFinishesTheRest) {
  const std::string nodes =
      "<fake_source id='bad' fails='true'/><fake_step id='y' from='bad'/><fake_score id='e' of='y'/>"
      "<fake_source id='good'/><fake_step id='z' from='good'/>";
  const RunOutcome outcome = go(nodes);
  EXPECT_EQ(outcome.exit_status(), 1);
  EXPECT_EQ(outcome.failures, std::vector<std::string>{"node bad: the source is dry"});
  EXPECT_EQ(listener_.ran, (std::set<std::string>{"good", "z"}));
  EXPECT_EQ(listener_.skips, (std::set<std::string>{"y", "e y"}));
  EXPECT_EQ(go(nodes).totals.to_run, 3u) << "what failed is tried again";
}

TEST_F(Run, KeepsWhatAFailedNodeWroteWhereItsMessageSays) {
  const std::string nodes = "<fake_source id='bad' fails='true' amount='7' leaves='true'/>";
  const RunOutcome outcome = go(nodes);
  const fs::path kept = file("failed/nodes/bad");
  EXPECT_EQ(outcome.failures,
            std::vector<std::string>{"node bad: the source is dry\nwhat it wrote until then is in " +
                                     kept.string()});
  EXPECT_EQ(read_file(kept / "data.txt"), "7");
  EXPECT_FALSE(fs::exists(file("nodes/bad")));
  go("<fake_source id='good'/>");
  EXPECT_FALSE(fs::exists(file("failed"))) << "it was of the last run";
}

TEST_F(Run, FailFastStartsNothingAfterAFailure) {
  RunOptions options;
  options.threads = 1;
  options.fail_fast = true;
  const RunOutcome outcome = go("<fake_source id='bad' fails='true'/><fake_source id='good'/>", options);
  EXPECT_EQ(outcome.exit_status(), 1);
  EXPECT_FALSE(outcome.interrupted);
  EXPECT_EQ(outcome.totals.finished, 0u);
}

TEST_F(Run, AnOldResultDoesNotSurviveUnderTheNameOfAFailure) {
  go("<fake_source id='a'/>");
  go("<fake_source id='a' fails='true'/>");
  EXPECT_FALSE(fs::exists(file("nodes/a")));
}

TEST_F(Run, PutsLabelsBeforeTheColumnsAndJoinsAllRows) {
  go("<fake_source id='x' over='s' replicates='2'/><fake_score id='e' of='x'/>", {},
     {sweep("s", "value", {"a", "b"})});
  const Table one = read_table(file("nodes/e/value=b/x/r001/score.csv"));
  EXPECT_EQ(one.columns.front().name, "sweep_value") << "the result has a column 'value' of its own";
  EXPECT_EQ(one.rows.size(), 1u);
  const Table all = read_table(file("nodes/e.csv"));
  ASSERT_EQ(all.rows.size(), 4u);
  EXPECT_EQ(cell_text(all.rows[3][all.column("sweep_value")]), "b");
  EXPECT_EQ(cell_text(all.rows[3][all.column("replicate")]), "1");
}

TEST_F(Run, NoticesFilesThatAreGoneOrDamaged) {
  const std::string nodes = "<fake_source id='x'/><fake_step id='y' from='x'/>";
  go(nodes);
  const auto sound = results();

  fs::remove(file("nodes/x/data.txt"));
  EXPECT_EQ(go(nodes).totals.to_run, 0u) << "the store has it";
  EXPECT_EQ(results(), sound);

  std::string text = read_file(file("nodes/x/data.txt"));
  text[0] = '9';
  fs::permissions(file("nodes/x/data.txt"), fs::perms::owner_write, fs::perm_options::add);
  std::ofstream(file("nodes/x/data.txt")) << text;  // the same size, and the store's copy with it
  EXPECT_EQ(go(nodes).totals.to_run, 1u);
  EXPECT_EQ(results(), sound);

  write_file(file(".coppice/placements"), "nonsense");
  EXPECT_EQ(go(nodes).totals.to_run, 0u);
  EXPECT_EQ(results(), sound);

  fs::remove_all(out_ / "store");
  EXPECT_EQ(go(nodes).totals.to_run, 0u) << "the run folder has all that this experiment needs";
  fs::remove(file("nodes/y/data.txt"));
  EXPECT_EQ(go(nodes).totals.to_run, 1u);
  EXPECT_EQ(results(), sound);
}

TEST_F(Run, TakesWhatOneIdNeedsOnly) {
  RunOptions options;
  options.selection.only = {"y"};
  EXPECT_EQ(go(kChain, options).totals.finished, 6u);
  EXPECT_FALSE(fs::exists(file("tables")));
  EXPECT_EQ(go(kChain).totals.finished, kChainNodes - 6);
  options.selection.only = {"yy"};
  EXPECT_THROW(go(kChain, options), ConfigError);
}

TEST_F(Run, ForcesANodeAndWhatDependsOnIt) {
  go(kChain);
  const auto before = results();
  RunOptions options;
  options.selection.force = {"y"};
  EXPECT_EQ(go(kChain, options).totals.finished, 7u);
  EXPECT_EQ(results(), before);
}

TEST_F(Run, ToForceWhatIsNotSelectedIsAMistake) {
  RunOptions options;
  options.selection = {{"x"}, {"y"}};
  EXPECT_THROW(go(kChain, options), ConfigError);
  options.selection = {{"y"}, {"x"}};  // y needs x
  EXPECT_EQ(go(kChain, options).totals.finished, 6u);
}

TEST_F(Run, TwoRunsInOneFolderAreRefused) {
  RunFolder other(out_ / "test");
  other.lock();
  EXPECT_TRUE(RunFolder(out_ / "test").in_use());
  try {
    go("<fake_source id='x'/>");
    FAIL() << "two runs share a folder";
  } catch (const ConfigError& error) {
    EXPECT_TRUE(contains(error.what(), "another run"));
  }
}

TEST_F(Run, AnOutputFolderThatCannotBeMadeIsTheUsersMistake) {
  std::ofstream(out_) << "a file";
  try {
    go("<fake_source id='x'/>");
    FAIL() << "a file served as a folder";
  } catch (const ConfigError& error) {
    EXPECT_TRUE(contains(error.what(), out_.string()));
  }
}

TEST_F(Run, StopsWithACheckpointAndGoesOnFromIt) {
  struct StopAtFirstTick : RunListener {
    std::atomic<bool> stop{false};
    int interruptions = 0;
    void tick(const std::vector<NodeReport>&, const RunTotals&) override { stop = true; }
    void interrupted(const NodeReport&, const RunTotals&) override { ++interruptions; }
  };
  const std::string nodes = "<fake_worker id='w' units='60' act='wait'/><fake_step id='y' from='w'/>";
  StopAtFirstTick stopper;
  RunOptions options;
  options.listener = &stopper;
  options.stop = &stopper.stop;
  const RunOutcome first = go(nodes, options);
  EXPECT_EQ(first.exit_status(), 3);
  EXPECT_EQ(stopper.interruptions, 1);
  EXPECT_FALSE(fs::exists(file("nodes/w")));
  EXPECT_EQ(go(nodes).exit_status(), 0);
  EXPECT_EQ(read_file(file("nodes/w/data.txt")), "1770\n");
  const Table timing = read_table(file("nodes/w/timing.csv"));
  EXPECT_EQ(number(timing.rows[0][timing.column("units")]), 60) << "both attempts count";
  EXPECT_GE(number(timing.rows[0][timing.column("wall_s")]), 0.6);
  EXPECT_EQ(number(timing.rows[0][timing.column("unit_s")]), 1.5) << "measured by the first";
}

TEST_F(Run, SharesCoresAndKeepsAJournal) {
  go(kChain);
  std::ifstream events(file("events.jsonl"));
  std::size_t finished = 0;
  for (std::string line; std::getline(events, line);) {
    finished += line.find("\"finished\"") != std::string::npos ? 1 : 0;
  }
  EXPECT_EQ(finished, kChainNodes);
}

// As for plans: tests/benchmarks tells how long it takes (of 10 000 nodes, whose first run is too long for
// here); only quadratic growth is caught.
TEST_F(Run, AnUpToDateRunOfManyNodesTakesNoQuadraticTime) {
  const std::string nodes =
      "<fake_source id='x' replicates='1000'/><fake_step id='y' replicates='1000' from='x'/>"
      "<fake_score id='e' of='y'/><fake_report id='t' of='e'/>";
  go(nodes);
  std::vector<Plan> plans;
  plans.push_back(plan(nodes));
  RunOptions options;
  options.out = out_;
  const std::clock_t start = std::clock();
  const RunTotals totals = run(plans, options).totals;
  EXPECT_LT(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC, 1.5);
  EXPECT_EQ(totals.to_run, 0u);
  EXPECT_EQ(totals.up_to_date, 3001u);
}

}  // namespace
}  // namespace coppice::testing
