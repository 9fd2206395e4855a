#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/cli/process.h"

namespace coppice {
namespace {

namespace fs = std::filesystem;

/// An experiment with a policy for the double integrator and `more`, run in a folder.
Ended run(const TemporaryFolder& folder, const std::string& more) {
  folder.write("e.xml",
               "<experiment coppice=\"1\" seed=\"1\"><problem id=\"car\"><double_integrator/></problem>"
               "<policy id=\"lqr\" problem=\"car\"><linear_feedback gains=\"0.7, 1.2\"/></policy>"
               "<policy id=\"any\"><random/></policy>" +
                   more + "</experiment>");
  return runner("e.xml --out out", folder.path());
}

TEST(ExportNode, WritesAFileInItsFolder) {
  const TemporaryFolder folder;
  const Ended ended = run(folder,
                          "<export id=\"onboard\" policy=\"lqr\" to=\"cpp\" name=\"car_driver\"/>"
                          "<export id=\"numbers\" policy=\"lqr\" to=\"json\"/>");
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_TRUE(
      contains(TemporaryFolder::read(folder / "out/e/nodes/onboard/car_driver.h"), "namespace car_driver {"));
  const auto json = nlohmann::json::parse(TemporaryFolder::read(folder / "out/e/nodes/numbers/policy.json"));
  const auto info =
      nlohmann::json::parse(runner("policy info out/e/nodes/lqr/policy.policy --json", folder.path()).out);
  EXPECT_EQ(json.at("provenance"), info.at("provenance"));
  EXPECT_EQ(json.at("states"), info.at("states"));
}

TEST(ExportNode, GivesWhatTheCommandGives) {
  const TemporaryFolder folder;
  ASSERT_EQ(run(folder, "<export id=\"x\" policy=\"lqr\" to=\"onnx\"/>").status, 0);
  const Ended ended = runner("policy export out/e/nodes/lqr/policy.policy --to onnx", folder.path());
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_FALSE(ended.out.empty());
  EXPECT_EQ(ended.out, TemporaryFolder::read(folder / "out/e/nodes/x/policy.onnx"));
}

/// The version of the exporter is in the node's key.
TEST(ExportNode, DependsOnItsExporter) {
  const TemporaryFolder folder;
  ASSERT_EQ(run(folder, "<export id=\"x\" policy=\"lqr\" to=\"dot\"/>").status, 0);
  const Ended why = runner("why x e.xml --out out", folder.path());
  EXPECT_TRUE(contains(why.out + why.err, "dot/1")) << why.out << why.err;
}

TEST(ExportNode, RefusesBeforeAnythingRuns) {
  const auto refusal = [](const std::string& node) {
    const TemporaryFolder folder;
    const Ended ended = run(folder, node);
    EXPECT_EQ(ended.status, 2) << node;
    EXPECT_FALSE(fs::exists(folder / "out/e/nodes/lqr"));
    return ended.err;
  };
  EXPECT_TRUE(contains(refusal("<export id=\"x\" policy=\"lqr\" to=\"cp\"/>"), "did you mean 'cpp'?"));
  EXPECT_TRUE(contains(refusal("<export id=\"x\" policy=\"lqr\" to=\"cpp\" name=\"A\"/>"), "small letters"));
  EXPECT_TRUE(
      contains(refusal("<export id=\"x\" policy=\"any\" to=\"cpp\"/>"), "give policy 'any' a problem"));
  EXPECT_TRUE(contains(refusal("<policy id=\"r\" problem=\"car\"><random/></policy>"
                               "<export id=\"x\" policy=\"r\" to=\"cpp\"/>"),
                       "draws its actions at random"));
}

TEST(PolicyExport, SaysWhatIsWrong) {
  const TemporaryFolder folder;
  ASSERT_EQ(run(folder, "").status, 0);
  const auto refusal = [&](const std::string& arguments) {
    const Ended ended = runner("policy export out/e/nodes/lqr/policy.policy " + arguments, folder.path());
    EXPECT_EQ(ended.status, 2) << arguments;
    EXPECT_EQ(ended.out, "");
    return ended.err;
  };
  EXPECT_TRUE(contains(refusal(""), "needs --to cpp, dot, json or onnx"));
  EXPECT_TRUE(contains(refusal("--to jsn"), "did you mean 'json'?"));
  EXPECT_TRUE(contains(refusal("--to cpp --name 'two words'"), "small letters"));
}

}  // namespace
}  // namespace coppice
