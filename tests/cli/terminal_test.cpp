#include <fcntl.h>
#include <gtest/gtest.h>
#include <pty.h>
#include <signal.h>
#include <stdlib.h>
#include <unistd.h>

#include <chrono>

#include "tests/cli/process.h"
#include "tests/support/places.h"

namespace coppice {
namespace {

/// Runs the program in a terminal of 24 lines and 80 columns and gives back everything that it shows.
std::string shown_on_terminal(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                              int& status) {
  winsize size{};
  size.ws_row = 24;
  size.ws_col = 80;
  int terminal = -1;
  const pid_t child = ::forkpty(&terminal, nullptr, nullptr, &size);
  if (child == 0) {
    ::setenv("TERM", "xterm", 1);
    ::unsetenv("NO_COLOR");
    const std::string program = runner_program();
    std::vector<char*> argv = {const_cast<char*>(program.c_str())};
    for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    if (::chdir(folder.c_str()) != 0) ::_exit(99);
    ::execv(argv[0], argv.data());
    ::_exit(98);
  }
  std::string shown;
  char buffer[4096];
  for (ssize_t count; (count = ::read(terminal, buffer, sizeof buffer)) > 0;) {
    shown.append(buffer, static_cast<std::size_t>(count));
  }
  ::waitpid(child, &status, 0);
  ::close(terminal);
  return shown;
}

/// What a terminal of 80 columns shows in the end.
std::vector<std::string> screen(const std::string& text) {
  std::vector<std::string> rows(1);
  std::size_t row = 0, column = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\r') {
      column = 0;
    } else if (text[i] == '\n') {
      if (++row == rows.size()) rows.emplace_back();
    } else if (text[i] == '\x1b') {
      std::size_t number = 0;
      for (i += 2; i < text.size() && text[i] >= '0' && text[i] <= '9'; ++i)
        number = number * 10 + (text[i] - '0');
      if (text[i] == 'A') row -= std::min(row, number);
      if (text[i] == 'K' || text[i] == 'J') rows[row].resize(std::min(rows[row].size(), column));
      if (text[i] == 'J') rows.resize(row + 1);
    } else {
      if (rows[row].size() <= column) rows[row].resize(column + 1, ' ');
      rows[row][column++] = text[i];
      EXPECT_LE(column, 80U);
    }
  }
  return rows;
}

class Terminal : public testing::Test {
 protected:
  Terminal() {
    folder_.write("long.xml", R"(<experiment coppice="1" seed="3">
  <problem id="car"><double_integrator start="uniform"/></problem>
  <policy id="lqr"><linear_feedback gains="0.687, 1.177"/></policy>
  <evaluate id="scores_of_a_policy_with_quite_a_long_name" problem="car" policies="lqr" episodes="40000"
            replicates="3"/>
</experiment>
)");
  }
  void SetUp() override {
    const int terminal = ::posix_openpt(O_RDWR | O_NOCTTY);
    ASSERT_GE(terminal, 0) << "this machine gives no terminals; is /dev/pts mounted?";
    ::close(terminal);
  }
  TemporaryFolder folder_;
};

TEST_F(Terminal, ShowsAStatusAreaAndCleansItUp) {
  int status = 0;
  const auto begin = std::chrono::steady_clock::now();
  const std::string shown = shown_on_terminal({"long.xml", "-j", "2"}, folder_.path(), status);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
  EXPECT_EQ(status, 0);
  std::size_t redraws = 0;
  for (std::size_t at = 0; (at = shown.find("/3 nodes, ", at)) != std::string::npos; ++at) ++redraws;
  EXPECT_GE(redraws, 1U) << shown;
  EXPECT_LE(static_cast<double>(redraws), 12 * taken.count() + 2);
  EXPECT_TRUE(contains(shown, "scores_of_a_policy")) << shown;
  std::vector<std::string> rows = screen(shown);
  while (!rows.empty() && rows.back().empty()) rows.pop_back();
  ASSERT_EQ(rows.size(), 2U) << shown;
  EXPECT_TRUE(rows[0].starts_with("done: 3 nodes run")) << rows[0];
  EXPECT_EQ(rows[1], "out/long/report.html");
}

TEST_F(Terminal, SaysSoWhenAllIsUpToDate) {
  int status = 0;
  shown_on_terminal({"long.xml"}, folder_.path(), status);
  ASSERT_EQ(status, 0);
  EXPECT_EQ(shown_on_terminal({"long.xml"}, folder_.path(), status),
            "everything is up to date: 3 nodes\r\nout/long/report.html\r\n");
}

TEST_F(Terminal, ColoursMistakes) {
  int status = 0;
  const std::string shown = shown_on_terminal({"lnog.xml"}, folder_.path(), status);
  EXPECT_EQ(WEXITSTATUS(status), 2);
  EXPECT_TRUE(contains(shown, "\x1b[31merror: ")) << shown;
  const std::string plain = shown_on_terminal({"lnog.xml", "--color", "never"}, folder_.path(), status);
  EXPECT_FALSE(contains(plain, "\x1b")) << plain;
}

}  // namespace
}  // namespace coppice
