#include <gtest/gtest.h>

#include "tests/cli/process.h"

namespace coppice {
namespace {

/// What bash would offer after `line`, with the script sourced.
std::vector<std::string> offered(const std::string& line) {
  const Ended ended = shell(
      "source <(runner completion bash) || exit\n"
      "COMP_LINE='" +
      line +
      "'; COMP_POINT=${#COMP_LINE}; COMP_WORDBREAKS=$' \\t\\n\"><=;|&(:'\n"
      "compopt() { :; }\n"  // only allowed while bash completes
      "_runner && printf '%s\\n' \"${COMPREPLY[@]}\"");
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(ended.err, "");
  return lines(ended.out);
}

bool has(const std::vector<std::string>& all, const std::string& word) {
  return std::find(all.begin(), all.end(), word) != all.end();
}

using Words = std::vector<std::string>;

TEST(Completion, OffersCommands) {
  EXPECT_EQ(offered("runner val"), Words{"validate"});
  EXPECT_EQ(offered("runner policy a"), Words{"act"});
  EXPECT_TRUE(has(offered("runner "), "run"));
  EXPECT_FALSE(has(offered("runner "), "node"));  // hidden
}

TEST(Completion, OffersOptionsAndTheirValues) {
  EXPECT_EQ(offered("runner run --keep"), Words{"--keep-going"});
  EXPECT_EQ(offered("runner plan configs/quickstart.xml --d"), Words{"--dot"});
  EXPECT_EQ(offered("runner configs/quickstart.xml --progress "), (Words{"auto", "json", "none", "plain"}));
  EXPECT_EQ(offered("runner completion z"), Words{"zsh"});
}

TEST(Completion, OffersComponentsAndKinds) {
  EXPECT_EQ(offered("runner describe double_i"), Words{"double_integrator"});
  EXPECT_TRUE(has(offered("runner describe s"), "sweep"));
  EXPECT_EQ(offered("runner list prob"), Words{"problem"});
  EXPECT_EQ(offered("runner policy evaluate x.policy --problem double"), Words{"double_integrator"});
}

TEST(Completion, OffersConfigsAndTheirArguments) {
  EXPECT_EQ(offered("runner configs/quick"), Words{"configs/quickstart.xml"});
  EXPECT_EQ(offered("runner configs/quickstart.xml repl"), Words{"replicates:="});
  EXPECT_EQ(offered("runner configs/quickstart.xml --only sco"), Words{"scores"});
}

TEST(Completion, ScriptsForOtherShellsAskTheProgram) {
  for (const std::string shell_name : {"zsh", "fish"}) {
    const Ended ended = runner("completion " + shell_name);
    EXPECT_EQ(ended.status, 0);
    EXPECT_TRUE(contains(ended.out, "__complete"));
    const Ended parsed =
        shell("command -v " + shell_name + " > /dev/null || exit 0; runner completion " + shell_name +
              " > \"$TMPDIR/script\" && " + shell_name + " -n \"$TMPDIR/script\"");
    EXPECT_EQ(parsed.status, 0) << parsed.err;
  }
}

TEST(Completion, StaysQuietAboutBrokenConfigs) {
  const Ended ended = shell("runner __complete run nowhere.xml ''");
  EXPECT_EQ(ended.status, 0);
  EXPECT_EQ(ended.err, "");
}

}  // namespace
}  // namespace coppice
