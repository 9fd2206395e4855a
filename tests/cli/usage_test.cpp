#include <gtest/gtest.h>

#include <ostream>

#include "tests/cli/process.h"

namespace coppice {
namespace {

/// Every command, as completion offers them; of families the members.
std::vector<std::string> all_commands() {
  std::vector<std::string> all;
  for (const std::string& word : lines(runner("__complete ''").out)) {
    if (word.starts_with(":")) continue;
    if (word != "policy" && word != "export") {
      all.push_back(word);
    } else {
      for (const std::string& member : lines(runner("__complete " + word + " ''").out)) {
        all.push_back(word + " " + member);
      }
    }
  }
  return all;
}

TEST(Usage, NoArgumentsShowTheOverviewAsTalk) {
  const Ended ended = runner("");
  EXPECT_EQ(ended.status, 2);
  EXPECT_EQ(ended.out, "");
  EXPECT_TRUE(contains(ended.err, "Usage: runner CONFIG..."));
}

TEST(Usage, HelpIsData) {
  const Ended ended = runner("--help");
  EXPECT_EQ(ended.status, 0);
  EXPECT_EQ(ended.err, "");
  for (const std::string& command : all_commands())
    EXPECT_TRUE(contains(ended.out, "  " + command + " ")) << command;
}

TEST(Usage, EveryCommandHasHelpWithExamplesWithin80Columns) {
  ASSERT_GE(all_commands().size(), 12U);
  for (const std::string& command : all_commands()) {
    SCOPED_TRACE(command);
    const Ended ended = runner(command + " --help");
    EXPECT_EQ(ended.status, 0);
    EXPECT_EQ(ended.err, "");
    EXPECT_TRUE(ended.out.starts_with("Usage: runner " + command));
    const std::size_t examples = ended.out.find("\nExamples:\n");
    ASSERT_NE(examples, std::string::npos);
    for (const std::string& line : lines(ended.out.substr(0, examples))) EXPECT_LE(line.size(), 80U) << line;
    EXPECT_EQ(runner("help " + command).out, ended.out);
  }
}

TEST(Usage, VersionNamesTheProgramFirst) {
  const Ended ended = runner("--version");
  EXPECT_EQ(ended.status, 0);
  EXPECT_TRUE(ended.out.starts_with("coppice")) << ended.out;
}

struct Misuse {
  std::string arguments;
  std::string message;  ///< part of what is said
  std::string hint;     ///< another part
};

void PrintTo(const Misuse& misuse, std::ostream* out) {
  *out << "runner " << misuse.arguments;
}

class Misused : public testing::TestWithParam<Misuse> {};

TEST_P(Misused, IsRefusedWithTheNearestName) {
  const Ended ended = runner(GetParam().arguments);
  EXPECT_EQ(ended.status, 2);
  EXPECT_EQ(ended.out, "");
  EXPECT_TRUE(contains(ended.err, GetParam().message)) << ended.err;
  EXPECT_TRUE(contains(ended.err, GetParam().hint)) << ended.err;
}

INSTANTIATE_TEST_SUITE_P(
    Usage, Misused,
    testing::Values(
        Misuse{"rnu configs/quickstart.xml", "no subcommand 'rnu'", "did you mean 'run'?"},
        Misuse{"policy inf x", "'policy' has no subcommand 'inf'", "did you mean 'info'?"},
        Misuse{"policy", "Usage: runner policy", "policy act"},
        Misuse{"run", "a CONFIG is missing", "Config files"},
        Misuse{"-j 2", "a CONFIG is missing", "Config files"},
        Misuse{"run --jbos 3 configs/quickstart.xml", "no option '--jbos'", "did you mean '--jobs'?"},
        Misuse{"configs/quickstart.xml --progres none", "no option '--progres'",
               "did you mean '--progress'?"},
        Misuse{"run configs/quickstart.xml --on slrum", "'--on' cannot be 'slrum'", "valid: local"},
        Misuse{"run configs/quickstart.xml --out", "'--out' needs a value DIR", "Folder of the results"},
        Misuse{"run configs/quickstart.xml --out a --out b", "'--out' is given more than once", ""},
        Misuse{"run configs/quickstart.xml -j x", "'--jobs' must be an integer >= 0, not 'x'", ""},
        Misuse{"run configs/quickstart.xml -j 0", "'--jobs' must be an integer in [1, 1024]", ""},
        Misuse{"run configs/quickstart.xml --seed -1", "'--seed' must be an integer >= 0, not '-1'", ""},
        Misuse{"run configs/quickstart.xml --seed 99999999999999999999", "'--seed' must be an integer", ""},
        Misuse{"run configs/quickstart.xml --keep-going --fail-fast", "exclude each other", ""},
        Misuse{"run configs/quikstart.xml", "no file 'configs/quikstart.xml'",
               "did you mean 'configs/quickstart.xml'?"},
        Misuse{"confgs/quickstart.xml", "no file 'confgs/quickstart.xml'",
               "did you mean 'configs/quickstart.xml'?"},
        Misuse{"run configs", "'configs' is a folder", ""},
        Misuse{"configs/quickstart.xml replicate:=3", "replicate", "did you mean 'replicates'?"},
        Misuse{"plan configs/quickstart.xml --json --dot", "exclude each other", ""},
        Misuse{"plan configs/quickstart.xml --only scoers", "scoers", "did you mean 'scores'?"},
        Misuse{"run configs/quickstart.xml --force scoers --out /nonexistent", "scoers",
               "did you mean 'scores'?"},
        Misuse{"validate configs/quickstart.xml --format yaml", "'--format' cannot be 'yaml'",
               "valid: text, json"},
        Misuse{"list prolbem", "no kind of component 'prolbem'", "did you mean 'problem'?"},
        Misuse{"list problem policy", "does not take 'policy'", "runner list --help"},
        Misuse{"list --json=3", "'--json' takes no value", ""},
        Misuse{"describe duoble_integrator", "no component 'duoble_integrator'",
               "did you mean 'double_integrator'?"},
        Misuse{"describe", "a NAME is missing", ""},
        Misuse{"completion ksh", "'SHELL' cannot be 'ksh'", "zsh"},
        Misuse{"help rnu", "no command 'rnu'", "did you mean 'run'?"},
        Misuse{"--color sometimes list", "'--color' cannot be 'sometimes'", "valid: auto, always, never"},
        Misuse{"policy info nowhere.policy", "no file 'nowhere.policy'", ""}));

TEST(Usage, SaysAllMistakesOfTheLineAndTheirNumber) {
  const Ended ended = runner("run configs/quickstart.xml --jbos 3 --on slrum --out");
  EXPECT_EQ(ended.status, 2);
  EXPECT_TRUE(contains(ended.err, "--jbos"));
  EXPECT_TRUE(contains(ended.err, "slrum"));
  EXPECT_TRUE(contains(ended.err, "--out"));
  EXPECT_TRUE(ended.err.ends_with("3 errors\n")) << ended.err;
}

TEST(Usage, PointsAtTheArgument) {
  const Ended ended = runner("list prolbem");
  EXPECT_TRUE(contains(ended.err, "    1 | runner list prolbem\n      |             ^~~~~~~")) << ended.err;
}

TEST(Usage, OptionsMayStandAnywhere) {
  const std::string expected = runner("validate configs/quickstart.xml --format json").out;
  EXPECT_TRUE(contains(expected, "\"valid\": true"));
  EXPECT_EQ(runner("--format json validate configs/quickstart.xml").out, expected);
  EXPECT_EQ(runner("validate --format=json -- configs/quickstart.xml").out, expected);
  EXPECT_EQ(runner("--color never validate --format json configs/quickstart.xml").out, expected);
}

TEST(Usage, ColoursOnlyWhenAskedForOrOnATerminal) {
  EXPECT_FALSE(contains(runner("list prolbem").err, "\x1b["));
  EXPECT_TRUE(contains(runner("list prolbem --color always").err, "\x1b["));
}

TEST(Usage, AClosedPipeIsNoError) {
  const Ended ended =
      shell("set -o pipefail; for i in 1 2 3; do runner schema | head -1 > /dev/null || exit; done");
  EXPECT_EQ(ended.status, 0);
  EXPECT_EQ(ended.err, "");
}

TEST(Usage, AFullDeviceIsAnError) {
  const Ended ended = shell("runner list > /dev/full");
  EXPECT_EQ(ended.status, 1);
  EXPECT_TRUE(contains(ended.err, "No space left on device")) << ended.err;
}

}  // namespace
}  // namespace coppice
