#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "tests/cli/process.h"

namespace coppice {

using Names = std::set<std::string>;

/// Runs of experiments in a folder of their own; results go to its folder "out".
class RunsInAFolder : public testing::Test {
 protected:
  Ended run(const std::string& arguments) const { return runner(arguments, folder_.path()); }
  Ended script(const std::string& command) const { return shell(command, folder_.path()); }

  /// Names of the nodes that the plan would run.
  Names planned(const std::string& arguments) const {
    Names names;
    const Ended ended = run("plan --json " + arguments);
    EXPECT_EQ(ended.status, 0) << ended.err;
    const nlohmann::json plan = nlohmann::json::parse(ended.out);
    for (const nlohmann::json& node : plan.at("experiments")[0].at("nodes")) {
      if (node.at("runs").get<bool>()) names.insert(node.at("name"));
    }
    return names;
  }
  /// Runs and tells which nodes were finished.
  Names executed(const std::string& arguments) const {
    Names names;
    const Ended ended = run("run --progress json " + arguments);
    EXPECT_EQ(ended.status, 0) << ended.err;
    for (const std::string& line : lines(ended.err)) {
      const nlohmann::json event = nlohmann::json::parse(line);
      if (event.at("event") == "finished") names.insert(event.at("node"));
    }
    return names;
  }
  /// Contents of all results below a folder, by name; times and what tells of the run left out.
  static std::map<std::string, std::string> results(const std::filesystem::path& folder) {
    std::map<std::string, std::string> files;
    for (const std::filesystem::directory_entry& entry :
         std::filesystem::recursive_directory_iterator(folder)) {
      const std::string name = entry.path().filename().string();
      const std::string path = std::filesystem::relative(entry.path(), folder).string();
      if (!entry.is_regular_file() || name.starts_with("timing") || path.starts_with(".")) continue;
      if (name == "provenance.json" || name == "events.jsonl" || name == "report.html") continue;
      files[path] = TemporaryFolder::read(entry.path());
    }
    return files;
  }

  TemporaryFolder folder_;
};

}  // namespace coppice
