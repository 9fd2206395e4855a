#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <ostream>

#include "tests/cli/runs.h"

namespace coppice {
namespace {

namespace fs = std::filesystem;

constexpr const char* kChangedConfig = R"(<experiment coppice="1" name="learn" seed="11">
  <arg name="episodes" default="6"/>
  <let name="iterations" value="2"/>
  <sweep id="forests"><grid><param name="trees" values="2, 3"/></grid></sweep>
  <problem id="car"><double_integrator start="uniform"/></problem>
  <policy id="any"><random/></policy>
  <policy id="lqr"><linear_feedback gains="0.687, 1.177"/></policy>
  <dataset id="logged" problem="car" file="logged.csv"/>
  <collect id="samples" problem="car" policy="any" episodes="${episodes}" horizon="20" replicates="2"/>
  <train id="offline" problem="car" samples="logged"><fqi iterations="${iterations}"/></train>
  <train id="learned" over="forests" problem="car" samples="samples" replicates="2">
    <fqi iterations="${iterations}"><q_value><extra_trees trees="${trees}"/></q_value></fqi>
  </train>
  <evaluate id="scores" over="forests" problem="car" policies="learned" episodes="4" horizon="30"/>
  <evaluate id="baseline" problem="car" policies="lqr" episodes="5" horizon="30"/>
  <table id="costs" of="scores" rows="trees" metric="cost"/>
</experiment>
)";
constexpr const char* kLogged =
    "episode,step,s_position,s_speed,action_id,a_acceleration,reward,n_position,n_speed,terminal\n"
    "0,0,1,0,0,0.5,-1.25,1,0.025,0\n0,1,1,0.025,0,-1,-2,1.00125,-0.025,0\n";

const Names kAll = {"logged", "samples", "offline", "learned", "scores", "baseline", "costs"};

/// One change of the config (or of what it reads), and the ids of the nodes that have to run again.
struct Change {
  std::string what;
  std::string from, to;  ///< in the text of the config
  Names rerun;
  std::string arguments = {};  ///< of the command line
};

void PrintTo(const Change& change, std::ostream* out) {
  *out << change.what;
}

class Changes : public RunsInAFolder {
 protected:
  Changes() {
    write(kChangedConfig);
    folder_.write("logged.csv", kLogged);
  }

  void write(const std::string& config) const { folder_.write("learn.xml", config); }

  static std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return at == std::string::npos ? text : text.replace(at, from.size(), to);
  }

  /// Names of the nodes that `why` calls anything but up to date.
  Names explained(const std::string& arguments) const {
    const nlohmann::json plan = nlohmann::json::parse(run("plan --json " + arguments).out);
    Names ids, names;
    for (const nlohmann::json& node : plan.at("experiments")[0].at("nodes")) {
      if (node.at("reason") != "definition") ids.insert(node.at("id"));
    }
    for (const std::string& id : ids) {
      const Ended ended = run("why " + id + " " + arguments);
      EXPECT_EQ(ended.status, 0) << ended.err;
      for (const std::string& line : lines(ended.out)) {
        if (line.starts_with(" ") || line.ends_with(": up to date")) continue;
        names.insert(line.substr(0, line.find(": ")));
      }
    }
    return names;
  }

  /// Plans, explains and runs; all must agree, and nothing may be left to do. Gives what ran.
  Names agreed(const std::string& arguments) const {
    const Names expected = planned(arguments);
    EXPECT_EQ(explained(arguments), expected);
    EXPECT_EQ(executed(arguments), expected);
    EXPECT_EQ(planned(arguments), Names());
    EXPECT_EQ(executed(arguments), Names());
    return expected;
  }

  static Names ids(const Names& names) {
    Names ids;
    for (const std::string& name : names) ids.insert(name.substr(0, name.find(' ')));
    return ids;
  }

  nlohmann::json planned_node(const std::string& name) const {
    const nlohmann::json plan = nlohmann::json::parse(run("plan --json learn.xml").out);
    for (const nlohmann::json& node : plan.at("experiments")[0].at("nodes")) {
      if (node.at("name") == name) return node;
    }
    ADD_FAILURE() << "no node " << name;
    return {};
  }
  /// The stored record of a node.
  fs::path record(const std::string& name) const {
    const std::string key = planned_node(name).at("key");
    return folder_ / ("out/store/results/" + key.substr(0, 2) + "/" + key + ".json");
  }
};

class OneChange : public Changes, public testing::WithParamInterface<Change> {};

TEST_P(OneChange, RerunsWhatDependsOnItAndNothingElse) {
  const Change& change = GetParam();
  EXPECT_EQ(ids(agreed("learn.xml")), kAll);
  const auto before = results(folder_ / "out/learn/nodes");
  write(change.from.empty() ? kChangedConfig : replaced(kChangedConfig, change.from, change.to));
  EXPECT_EQ(ids(agreed("learn.xml " + change.arguments)), change.rerun);
  write(kChangedConfig);  // and back: everything is still in the store
  EXPECT_EQ(agreed("learn.xml"), Names());
  EXPECT_EQ(results(folder_ / "out/learn/nodes"), before);
}

INSTANTIATE_TEST_SUITE_P(
    Changes, OneChange,
    testing::Values(
        Change{"policy parameter", "0.687", "0.7", {"baseline"}},
        Change{"problem parameter", "start=\"uniform\"", "start=\"uniform\" cost=\"p2_v2\"", kAll},
        Change{"parameter of a component in a slot",
               "<extra_trees trees",
               "<extra_trees k=\"1\" trees",
               {"learned", "scores", "costs"}},
        Change{"let", "value=\"2\"", "value=\"3\"", {"offline", "learned", "scores", "costs"}},
        Change{"argument's default",
               "default=\"6\"",
               "default=\"7\"",
               {"samples", "learned", "scores", "costs"}},
        Change{"argument", "", "", {"samples", "learned", "scores", "costs"}, "episodes:=7"},
        Change{"seed of the config",
               "seed=\"11\"",
               "seed=\"12\"",
               {"samples", "offline", "learned", "scores", "baseline", "costs"}},
        Change{"seed", "", "", {"samples", "offline", "learned", "scores", "baseline", "costs"}, "--seed 12"},
        Change{"seed label", "episodes=\"5\"", "episodes=\"5\" seed_label=\"other\"", {"baseline"}},
        Change{"evaluated policies", "policies=\"lqr\"", "policies=\"any\"", {"baseline"}},
        Change{"dataset removed",
               "samples=\"logged\"",
               "samples=\"short\"><fqi/></train>"
               "<collect id=\"short\" problem=\"car\" policy=\"any\" episodes=\"2\"/>"
               "<train id=\"spare\" problem=\"car\" samples=\"short\"",
               {"offline", "short", "spare"}},
        Change{"a node's doc", "id=\"learned\"", "id=\"learned\" doc=\"forests\"", {}},
        Change{"the experiment's doc", "seed=\"11\"", "seed=\"11\" doc=\"forests\"", {}},
        Change{"a default written out", "id=\"samples\"", "id=\"samples\" samples=\"0\"", {}},
        Change{"a number written otherwise", "0.687", "6.87e-1", {}},
        Change{"limits", "id=\"samples\"", "id=\"samples\" time_limit=\"1 h\" memory_limit=\"4 GB\"", {}},
        Change{"a comment", "<arg", "<!-- how many -->\n\n<arg", {}}));

TEST_F(Changes, OfAnInputFile) {
  EXPECT_EQ(ids(agreed("learn.xml")), kAll);
  folder_.write("logged.csv", replaced(kLogged, "0.5,-1.25", "0.25,-1.0625"));
  EXPECT_EQ(ids(agreed("learn.xml")), (Names{"logged", "offline"}));
  EXPECT_TRUE(contains(run("why offline learn.xml").out, "up to date"));
  folder_.write("copy.csv", kLogged);  // the same content, under another name
  write(replaced(kChangedConfig, "logged.csv", "copy.csv"));
  EXPECT_EQ(agreed("learn.xml"), Names());
}

TEST_F(Changes, OfReplicatesAndSweepPointsKeepTheOthers) {
  EXPECT_EQ(ids(agreed("learn.xml")), kAll);
  const auto before = results(folder_ / "out/learn/nodes");
  std::string more = replaced(kChangedConfig, "replicates=\"2\"", "replicates=\"3\"");
  more = replaced(more, "replicates=\"2\"", "replicates=\"3\"");
  write(more);
  EXPECT_EQ(agreed("learn.xml"),
            (Names{"samples r002", "learned trees=2 r002", "learned trees=3 r002",
                   "scores trees=2 learned r002", "scores trees=3 learned r002", "costs"}));
  write(replaced(kChangedConfig, "2, 3", "7, 2, 3"));
  EXPECT_EQ(agreed("learn.xml"),
            (Names{"learned trees=7 r000", "learned trees=7 r001", "scores trees=7 learned r000",
                   "scores trees=7 learned r001", "costs"}));
  const auto after = results(folder_ / "out/learn/nodes");
  for (const auto& [file, bytes] : before) {
    if (file.starts_with("costs") || file.find('/') == std::string::npos) continue;  // over all points
    ASSERT_TRUE(after.contains(file)) << file;
    EXPECT_EQ(after.at(file), bytes) << file;
  }
}

TEST_F(Changes, OfNamesAndOrderRerunNothing) {
  EXPECT_EQ(ids(agreed("learn.xml")), kAll);
  std::string renamed(kChangedConfig);
  for (const auto& [from, to] : {std::pair("id=\"samples\"", "id=\"episodes_of_any\""),
                                 std::pair("samples=\"samples\"", "samples=\"episodes_of_any\""),
                                 std::pair("id=\"lqr\"", "id=\"regulator\""),
                                 std::pair("policies=\"lqr\"", "policies=\"regulator\"")}) {
    renamed = replaced(renamed, from, to);
  }
  write(renamed);
  EXPECT_EQ(agreed("learn.xml"), Names());
  EXPECT_TRUE(fs::exists(folder_ / "out/learn/nodes/episodes_of_any/r001/dataset.csv"));
  EXPECT_FALSE(fs::exists(folder_ / "out/learn/nodes/samples"));

  constexpr std::size_t kHead = 4;  // what is defined before it is used
  std::vector<std::string> rows = lines(kChangedConfig);
  std::vector<std::string> nodes;  // one element of several lines stays whole
  for (std::size_t i = kHead; i + 1 < rows.size(); ++i) {
    if (rows[i].starts_with("    ") || rows[i].starts_with("  </")) {
      nodes.back() += "\n" + rows[i];
    } else {
      nodes.push_back(rows[i]);
    }
  }
  std::reverse(nodes.begin(), nodes.end());
  std::string reversed;
  for (std::size_t i = 0; i < kHead; ++i) reversed += rows[i] + "\n";
  for (const std::string& node : nodes) reversed += node + "\n";
  write(reversed + rows.back() + "\n");
  EXPECT_EQ(agreed("learn.xml"), Names());
}

TEST_F(Changes, ThatRemoveANodeAndPutItBack) {
  EXPECT_EQ(ids(agreed("learn.xml")), kAll);
  write(replaced(kChangedConfig, "<evaluate id=\"baseline\"", "<evaluate if=\"false\" id=\"baseline\""));
  EXPECT_EQ(agreed("learn.xml"), Names());
  EXPECT_FALSE(fs::exists(folder_ / "out/learn/nodes/baseline"));
  write(kChangedConfig);
  EXPECT_EQ(agreed("learn.xml"), Names());
  EXPECT_TRUE(fs::exists(folder_ / "out/learn/nodes/baseline/lqr/evaluation.csv"));
}

TEST_F(Changes, OfTheStoreAreMended) {
  EXPECT_EQ(ids(agreed("learn.xml")), kAll);
  const auto before = results(folder_ / "out/learn/nodes");
  const fs::path samples = record("samples r001"), baseline = record("baseline lqr");
  ASSERT_TRUE(fs::remove(samples));
  EXPECT_EQ(agreed("learn.xml"), Names());  // the run folder still has its files
  fs::remove_all(folder_ / "out/learn/nodes/samples/r001");
  EXPECT_EQ(agreed("learn.xml"), Names{"samples r001"});
  for (const std::uintmax_t size : {std::uintmax_t{0}, fs::file_size(baseline) / 2}) {
    fs::resize_file(baseline, size);
    fs::remove_all(folder_ / "out/learn/nodes/baseline/lqr");
    EXPECT_EQ(agreed("learn.xml"), Names{"baseline lqr"});
  }
  EXPECT_EQ(results(folder_ / "out/learn/nodes"), before);
}

TEST_F(Changes, OfStoredFilesThatLeaveNoTraceAreMendedBeforeTheyAreRead) {
  EXPECT_EQ(ids(agreed("learn.xml")), kAll);
  const auto before = results(folder_ / "out/learn");
  // A digit changes and the date remains, as when a disk loses bits: the text can still be read.
  const auto damage = [&](const std::string& name) {
    const fs::path file = folder_ / "out/learn/nodes" / name;
    const fs::file_time_type date = fs::last_write_time(file);
    const std::string text = TemporaryFolder::read(file);
    const std::size_t digit = text.find_last_of("0123456789");
    ASSERT_NE(digit, text.npos);
    fs::permissions(file, fs::perms::owner_write, fs::perm_options::add);
    std::fstream(file, std::ios::in | std::ios::out | std::ios::binary)
            .seekp(static_cast<std::streamoff>(digit))
        << (text[digit] == '0' ? '1' : '0');
    fs::last_write_time(file, date);
    ASSERT_NE(TemporaryFolder::read(file), text);
  };
  const auto forget = [&](const std::string& name, const std::string& files) {
    ASSERT_TRUE(fs::remove(record(name)));
    ASSERT_EQ(script("rm -r out/learn/" + files).status, 0);
  };
  damage("samples/r001/dataset.csv");  // a link to the store: to be collected again
  EXPECT_EQ(agreed("learn.xml"), Names()) << "nobody reads it";
  forget("learned trees=3 r001", "nodes/learned/trees=3/r001");
  EXPECT_EQ(agreed("learn.xml"), (Names{"samples r001", "learned trees=3 r001"}));
  EXPECT_EQ(results(folder_ / "out/learn"), before);
  damage("scores/trees=2/learned/r000/evaluation.csv");  // with names added: the store has the rest
  forget("costs", "tables/costs.csv");
  EXPECT_EQ(agreed("learn.xml"), Names{"costs"});
  EXPECT_EQ(results(folder_ / "out/learn"), before);
}

TEST_F(Changes, OfStoredFilesAreMended) {
  EXPECT_EQ(ids(agreed("learn.xml")), kAll);
  const auto before = results(folder_ / "out/learn/nodes");
  const std::string file = "out/learn/nodes/learned/trees=3/r001/policy.policy";
  // The file in the run folder and the one in the store are links to the same bytes.
  ASSERT_EQ(
      script("chmod u+w " + file + " && printf X | dd of=" + file + " bs=1 seek=99 conv=notrunc").status, 0);
  EXPECT_EQ(agreed("learn.xml"), Names{"learned trees=3 r001"});
  EXPECT_EQ(results(folder_ / "out/learn/nodes"), before);
  ASSERT_EQ(script("chmod u+w " + file + " && : > " + file).status, 0);
  EXPECT_EQ(agreed("learn.xml"), Names{"learned trees=3 r001"});
  EXPECT_EQ(results(folder_ / "out/learn/nodes"), before);
  ASSERT_EQ(script("rm -r out/learn/nodes/samples " + file).status, 0);  // the store still has them
  EXPECT_EQ(agreed("learn.xml"), Names());
  EXPECT_EQ(results(folder_ / "out/learn/nodes"), before);
  ASSERT_EQ(script("rm -r out/store/objects").status, 0);  // the run folder still has them
  EXPECT_EQ(agreed("learn.xml"), Names());
  ASSERT_EQ(script("rm -r out/learn/nodes").status, 0);
  EXPECT_EQ(ids(agreed("learn.xml")), kAll);
  EXPECT_EQ(results(folder_ / "out/learn/nodes"), before);
}

}  // namespace
}  // namespace coppice
