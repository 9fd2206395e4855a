#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "engine/graph/artifacts.h"
#include "tests/cli/process.h"

namespace coppice {
namespace {

namespace fs = std::filesystem;

/// A folder with the file of the policy u = -(0.687 p + 1.177 v) for the double integrator.
class PolicyFiles : public testing::Test {
 protected:
  PolicyFiles() {
    Element element;
    element.name = "linear_feedback";
    element.set("gains", "0.687, 1.177");
    Element problem;
    problem.name = "double_integrator";
    Diagnostics diagnostics;
    PolicyFile content;
    content.writer = "test";
    content.provenance = "0123456789abcdef";
    content.spaces = make<Problem>(problem, diagnostics).object->spaces();
    content.component = make<Policy>(element, diagnostics).resolved;
    diagnostics.throw_if_any();
    write_policy_file(folder_ / "lqr.policy", content);
    content.spaces = {};
    write_policy_file(folder_ / "free.policy", content);
  }

  Ended act(const std::string& csv, const std::string& arguments = "lqr.policy") const {
    return runner("policy act " + arguments, folder_.path(), csv);
  }

  TemporaryFolder folder_;
};

TEST_F(PolicyFiles, InfoShowsWhatTheFileHolds) {
  const Ended text = runner("policy info lqr.policy", folder_.path());
  EXPECT_EQ(text.status, 0) << text.err;
  EXPECT_EQ(text.err, "");
  for (const std::string part : {"linear_feedback", "test", "0123456789abcdef", "position", "m/s", "us"}) {
    EXPECT_TRUE(contains(text.out, part)) << part << " not in\n" << text.out;
  }
  const nlohmann::json json =
      nlohmann::json::parse(runner("policy info lqr.policy --json", folder_.path()).out);
  EXPECT_EQ(json.at("component"), "linear_feedback");
  EXPECT_EQ(json.at("states").size(), 2U);
  EXPECT_EQ(json.at("states")[0].at("name"), "position");
  EXPECT_EQ(json.at("bytes"), fs::file_size(folder_ / "lqr.policy"));
  EXPECT_GT(json.at("action_s").get<double>(), 0);
  EXPECT_LT(json.at("action_s").get<double>(), 1e-3);
  EXPECT_LE(json.at("action_s"), json.at("action_p99_s"));
  EXPECT_EQ(json.at("importance").size(), 2U);
}

// a = -(g1 p + g2 v), clipped to [-1, 1]; with small gains nothing is clipped, and the shares of the variance
// of p and v, both uniform in [-1, 1], are those of the squared gains.
TEST_F(PolicyFiles, InfoShowsWhichInputsMatter) {
  const auto importance = [&](const std::string& gains) {
    Element element;
    element.name = "linear_feedback";
    element.set("gains", gains);
    Diagnostics diagnostics;
    PolicyFile content = read_policy_file(folder_ / "lqr.policy");
    content.component = make<Policy>(element, diagnostics).resolved;
    diagnostics.throw_if_any();
    write_policy_file(folder_ / "gains.policy", content);
    return nlohmann::json::parse(runner("policy info gains.policy --json", folder_.path()).out)
        .at("importance");
  };
  const nlohmann::json both = importance("0.4, 0.3");
  EXPECT_NEAR(both.at("position").get<double>(), 0.64, 0.04);
  EXPECT_NEAR(both.at("speed").get<double>(), 0.36, 0.03);
  EXPECT_EQ(importance("0.4, 0").at("speed"), 0);
  EXPECT_NEAR(importance("0.4, 0").at("position").get<double>(), 1, 1e-12);
  EXPECT_TRUE(importance("0, 0").empty()) << "a constant";
}

TEST_F(PolicyFiles, ActTakesAByteOrderMark) {
  const std::string csv = "s_position,s_speed\n1,0\n";
  const Ended ended = act("\xEF\xBB\xBF" + csv);
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(ended.out, act(csv).out);
  const Ended late = act(csv + "\xEF\xBB\xBF" + "1,0\n");
  EXPECT_EQ(late.status, 2) << "only at the start is it none of the text";
  EXPECT_TRUE(contains(act("\xEF\xBB\xBF").err, "no data"));
}

TEST_F(PolicyFiles, ActAnswersEachStateInOrder) {
  const Ended ended = act("s_position,s_speed\n1,0\n0,0.5\n-0.2,0.1\n");
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(ended.err, "");
  const std::vector<std::string> rows = lines(ended.out);
  ASSERT_EQ(rows.size(), 4U);
  EXPECT_TRUE(rows[0].starts_with("action_id,a_")) << rows[0];
  const double expected[] = {-0.687, -0.5885, 0.0197};
  for (std::size_t i = 0; i < 3; ++i) {
    ASSERT_TRUE(rows[i + 1].starts_with("0,"));
    EXPECT_NEAR(std::stod(rows[i + 1].substr(2)), expected[i], 1e-12);
  }
}

TEST_F(PolicyFiles, ActTakesColumnsInAnyOrderAmongOthers) {
  const std::string plain = act("s_position,s_speed\n1,0.25\n").out;
  EXPECT_EQ(act("s_speed,note,s_position\r\n0.25,\"a, b\",1\r\n").out, plain);
  EXPECT_EQ(act("s_position,s_speed\n1,0.25").out, plain);  // no line end
}

TEST_F(PolicyFiles, ActAnswersBeforeTheInputEnds) {
  const Ended ended = shell(
      "mkfifo in out; (runner policy act lqr.policy < in > out) & exec 3> in 4< out; "
      "printf 's_position,s_speed\\n1,0\\n' >&3; read -t 20 -u 4 header && read -t 20 -u 4 first || exit "
      "5; "
      "printf '0,1\\n' >&3; read -t 20 -u 4 second || exit 6; exec 3>&-; wait; echo \"$first $second\"",
      folder_.path());
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(ended.out, "0,-0.687 0,-1\n");  // the second is held in its box
}

TEST_F(PolicyFiles, ActLocatesBadCells) {
  const Ended ended = act("s_position,s_speed\n1,0\n\n2,nan\n");
  EXPECT_EQ(ended.status, 2);
  EXPECT_EQ(lines(ended.out).size(), 2U);  // the good row before it was answered
  EXPECT_TRUE(
      contains(ended.err, "<standard input>:4:3: error: 's_speed' must be a finite number, not 'nan'"))
      << ended.err;
  EXPECT_TRUE(contains(ended.err, "    4 | 2,nan")) << ended.err;
}

TEST_F(PolicyFiles, ActRefusesOtherInputs) {
  struct Case {
    std::string csv, message;
  };
  for (const Case& wrong : {Case{"", "no data"}, Case{"s_position\n1\n", "no column 's_speed'"},
                            Case{"s_postion,s_speed\n1,2\n", "did you mean 's_position'?"},
                            Case{"s_position,s_speed\n1\n", "<standard input>:2"},
                            Case{"s_position,s_position\n1,2\n", "s_position"},
                            Case{std::string("\0\xff\n", 3), "<standard input>:1"}}) {
    const Ended ended = act(wrong.csv);
    EXPECT_EQ(ended.status, 2) << wrong.csv;
    EXPECT_TRUE(contains(ended.err, wrong.message)) << wrong.message << " not in\n" << ended.err;
  }
}

TEST_F(PolicyFiles, APolicyWithoutSpacesNeedsAProblem) {
  const Ended without = act("s_position,s_speed\n1,0\n", "free.policy");
  EXPECT_EQ(without.status, 2);
  EXPECT_TRUE(contains(without.err, "--problem")) << without.err;
  const std::string rows = "s_position,s_speed\n1,0\n";
  EXPECT_EQ(act(rows, "free.policy --problem double_integrator").out, act(rows).out);
}

TEST_F(PolicyFiles, DamagedFilesAreRefused) {
  const std::string whole = TemporaryFolder::read(folder_ / "lqr.policy");
  folder_.write("short.policy", whole.substr(0, whole.size() / 2));
  std::string flipped = whole;
  flipped[whole.size() / 2] = static_cast<char>(flipped[whole.size() / 2] ^ 1);
  folder_.write("flipped.policy", flipped);
  folder_.write("empty.policy", "");
  folder_.write("text.policy", "s_position,s_speed\n");
  for (const std::string name : {"short", "flipped", "empty", "text"}) {
    for (const std::string command : {"info", "act"}) {
      const Ended ended = runner("policy " + command + " " + name + ".policy", folder_.path());
      EXPECT_EQ(ended.status, 2) << name;
      EXPECT_EQ(ended.out, "");
      EXPECT_TRUE(contains(ended.err, name + ".policy")) << ended.err;
    }
  }
}

TEST_F(PolicyFiles, EvaluateGivesTheNumbersOfAnExperiment) {
  folder_.write("config.xml",
                "<experiment coppice=\"1\" name=\"e\" seed=\"5\">"
                "<problem id=\"car\"><double_integrator start=\"uniform\"/></problem>"
                "<policy id=\"lqr\"><linear_feedback gains=\"0.687, 1.177\"/></policy>"
                "<evaluate id=\"scores\" problem=\"car\" policies=\"lqr\" episodes=\"40\"/></experiment>");
  ASSERT_EQ(runner("config.xml", folder_.path()).status, 0);
  const std::vector<std::string> expected = lines(TemporaryFolder::read(folder_ / "out/e/nodes/scores.csv"));
  const Ended ended = runner(
      "policy evaluate lqr.policy --config config.xml --problem car --episodes 40 --seed 5", folder_.path());
  ASSERT_EQ(ended.status, 0) << ended.err;
  const std::vector<std::string> rows = lines(ended.out);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_TRUE(rows[0].starts_with("problem,policy,replicate,episodes,mean_return,mean_cost,sd,ci95_low"))
      << rows[0];
  ASSERT_EQ(expected.size(), 2U);
  const auto from_episodes = [](const std::string& row) { return row.substr(row.find(",40,")); };
  EXPECT_EQ(from_episodes(rows[1]), from_episodes(expected[1]));
}

TEST_F(PolicyFiles, EvaluateFindsTheKnownCost) {
  // Discrete LQR for p^2 + a^2 from (1, 0), Euler steps of 0.05 s: 3.4227 over 200 steps, by Riccati
  // recursion.
  const Ended ended =
      runner("policy evaluate lqr.policy --problem double_integrator --episodes 1", folder_.path());
  ASSERT_EQ(ended.status, 0) << ended.err;
  const std::string row = lines(ended.out).at(1);
  EXPECT_TRUE(contains(row, ",3.42")) << row;
}

TEST_F(PolicyFiles, EvaluateRefusesWhatDoesNotFit) {
  struct Case {
    std::string arguments, message;
  };
  for (const Case& wrong :
       {Case{"lqr.policy", "'--problem' is missing"},
        Case{"lqr.policy --problem duoble_integrator", "did you mean 'double_integrator'?"},
        Case{"lqr.policy --problem '<double_integrator cots=\"p2_v2\"/>'", "did you mean 'cost'"},
        Case{"lqr.policy --problem double_integrator --episodes 0", "'--episodes' must be"},
        Case{"lqr.policy --problem double_integrator --discount 1.5", "'--discount' must be"},
        Case{"lqr.policy --config nowhere.xml --problem car", "no file 'nowhere.xml'"}}) {
    const Ended ended = runner("policy evaluate " + wrong.arguments, folder_.path());
    EXPECT_EQ(ended.status, 2) << wrong.arguments;
    EXPECT_EQ(ended.out, "");
    EXPECT_TRUE(contains(ended.err, wrong.message)) << wrong.message << " not in\n" << ended.err;
  }
}

}  // namespace
}  // namespace coppice
