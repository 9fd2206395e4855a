#include <gtest/gtest.h>

#include <filesystem>

#include "registry/component.h"
#include "tests/cli/process.h"
#include "tests/support/places.h"

// Every command that the pages for users show is executed: lines "$ command" of ```console blocks, one page
// in one folder, and the examples of the commands' help. What a page shows as output must come out; a line
// with "..." stands for anything. On docs/your-problem.md and docs/exports.md the program knows the problem
// of the first, and the files of both are there.

namespace coppice {
namespace {

namespace fs = std::filesystem;

const fs::path kRoot = source_folder();

struct Step {
  std::string command;
  int status = 0;
  std::vector<std::string> shown;
};

std::vector<Step> steps_of(const fs::path& page) {
  std::vector<Step> steps;
  bool inside = false;
  for (const std::string& line : lines(TemporaryFolder::read(page))) {
    if (line.starts_with("```")) {
      inside = line == "```console";
    } else if (inside && line.starts_with("$ ")) {
      Step step;
      const std::size_t comment = line.find("# fails with ");
      step.command = line.substr(2, comment == std::string::npos ? comment : comment - 2);
      if (comment != std::string::npos) step.status = std::stoi(line.substr(comment + 13));
      steps.push_back(std::move(step));
    } else if (inside && !steps.empty()) {
      steps.back().shown.push_back(line);
    }
  }
  return steps;
}

/// A folder as users have it: the shipped configs, and a home of their own.
struct Home {
  TemporaryFolder folder;
  std::string program = runner_program();
  explicit Home(const fs::path& page = {}) {
    fs::copy(kRoot / "configs", folder / "configs", fs::copy_options::recursive);
    if (page.filename() == "your-problem.md" || page.filename() == "exports.md") {
      program = contributing_program();
      fs::copy(your_problem_folder(), folder.path(), fs::copy_options::recursive);
    }
    fs::create_directories(folder / ".zfunc");
    fs::create_directories(folder / ".config/fish/completions");
  }
  Ended run(const std::string& command) const {
    return shell("RUNNER='" + program + "'\nexport HOME=" + folder.path().string() + "\n" + command,
                 folder.path());
  }
};

std::vector<fs::path> pages() {
  std::vector<fs::path> all = {kRoot / "README.md"};
  for (const fs::directory_entry& entry : fs::directory_iterator(kRoot / "docs")) {
    if (entry.path().extension() == ".md") all.push_back(entry.path());
  }
  return all;
}

TEST(Docs, CommandsOnPagesDoWhatThePagesShow) {
  std::size_t executed = 0;
  for (const fs::path& page : pages()) {
    const std::vector<Step> steps = steps_of(page);
    if (steps.empty()) continue;
    const Home home(page);
    for (const Step& step : steps) {
      if (step.command.starts_with("make ") || step.command.starts_with("cmake "))
        continue;  // the build's own tests
      SCOPED_TRACE(page.filename().string() + ": " + step.command);
      const std::string program = "build/runner ";
      const std::string command =
          step.command.starts_with(program) ? "runner " + step.command.substr(program.size()) : step.command;
      const Ended ended = home.run(command);
      EXPECT_EQ(ended.status, step.status) << ended.err;
      for (const std::string& line : step.shown) {
        if (contains(line, "...")) continue;
        EXPECT_TRUE(contains(ended.out + ended.err, line)) << "not shown: " << line << "\n"
                                                           << ended.out << ended.err;
      }
      ++executed;
    }
  }
  EXPECT_GE(executed, 15U);
}

TEST(Docs, ExamplesInHelpWork) {
  const Home home;
  ASSERT_EQ(home.run("runner configs/quickstart.xml").status, 0);
  ASSERT_EQ(home.run("cp $(find out/quickstart/nodes -name '*.policy' | head -1) learned.policy").status, 0);
  std::size_t executed = 0;
  for (const std::string& line : lines(TemporaryFolder::read(kRoot / "docs/manual/commands.md"))) {
    if (!line.starts_with("  `")) continue;
    const std::string command = line.substr(3, line.size() - 4);
    SCOPED_TRACE(command);
    const Ended ended = home.run(command);
    EXPECT_EQ(ended.status, 0) << ended.err;
    ++executed;
  }
  EXPECT_GE(executed, 20U);
}

TEST(Docs, ReadmeNamesEveryComponentThatUsersName) {
  const std::string readme = TemporaryFolder::read(kRoot / "README.md");
  for (const std::string& interface : Catalogue::instance().interfaces()) {
    if (interface == "function" || interface == "report") continue;  // made by others
    for (const std::string& name : Catalogue::instance().names(interface)) {
      EXPECT_NE(readme.find('`' + name + '`'), std::string::npos) << interface << " " << name;
    }
  }
}

TEST(Docs, ManualIsWhatTheDeclarationsSay) {
  const TemporaryFolder written;
  ASSERT_EQ(runner("manual " + written.path().string()).status, 0);
  const auto names = [](const fs::path& folder) {
    std::vector<std::string> all;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder))
      all.push_back(entry.path().filename());
    std::sort(all.begin(), all.end());
    return all;
  };
  EXPECT_EQ(names(written.path()), names(kRoot / "docs/manual"));
  for (const std::string& name : names(written.path())) {
    EXPECT_TRUE(TemporaryFolder::read(written / name) == TemporaryFolder::read(kRoot / "docs/manual" / name))
        << "docs/manual/" << name << " is out of date: run 'make docs'";
  }
}

}  // namespace
}  // namespace coppice
