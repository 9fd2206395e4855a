#include "engine/graph/provenance.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>

#include "engine/graph/build_info.h"
#include "tests/support/temporary_folder.h"

namespace coppice {
namespace {

std::map<std::string, std::string> environment_map() {
  std::map<std::string, std::string> values;
  for (const auto& [name, value] : environment()) values[name] = value;
  return values;
}

TEST(Provenance, TheProgramComesFirst) {
  EXPECT_EQ(environment().front(), (std::pair<std::string, std::string>("coppice", build_info().version)));
}

TEST(Provenance, EveryPartOfTheEnvironmentHasAValue) {
  EXPECT_EQ(environment_map().size(), environment().size()) << "a name occurs twice";
  for (const auto& [name, value] : environment()) EXPECT_NE(value, "") << name;
}

TEST(Provenance, VersionsAreNumbers) {
  const std::map<std::string, std::string> values = environment_map();
  const std::regex version("[0-9]+\\.[0-9]+(\\.[0-9]+)?");
  for (const char* name :
       {"coppice", "eigen", "fmt", "glibc", "nlohmann_json", "sleef", "sqlite", "tinyxml2", "xxhash"}) {
    ASSERT_TRUE(values.contains(name)) << name;
    EXPECT_TRUE(std::regex_match(values.at(name), version)) << name << " " << values.at(name);
  }
}

TEST(Provenance, NamesTheBuildAndTheMachine) {
  const std::map<std::string, std::string> values = environment_map();
  const std::string compiler = values.at("compiler");
#ifdef __clang__
  EXPECT_EQ(compiler.find("Clang " + std::to_string(__clang_major__) + "."), 0u) << compiler;
#else
  EXPECT_EQ(compiler.find("GNU " + std::to_string(__GNUC__) + "."), 0u) << compiler;
#endif
  EXPECT_NE(values.at("flags").find("-ffp-contract=off"), std::string::npos) << values.at("flags");
  EXPECT_TRUE(std::regex_match(values.at("commit"), std::regex("unknown|[0-9a-f]{40}(-modified)?")))
      << values.at("commit");
  std::array<char, 256> host{};
  ASSERT_EQ(::gethostname(host.data(), host.size() - 1), 0);
  EXPECT_EQ(values.at("host"), host.data());
}

TEST(Provenance, WritesWhatARunWasMadeOf) {
  Plan plan;
  plan.experiment.name = "table_3_1";
  plan.experiment.path = "configs/thesis/table_3_1.xml";
  plan.experiment.seed = 18'446'744'073'709'551'615u;
  plan.experiment.overrides = {{"scale", "ci", {}}};
  plan.experiment.arguments = {{"episodes", "500"}, {"scale", "ci"}};
  plan.files = {{"configs/scale.xml", "00ff"}, {"not \xff UTF-8", "01"}};
  Provenance provenance;
  provenance.plan = &plan;
  provenance.command = {"runner", "configs/thesis/table_3_1.xml", "scale:=ci"};
  provenance.threads = 2;
  provenance.started = "2024-01-01T00:00:00.000Z";
  provenance.outcome = "running";
  const TemporaryFolder folder;
  write_provenance(folder / "provenance.json", provenance);
  const nlohmann::json json = nlohmann::json::parse(TemporaryFolder::read(folder / "provenance.json"));
  EXPECT_EQ(json.at("experiment"), "table_3_1");
  EXPECT_EQ(json.at("config"), "configs/thesis/table_3_1.xml");
  EXPECT_EQ(json.at("seed"), 18'446'744'073'709'551'615u);
  EXPECT_EQ(json.at("overrides"), nlohmann::json({{"scale", "ci"}}));
  EXPECT_EQ(json.at("arguments"), nlohmann::json({{"episodes", "500"}, {"scale", "ci"}}));
  EXPECT_EQ(json.at("command").at(2), "scale:=ci");
  EXPECT_EQ(json.at("threads"), 2);
  EXPECT_EQ(json.at("started"), provenance.started);
  EXPECT_EQ(json.at("finished"), "");
  EXPECT_EQ(json.at("outcome"), "running");
  EXPECT_EQ(json.at("inputs").at(0), nlohmann::json({{"path", "configs/scale.xml"}, {"hash", "00ff"}}));
  EXPECT_EQ(json.at("inputs").size(), 2u);
  EXPECT_EQ(json.at("environment").at("coppice"), build_info().version);
  EXPECT_THROW(write_provenance(folder / "missing/provenance.json", provenance), std::runtime_error);
}

TEST(Timestamp, IsIso8601InUtc) {
  EXPECT_EQ(timestamp(0), "1970-01-01T00:00:00.000Z");
  EXPECT_EQ(timestamp(1'709'251'199'987'654'321), "2024-02-29T23:59:59.987Z");
  const std::string now = timestamp();
  EXPECT_TRUE(std::regex_match(now, std::regex("20\\d\\d-\\d\\d-\\d\\dT\\d\\d:\\d\\d:\\d\\d\\.\\d{3}Z")))
      << now;
}

}  // namespace
}  // namespace coppice
