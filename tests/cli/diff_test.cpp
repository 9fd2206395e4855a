#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "tests/cli/process.h"

namespace coppice {
namespace {

namespace fs = std::filesystem;

/// Two runs of an experiment, with other seeds.
class Diff : public testing::Test {
 protected:
  Diff() {
    folder_.write("small.xml", R"(<experiment coppice="1" seed="3">
  <arg name="policies" default="random, lqr"/>
  <problem id="car"><double_integrator start="uniform"/></problem>
  <policy id="lqr"><linear_feedback gains="0.687, 1.177"/></policy>
  <policy id="random"><random/></policy>
  <evaluate id="scores" problem="car" policies="${policies}" episodes="10"/>
  <table id="costs" of="scores" rows="policy" metric="cost"/>
</experiment>
)");
    EXPECT_EQ(run("small.xml --out one").status, 0);
    EXPECT_EQ(run("small.xml --out two --seed 4").status, 0);
  }
  Ended run(const std::string& arguments) const { return runner(arguments, folder_.path()); }

  TemporaryFolder folder_;
};

TEST_F(Diff, FindsNothingBetweenEqualRuns) {
  ASSERT_EQ(run("small.xml --out again -j 1").status, 0);
  const Ended ended = run("diff one again");
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(ended.out, "small: 12 result files, all equal\n");
}

TEST_F(Diff, SaysWhichRowsDifferAndByHowMuch) {
  const Ended ended = run("diff one/small two");
  EXPECT_EQ(ended.status, 1) << ended.err;
  EXPECT_TRUE(contains(ended.out, "tables/costs.csv: 2 of 2 rows differ\n")) << ended.out;
  EXPECT_TRUE(contains(ended.out, "; parameters differ, see resolved.xml\n")) << ended.out;
  const std::vector<std::string> shown = lines(ended.out);
  ASSERT_GE(shown.size(), 4U);
  for (const std::size_t row : {2U, 3U}) {  // three means, each with its interval
    EXPECT_EQ(std::count(shown[row].begin(), shown[row].end(), '['), 3) << shown[row];
  }
  EXPECT_TRUE(contains(run("diff one two --files").out, "nodes/scores.csv differs\n"));
}

TEST_F(Diff, SaysWhichRowsAndExperimentsOneRunHasNot) {
  ASSERT_EQ(run("small.xml --out two policies:=lqr").status, 0);
  const Ended ended = run("diff one two");
  EXPECT_EQ(ended.status, 1);
  EXPECT_TRUE(contains(ended.out, "tables/costs.csv: 1 of 2 rows differ\n")) << ended.out;
  EXPECT_TRUE(contains(ended.out, "no such row")) << ended.out;
  fs::copy(folder_ / "small.xml", folder_ / "other.xml");
  ASSERT_EQ(run("other.xml --out two").status, 0);
  EXPECT_TRUE(contains(run("diff one two").out, "other: only in two\n"));
  EXPECT_TRUE(contains(run("diff two one").out, "other: only in two\n"));
  const Ended renamed = run("diff one two/other");
  EXPECT_EQ(renamed.status, 0) << "one experiment under two names";
  EXPECT_EQ(renamed.out, "small: 12 result files, all equal\n");
}

TEST_F(Diff, NoticesAChangedByte) {
  ASSERT_EQ(run("small.xml --out again").status, 0);
  const fs::path file = folder_ / "again/small/nodes/scores.csv";
  const std::string text = TemporaryFolder::read(file);
  fs::remove(file);
  folder_.write("again/small/nodes/scores.csv", text.substr(0, text.size() - 1) + ' ');
  const Ended ended = run("diff one again");
  EXPECT_EQ(ended.status, 1);
  EXPECT_EQ(ended.out, "small: 1 of 12 result files differ\n");
}

TEST_F(Diff, ComparesFiguresExceptThoseOfTimes) {
  const std::string xml = TemporaryFolder::read(folder_ / "small.xml");
  const std::size_t end = xml.find("</experiment>");
  folder_.write("small.xml", xml.substr(0, end) +
                                 R"(<figure id="spread" of="scores" kind="interval" by="policy"/>
  <timings id="speed" of="scores" rows="policy"/></experiment>)");
  ASSERT_EQ(run("small.xml --out one").status, 0);
  ASSERT_EQ(run("small.xml --out again -j 1").status, 0);
  const Ended same = run("diff one again");  // 12 and spread's three, and what speed's columns are
  EXPECT_EQ(same.out, "small: 16 result files, all equal\n");
  ASSERT_EQ(run("small.xml --out again --seed 4").status, 0);
  const std::string differing = run("diff one again --files").out;
  EXPECT_TRUE(contains(differing, "figures/spread.csv differs\n")) << differing;
  EXPECT_TRUE(contains(differing, "figures/spread.vl.json differs\n")) << differing;
  EXPECT_FALSE(contains(differing, "figures/speed")) << differing;
}

TEST_F(Diff, SaysWhatIsDamaged) {
  ASSERT_EQ(run("small.xml --out broken").status, 0);
  const auto damage = [&](const std::string& file, const std::string& text) {
    fs::remove(folder_ / "broken/small" / file);
    folder_.write("broken/small/" + file, text);
  };
  const auto refused = [&](const std::string& command, const std::string& message) {
    const Ended ended = run(command);
    EXPECT_EQ(ended.status, 2) << command;
    EXPECT_TRUE(contains(ended.err, message)) << command << "\n" << ended.err;
    EXPECT_LE(lines(ended.err).size(), 4U) << ended.err;
  };
  for (const std::string record : {"[", "{\"command\": 5}"}) {
    damage("provenance.json", record);
    refused("why costs --out broken", "no provenance.json in 'broken' says which configs were run");
  }
  fs::remove(folder_ / "broken/small/provenance.json");
  refused("why costs --out broken", "no provenance.json in 'broken' says which configs were run");
  EXPECT_EQ(run("report broken").status, 0) << "the page then does without";
  EXPECT_EQ(run("status broken").status, 0);
  damage("tables/costs.csv", "policy,mean\nlqr\n");
  refused("diff one broken", "broken/small/tables/costs.csv:2:1: error: ");
  damage("resolved.xml", "<experiment coppice=");
  for (const std::string command : {"status broken", "report broken", "diff one broken"})
    refused(command, "broken/small/resolved.xml:1:");
  damage("resolved.xml", "");
  for (const std::string command : {"status broken", "report broken", "diff one broken"})
    refused(command, "broken/small/resolved.xml");
}

TEST_F(Diff, RefusesFoldersWithoutRuns) {
  EXPECT_EQ(run("diff one nowhere").status, 2);
  EXPECT_EQ(run("diff one").status, 2);
}

TEST(Doctor, FindsThisMachineFit) {
  const TemporaryFolder folder;
  const Ended ended = runner("doctor", folder.path());
  EXPECT_EQ(ended.status, 0) << ended.out;
  EXPECT_TRUE(contains(ended.out, "numbers        as on every machine\n")) << ended.out;
  EXPECT_TRUE(contains(ended.out, "out can be written, ")) << ended.out;
  EXPECT_TRUE(fs::is_empty(folder.path())) << "it leaves nothing behind";
}

TEST(Doctor, SaysWhatIsWrong) {
  const Ended ended = runner("doctor --out /proc/nowhere");
  EXPECT_EQ(ended.status, 1) << ended.out;
  EXPECT_TRUE(contains(ended.out, "BAD  results ")) << ended.out;
}

}  // namespace
}  // namespace coppice
