#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/data/table_file.h"
#include "engine/graph/artifacts.h"
#include "tests/engine/graph/nodes/fake_context.h"

namespace coppice::testing {
namespace {

using ::testing::HasSubstr;

Sub<Node> selection(const std::string& criterion = "return") {
  return make_node(element("select", {{"id", "s"},
                                      {"problem", "car"},
                                      {"policies", "p"},
                                      {"episodes", "4"},
                                      {"horizon", "100"},
                                      {"criterion", criterion}}));
}

/// Feedback laws of the double integrator; the second is the optimum.
void give_laws(FakeContext& context, const std::vector<std::string>& gains) {
  context.given["problem"] = {input(element("problem", {{"id", "car"}}, {element("double_integrator", {})}))};
  for (const std::string& law : gains) {
    context.given["policies"].push_back(
        input(element("policy", {{"id", "p"}}, {element("linear_feedback", {{"gains", law}})})));
    context.given["policies"].back().replicate = static_cast<int>(context.given["policies"].size()) - 1;
  }
}

TEST(Select, TakesTheBestAndRecordsAll) {
  FakeContext context;
  give_laws(context, {"0.1, 0.1", "0.687, 1.177", "2, 1"});
  const Sub<Node> node = selection();
  node->check(context);
  node->run(context);
  const PolicyFile best = read_policy_file(context.folder() / kPolicyFile);
  EXPECT_EQ(best.component.name, "linear_feedback");
  EXPECT_EQ(best.component.get("gains"), "0.687, 1.177");
  EXPECT_EQ(best.provenance, context.key());
  EXPECT_FALSE(best.spaces.actions.empty()) << "others may use it on this problem";
  const Table record = read_table(context.folder() / kSelectionFile);
  ASSERT_EQ(record.rows.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(number(record.rows[i][record.column("selected")]), i == 1 ? 1 : 0);
  }
  EXPECT_NEAR(number(record.rows[1][record.column("mean_return")]), -3.4227, 1e-3);
  EXPECT_EQ(context.counts.at("episodes"), 12);
}

TEST(Select, RefusesPoliciesMadeWithItsOwnDraws) {
  FakeContext context;
  give_laws(context, {"1, 1"});
  context.given["policies"][0].streams = {"train 0", context.stream()};
  EXPECT_THAT(error_of([&] { selection()->check(context); }), HasSubstr("would judge it"));
}

}  // namespace
}  // namespace coppice::testing
