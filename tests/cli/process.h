#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/places.h"
#include "tests/support/temporary_folder.h"

namespace coppice {

/// How a program ended, and what it wrote.
struct Ended {
  int status = 0;  ///< exit status, or 128 + the signal's number
  std::string out;
  std::string err;
};

/// Runs a bash script in which `runner` is the program under test and $RUNNER its path.
inline Ended shell(const std::string& command, const std::filesystem::path& folder = source_folder(),
                   const std::string& input = {}) {
  const TemporaryFolder scratch;
  const auto quoted = [](const std::filesystem::path& path) { return "'" + path.string() + "'"; };
  scratch.write("in", input);
  scratch.write("script", "RUNNER='" + runner_program() + "'\nrunner() { \"$RUNNER\" \"$@\"; }\ncd " +
                              quoted(folder) + " || exit 99\n" + command + "\n");
  const std::string line = "bash " + quoted(scratch / "script") + " < " + quoted(scratch / "in") + " > " +
                           quoted(scratch / "out") + " 2> " + quoted(scratch / "err");
  const int status = std::system(line.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status),
          TemporaryFolder::read(scratch / "out"), TemporaryFolder::read(scratch / "err")};
}

/// Runs the program itself.
inline Ended runner(const std::string& arguments, const std::filesystem::path& folder = source_folder(),
                    const std::string& input = {}) {
  return shell("runner " + arguments, folder, input);
}

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

inline std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> all;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) all.push_back(line);
  return all;
}

}  // namespace coppice
