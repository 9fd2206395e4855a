#include <gtest/gtest.h>

#include <filesystem>

#include "engine/data/table_file.h"
#include "tests/cli/runs.h"

namespace coppice {
namespace {

namespace fs = std::filesystem;

/// A folder with small experiments.
class Runs : public RunsInAFolder {
 protected:
  Runs() {
    folder_.write("small.xml", R"(<experiment coppice="1" seed="3">
  <arg name="episodes" default="5"/>
  <problem id="car"><double_integrator start="uniform"/></problem>
  <policy id="lqr"><linear_feedback gains="0.687, 1.177"/></policy>
  <policy id="random"><random/></policy>
  <collect id="samples" problem="car" policy="random" episodes="${episodes}" replicates="2"/>
  <evaluate id="scores" problem="car" policies="random, lqr" episodes="10"/>
  <table id="costs" of="scores" rows="policy" metric="cost"/>
</experiment>
)");
    folder_.write("failing.xml", R"(<experiment coppice="1" seed="3">
  <problem id="car"><double_integrator/></problem>
  <policy id="random"><random/></policy>
  <evaluate id="endless" problem="car" policies="random" episodes="50000000" time_limit="0.05 s"/>
  <table id="of_endless" of="endless" rows="policy" metric="cost"/>
  <evaluate id="fine" problem="car" policies="random" episodes="10" seed_label="fine"/>
</experiment>
)");
    folder_.write("long.xml", R"(<experiment coppice="1" seed="3">
  <arg name="episodes" default="100000"/>
  <problem id="car"><double_integrator start="uniform"/></problem>
  <policy id="lqr"><linear_feedback gains="0.687, 1.177"/></policy>
  <evaluate id="scores" problem="car" policies="lqr" episodes="${episodes}" returns="false"/>
</experiment>
)");
  }
};

TEST_F(Runs, WriteTablesAndNameThemOnStdout) {
  const Ended ended = run("small.xml");
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(ended.out, "out/small/tables/costs.csv\nout/small/report.html\n");
  EXPECT_TRUE(contains(ended.err, "done: ")) << ended.err;
  const std::string table = TemporaryFolder::read(folder_ / "out/small/tables/costs.csv");
  EXPECT_TRUE(contains(table, "lqr")) << table;
  for (const std::string name : {"resolved.xml", "provenance.json", "events.jsonl"}) {
    EXPECT_TRUE(fs::exists(folder_ / "out/small" / name)) << name;
  }
}

TEST_F(Runs, DescribeTheColumnsOfEveryTable) {
  ASSERT_EQ(run("small.xml").status, 0);
  std::size_t tables = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder_ / "out/small")) {
    if (entry.path().extension() != ".csv") continue;
    ++tables;
    fs::path schema = entry.path();
    ASSERT_TRUE(fs::exists(schema.replace_extension(".schema.json"))) << entry.path();
    std::string header;
    const nlohmann::json described = nlohmann::json::parse(TemporaryFolder::read(schema));
    for (const nlohmann::json& column : described.at("columns")) {
      header += (header.empty() ? "" : ",") + column.at("name").get<std::string>();
      EXPECT_NE(column.at("doc"), "") << schema << " " << header;
    }
    EXPECT_EQ(lines(TemporaryFolder::read(entry.path())).at(0), header) << entry.path();
  }
  EXPECT_EQ(tables, 2 + 2 * 2 + 2 * 3 + 1U) << "tables, samples, scores, timing of the table";
  const std::string timing = "out/small/nodes/scores/lqr/timing.csv";
  EXPECT_EQ(lines(TemporaryFolder::read(folder_ / timing))[0],
            "wall_s,cpu_s,episodes,steps,episodes_per_s,steps_per_s,action_s,episode_s");
  EXPECT_TRUE(fs::exists(folder_ / "out/small/nodes/costs/timing.schema.json"));
  EXPECT_FALSE(contains(TemporaryFolder::read(folder_ / "out/small/tables/costs.schema.json"), "wall_s"));
}

TEST_F(Runs, LeaveReadOnlyFiles) {
  ASSERT_EQ(run("small.xml").status, 0);
  for (const char* part : {"nodes", "tables"}) {
    for (const auto& entry : fs::recursive_directory_iterator(folder_ / "out/small" / part)) {
      if (!entry.is_regular_file()) continue;
      EXPECT_EQ(entry.status().permissions() & static_cast<fs::perms>(0222), fs::perms::none) << entry.path();
    }
  }
  EXPECT_EQ(run("small.xml --force samples").status, 0) << "they can be made again";
  EXPECT_EQ(run("small.xml episodes:=6").status, 0);
}

TEST_F(Runs, AreUpToDateTheSecondTime) {
  ASSERT_EQ(run("small.xml").status, 0);
  const Ended again = run("run small.xml");
  EXPECT_EQ(again.status, 0);
  EXPECT_EQ(again.err, "everything is up to date: 5 nodes\n");
  EXPECT_EQ(again.out, "out/small/tables/costs.csv\nout/small/report.html\n");
}

TEST_F(Runs, ShowThemselvesOnAPage) {
  ASSERT_EQ(run("small.xml").status, 0);
  const fs::path file = folder_ / "out/small/report.html";
  const std::string page = TemporaryFolder::read(file);
  for (const std::string part : {"<h1>small</h1>", "seed 3 · done", "5 nodes: 5 done", ">lqr</th>",
                                 "CPU time (s)", "runner small.xml"}) {
    EXPECT_TRUE(contains(page, part)) << part;
  }
  fs::remove(file);
  EXPECT_EQ(run("report").out, "out/small/report.html\n");
  EXPECT_EQ(TemporaryFolder::read(file), page);
  fs::remove(file);
  EXPECT_EQ(run("report out/small").status, 0);
  EXPECT_EQ(TemporaryFolder::read(file), page);
  fs::remove(file);
  ASSERT_EQ(run("small.xml").status, 0);
  EXPECT_TRUE(fs::exists(file)) << "a missing page is something to do";
  EXPECT_EQ(run("report nowhere").status, 2);
}

TEST_F(Runs, ShowFailuresOnThePageToo) {
  EXPECT_EQ(run("failing.xml").status, 1);
  const std::string page = TemporaryFolder::read(folder_ / "out/failing/report.html");
  for (const std::string part : {"3 nodes: 1 done, 1 failed, 1 missing.", "<pre>", "time_limit"}) {
    EXPECT_TRUE(contains(page, part)) << part;
  }
}

TEST_F(Runs, DoWhatThePlanSays) {
  for (const std::string arguments :
       {"small.xml --only samples", "small.xml", "small.xml", "small.xml episodes:=6",
        "small.xml --force scores", "small.xml --seed 4", "small.xml --seed 4 --only scores"}) {
    SCOPED_TRACE(arguments);
    const Names expected = planned(arguments);
    EXPECT_EQ(executed(arguments), expected);
  }
}

TEST_F(Runs, RunOnlyWhatDependsOnAChange) {
  ASSERT_EQ(run("small.xml").status, 0);
  const Names names = planned("small.xml episodes:=6");
  EXPECT_EQ(names.size(), 2U);
  for (const std::string& name : names) EXPECT_TRUE(name.starts_with("samples")) << name;
  const Ended text = run("plan small.xml episodes:=6");
  EXPECT_TRUE(contains(text.out, "small: 2 of 5 nodes to run")) << text.out;
  EXPECT_TRUE(contains(text.out, "5 -> 6")) << text.out;
  const Ended why = run("why samples small.xml episodes:=6");
  EXPECT_EQ(why.status, 0) << why.err;
  EXPECT_TRUE(contains(why.out, "5 -> 6")) << why.out;
  EXPECT_TRUE(contains(run("why samples").out, "up to date"));
}

TEST_F(Runs, GiveTheSameBytesWhateverTheThreadsAndTheFolder) {
  ASSERT_EQ(run("small.xml -j 1 --out one").status, 0);
  ASSERT_EQ(run("small.xml -j 2 --out two").status, 0);
  const auto one = results(folder_ / "one/small");
  EXPECT_GE(one.size(), 8U);
  EXPECT_EQ(one, results(folder_ / "two/small"));
}

TEST_F(Runs, ShowFailuresAndFinishTheRest) {
  const Ended ended = run("failing.xml");
  EXPECT_EQ(ended.status, 1);
  EXPECT_TRUE(contains(ended.err, "failed: failing endless")) << ended.err;
  EXPECT_TRUE(contains(ended.err, "time_limit")) << ended.err;
  EXPECT_TRUE(contains(ended.err, "1 skipped because an input failed")) << ended.err;
  EXPECT_TRUE(fs::exists(folder_ / "out/failing/nodes/fine.csv"));
  const Ended status = run("status");
  EXPECT_EQ(status.status, 0);
  EXPECT_TRUE(contains(status.out, "failed")) << status.out;
  EXPECT_TRUE(contains(status.out, "time_limit")) << status.out;
}

/// What a node without a limit wants is made, although another node that wants the same has one.
TEST_F(Runs, LimitNoNodeBySharingItsResult) {
  folder_.write("shared.xml", R"(<experiment coppice="1" name="shared">
  <problem id="car"><car_on_the_hill/></problem>
  <policy id="random"><random/></policy>
  <evaluate id="short" problem="car" policies="random" episodes="3000" time_limit="1 ms" memory_limit="1 MB"/>
  <evaluate id="free" problem="car" policies="random" episodes="3000"/>
  <table id="t" of="free"/>
</experiment>)");
  const Ended ended = run("shared.xml");
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(run("shared.xml").status, 0);
}

TEST_F(Runs, NameFilesAfterTheLongestIdsAndValues) {
  const std::string id(100, 'i');
  const std::string value(200, 'v');
  folder_.write("names.xml", R"(<experiment coppice="1" seed="3">
  <problem id="car"><double_integrator/></problem>
  <policy id="p)" + id.substr(1) +
                                 R"("><random/></policy>
  <sweep id="s"><grid><param name="label" values=")" +
                                 value + ", w" + value + R"("/></grid></sweep>
  <evaluate id="e)" + id.substr(1) +
                                 R"(" over="s" problem="car" policies="p)" + id.substr(1) +
                                 R"(" episodes="3" seed_label="${label}"/>
  <table id="t)" + id.substr(1) + R"(" over="s" of="e)" +
                                 id.substr(1) + R"(" rows="policy" metric="cost"/>
</experiment>
)");
  const Ended ended = run("names.xml");
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(lines(ended.out).size(), 3U) << ended.out;  // two tables, and the report
  for (const std::string& file : lines(ended.out)) EXPECT_TRUE(fs::exists(folder_ / file)) << file;
  EXPECT_TRUE(contains(run("names.xml").err, "up to date"));
}

TEST_F(Runs, TellTheirBeginningAndEndAlsoWhenThereIsNothingToDo) {
  ASSERT_EQ(run("small.xml").status, 0);
  const std::vector<std::string> events = lines(run("small.xml --progress json").err);
  ASSERT_EQ(events.size(), 2U);
  EXPECT_TRUE(contains(events[0], "\"event\":\"begin\"")) << events[0];
  EXPECT_TRUE(contains(events[0], "\"to_run\":0")) << events[0];
  EXPECT_TRUE(contains(events[1], "\"event\":\"end\"")) << events[1];
}

TEST_F(Runs, StopWhenToldToAndGoOnLater) {
  ASSERT_EQ(run("long.xml -j 1 --out whole").status, 0);
  const Ended ended = script(
      "$RUNNER long.xml -j 1 --progress json 2> log > paths & pid=$!\n"
      "until grep -q started log; do sleep 0.02; done\n"
      "kill -INT $pid; wait $pid; echo status $?");
  EXPECT_EQ(ended.out, "status 3\n") << ended.err;
  const Ended again = run("long.xml -j 1");
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(results(folder_ / "out/long"), results(folder_ / "whole/long"));
}

TEST_F(Runs, StopAtOnceTheSecondTime) {
  const Ended ended = script(
      "$RUNNER long.xml episodes:=50000000 --progress json 2> log > paths & pid=$!\n"
      "until grep -q started log; do sleep 0.02; done\n"
      "kill -INT $pid; kill -INT $pid; wait $pid; echo status $?");
  EXPECT_EQ(ended.out, "status 3\n") << ended.err;
}

TEST_F(Runs, ExcludeEachOtherFromAFolder) {
  const Ended ended = script(
      "$RUNNER long.xml episodes:=50000000 --progress json 2> log & pid=$!\n"
      "until grep -q started log; do sleep 0.02; done\n"
      "runner long.xml; echo status $?; kill -INT $pid; wait $pid");
  EXPECT_TRUE(contains(ended.out, "status 2\n")) << ended.out;
  EXPECT_TRUE(contains(ended.err, "out/long")) << ended.err;
}

TEST_F(Runs, RefuseOutputFoldersThatCannotBeWritten) {
  folder_.write("file", "");
  for (const std::string out : {"file", "file/below", "/proc/nowhere"}) {
    const Ended ended = run("small.xml --out " + out);
    EXPECT_EQ(ended.status, 2) << out << "\n" << ended.err;
    EXPECT_TRUE(contains(ended.err, out)) << ended.err;
  }
}

TEST_F(Runs, KeepControlCodesOutOfPipes) {
  const Ended ended = run("small.xml --progress plain");
  EXPECT_EQ(ended.status, 0);
  EXPECT_FALSE(contains(ended.err, "\x1b"));
  EXPECT_FALSE(contains(ended.err, "\r"));
  EXPECT_TRUE(contains(ended.err, "[5/5] small ")) << ended.err;
  EXPECT_EQ(lines(ended.err).size(), 6U) << ended.err;  // a line per node, and the summary
  EXPECT_EQ(run("small.xml --seed 9 --progress none").err, "");
}

TEST_F(Runs, TakeSeveralConfigs) {
  EXPECT_EQ(run("small.xml long.xml episodes:=7").status, 0);
  EXPECT_TRUE(fs::exists(folder_ / "out/small/nodes/scores.csv"));
  EXPECT_TRUE(fs::exists(folder_ / "out/long/nodes/scores.csv"));
  const Ended ended = run("small.xml small.xml");
  EXPECT_EQ(ended.status, 2);
  EXPECT_TRUE(contains(ended.err, "small")) << ended.err;
}

TEST_F(Runs, SweepAnArgumentGivenSeveralValues) {
  EXPECT_EQ(planned("small.xml episodes:=5,6 --only samples").size(), 4U);
}

TEST_F(Runs, NameTheTablesOfEverySweepPoint) {
  const Ended ended = run("small.xml episodes:=5,6");
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(ended.out,
            "out/small/tables/costs.episodes=5.csv\nout/small/tables/costs.episodes=6.csv\n"
            "out/small/report.html\n");
  for (const std::string& file : lines(ended.out)) EXPECT_TRUE(fs::exists(folder_ / file)) << file;
}

TEST_F(Runs, TakeATrainingRunAsUnitUnlessNothingWasLearned) {
  folder_.write("learned.xml", R"(<experiment coppice="1" seed="3">
  <problem id="car"><double_integrator start="uniform"/></problem>
  <policy id="random"><random/></policy>
  <collect id="samples" problem="car" policy="random" episodes="5"/>
  <train id="fpf" problem="car" samples="samples">
    <fpf model_samples="100" target_min="-5" policy_samples="100">
      <q_value><extra_trees leaves="pwl"/></q_value>
      <policy><extra_trees leaves="pwl"/></policy>
    </fpf>
  </train>
  <select id="taken" problem="car" policies="fpf, random" episodes="5"/>
  <evaluate id="scores" problem="car" policies="fpf, taken, random" episodes="30"/>
  <table id="costs" of="scores" rows="policy"/>
</experiment>
)");
  ASSERT_EQ(run("learned.xml").status, 0);
  folder_.write("saved.xml", R"(<experiment coppice="1" seed="3">
  <problem id="car"><double_integrator start="uniform"/></problem>
  <policy id="saved" file="out/learned/nodes/fpf/policy.policy"/>
  <evaluate id="scores" problem="car" policies="saved" episodes="30" replicates="2"/>
  <table id="costs" of="scores" rows="policy"/>
</experiment>
)");
  const Ended ended = run("saved.xml");
  ASSERT_EQ(ended.status, 0) << ended.err;
  const auto interval = [&](const std::string& experiment, std::size_t row) {
    const Table table = read_table(folder_ / "out" / experiment / "tables/costs.csv");
    EXPECT_EQ(number(table.rows.at(row).at(table.column("n_replicates"))), 1);
    return cell_text(table.rows.at(row).at(table.column("ci95_low")));
  };
  EXPECT_EQ(interval("learned", 0), "") << "trained";
  EXPECT_EQ(interval("learned", 1), "") << "selected";
  EXPECT_NE(interval("learned", 2), "") << "not learned: over episodes";
  EXPECT_EQ(interval("saved", 0), "") << "from a file, one training run however often it is evaluated";
}

TEST_F(Runs, LeaveNothingToCollectUntilResultsAreReplaced) {
  ASSERT_EQ(run("small.xml").status, 0);
  EXPECT_TRUE(contains(run("gc --dry-run").err, "would remove 0 results"));
  ASSERT_EQ(run("small.xml episodes:=6").status, 0);
  EXPECT_TRUE(contains(run("gc").err, "removed 2 results"));
  EXPECT_TRUE(contains(run("small.xml episodes:=6").err, "everything is up to date"));
}

TEST_F(Runs, DrawTheirGraph) {
  const Ended ended = run("plan small.xml --dot");
  EXPECT_EQ(ended.status, 0);
  EXPECT_TRUE(contains(ended.out, "digraph \"small\""));
  EXPECT_TRUE(contains(ended.out, "\"scores\" -> \"costs\";"));
  EXPECT_EQ(
      script("command -v dot > /dev/null || exit 0; runner plan small.xml --dot | dot -Tsvg > graph.svg")
          .status,
      0);
}

}  // namespace
}  // namespace coppice
