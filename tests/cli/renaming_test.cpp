#include <gtest/gtest.h>

#include <algorithm>

#include "tests/cli/runs.h"

namespace coppice {
namespace {

// Every kind of node, each id unlike any other text. Renamed, they stand in the opposite alphabetical order.
constexpr const char* kRenamedConfig = R"(<experiment coppice="1" name="renamed" seed="5">
  <sweep id="sizes"><grid><param name="trees" values="2, 3"/></grid></sweep>
  <problem id="a_car"><double_integrator start="uniform"/></problem>
  <policy id="b_any"><random/></policy>
  <policy id="c_lqr" problem="a_car"><linear_feedback gains="0.687, 1.177"/></policy>
  <policy id="d_old" file="old.policy"/>
  <dataset id="e_log" problem="a_car" file="logged.csv"/>
  <collect id="f_seen" problem="a_car" policy="b_any" episodes="6" horizon="20" replicates="2"/>
  <fit id="g_fit" samples="e_log" inputs="s_position" output="reward"><linear/></fit>
  <train id="h_tree" over="sizes" problem="a_car" samples="f_seen, e_log">
    <fqi iterations="2"><q_value><extra_trees trees="${trees}"/></q_value></fqi>
  </train>
  <select id="i_best" problem="a_car" policies="c_lqr, h_tree, d_old" episodes="4" horizon="20"/>
  <collect id="j_more" problem="a_car" policy="i_best" episodes="3" horizon="20" seed_label="more"/>
  <train id="k_next" problem="a_car" samples="j_more"><fqi iterations="1"/></train>
  <evaluate id="l_test" problem="a_car" policies="b_any, h_tree, i_best, p_tune" episodes="4" horizon="20"/>
  <table id="m_all" of="l_test" rows="policy, trees" metric="cost"/>
  <compare id="n_pair" of="l_test" by="policy, trees" metric="return"/>
  <figure id="o_line" of="h_tree" by="trees" y="mean_target"/>
  <optimize id="p_tune" problem="a_car" policy="c_lqr" parameters="gains" low="0" high="3" budget="20" horizon="20">
    <cross_entropy/>
  </optimize>
  <predict id="q_said" function="g_fit" samples="e_log"/>
  <sample id="r_drawn" samples="20"><sine/></sample>
  <export id="s_ship" policy="p_tune" to="cpp"/>
  <timings id="timing_p" of="l_test" rows="policy, trees"/>
  <objective id="t_bowl"><sphere n="2"/></objective>
  <optimize id="u_found" objective="t_bowl" budget="40" low="-5" high="5" replicates="2"><cross_entropy/></optimize>
  <runtimes id="v_when" of="u_found" rows="objective" targets="1"/>
  <gaps id="w_near" of="u_found" rows="objective"/>
  <iohprofiler id="x_log" of="u_found"/>
</experiment>
)";
constexpr const char* kRows =
    "episode,step,s_position,s_speed,action_id,a_acceleration,reward,n_position,n_speed,terminal\n"
    "0,0,1,0,0,0.5,-1.25,1,0.025,0\n0,1,0.5,0.025,0,-1,-2,1.00125,-0.025,0\n";
const std::vector<std::string> kIds = {"a_car",  "b_any",  "c_lqr",  "d_old",   "e_log",  "f_seen", "g_fit",
                                       "h_tree", "i_best", "j_more", "k_next",  "l_test", "m_all",  "n_pair",
                                       "o_line", "p_tune", "q_said", "r_drawn", "s_ship", "t_bowl", "u_found",
                                       "v_when", "w_near", "x_log",  "timing_p"};

std::string replaced_all(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

/// The text with every id under its other name, which is as long.
std::string renamed(std::string text) {
  for (const std::string& id : kIds) {
    const bool times = id.starts_with("timing");  // such files are left out of the results
    std::string other = id;
    other[times ? 7 : 0] = static_cast<char>('z' - (id[times ? 7 : 0] - 'a'));
    text = replaced_all(std::move(text), id, other);
  }
  return text;
}

class Renaming : public RunsInAFolder {
 protected:
  Renaming() {
    folder_.write("logged.csv", kRows);
    folder_.write("old.xml",
                  R"(<experiment coppice="1" name="old"><problem id="car"><double_integrator/></problem>)"
                  R"(<policy id="p" problem="car"><linear_feedback gains="1, 1"/></policy></experiment>)");
    folder_.write("renamed.xml", kRenamedConfig);
    const Ended made =
        script("runner run old.xml --progress none && cp out/old/nodes/p/policy.policy old.policy");
    EXPECT_EQ(made.status, 0) << made.err;
  }
};

TEST_F(Renaming, CoversEveryKindOfNode) {
  const Ended listed = run("list node");
  ASSERT_EQ(listed.status, 0) << listed.err;
  std::size_t kinds = 0;
  for (const std::string& line : lines(listed.out)) {
    const std::string kind = line.substr(0, line.find(' '));
    if (kind.empty()) continue;
    ++kinds;
    EXPECT_TRUE(contains(kRenamedConfig, "<" + kind + " id=")) << "the config above has no <" << kind << ">";
  }
  EXPECT_GE(kinds, 12U);
}

TEST_F(Renaming, OfEveryNodeChangesNoByteButTheNamesInTables) {
  EXPECT_GE(executed("renamed.xml").size(), 19U);
  std::map<std::string, std::string> expected;
  for (const auto& [file, bytes] : results(folder_ / "out/renamed")) expected[renamed(file)] = renamed(bytes);
  EXPECT_EQ(std::count_if(expected.begin(), expected.end(),
                          [](const auto& file) { return file.first.ends_with(".policy"); }),
            7);
  const std::string config = renamed(kRenamedConfig);
  ASSERT_FALSE(contains(config, "i_best"));
  folder_.write("renamed.xml", config);
  // Only what shows names is made again: nothing depends on it.
  EXPECT_EQ(executed("renamed.xml"),
            (Names{renamed("m_all"), renamed("n_pair"), renamed("o_line"), renamed("timing_p"),
                   renamed("v_when"), renamed("w_near"), renamed("x_log")}));
  EXPECT_EQ(results(folder_ / "out/renamed"), expected);
  EXPECT_EQ(executed("renamed.xml --out elsewhere").size(), executed("renamed.xml --out third").size());
  EXPECT_EQ(results(folder_ / "elsewhere/renamed"), expected);
}

TEST_F(Renaming, LeavesCandidatesNamedAsTheyAreCalledNow) {
  executed("renamed.xml");
  const auto selection = [&](const std::string& id) {
    return lines(TemporaryFolder::read(folder_ / ("out/renamed/nodes/" + id + "/selection.csv")));
  };
  const std::vector<std::string> before = selection("i_best");
  ASSERT_EQ(before.size(), 5U);
  EXPECT_TRUE(before[0].starts_with("trees,problem,policy,replicate,episodes,mean_return,")) << before[0];
  EXPECT_TRUE(before[1].starts_with(",a_car,c_lqr,,4,")) << before[1];
  EXPECT_TRUE(before[2].starts_with("2,a_car,h_tree,,4,")) << before[2];
  EXPECT_TRUE(before[4].starts_with(",,d_old,,4,")) << before[4];
  folder_.write("renamed.xml", replaced_all(kRenamedConfig, "c_lqr", "feedback"));
  executed("renamed.xml");
  EXPECT_TRUE(selection("i_best")[1].starts_with(",a_car,feedback,,4,")) << selection("i_best")[1];
}

}  // namespace
}  // namespace coppice
