#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/graph/artifacts.h"
#include "tests/engine/graph/nodes/fake_context.h"

namespace coppice::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr const char* kTransition =
    "episode,step,s_position,s_speed,action_id,a_acceleration,reward,n_position,n_speed,terminal\n"
    "0,0,1,0,0,0.5,-1.25,1.05,0.25,0\n";

/// Runs a dataset node on a CSV text.
void read(FakeContext& context, const std::string& csv, bool with_problem) {
  const std::string file = (context.folder() / "given.csv").string();
  write_file(file, csv);
  std::vector<std::pair<std::string, std::string>> attributes = {{"id", "d"}, {"file", file}};
  if (with_problem) {
    attributes.emplace_back("problem", "car");
    context.given["problem"] = {
        input(element("problem", {{"id", "car"}}, {element("double_integrator", {})}))};
  }
  make_node(element("dataset", attributes))->run(context);
}

TEST(DatasetNode, ReadsTransitionsOfAProblem) {
  FakeContext context;
  read(context, kTransition, true);
  EXPECT_EQ(text_of(context.folder() / kDatasetFile), kTransition);
}

TEST(DatasetNode, NamesTheCellThatIsWrong) {
  FakeContext context;
  EXPECT_THAT(
      error_of([&] {
        read(context,
             "episode,step,s_position,s_speed,action_id,a_acceleration,reward,n_position,n_speed,terminal\n"
             "0,0,1,fast,0,0.5,-1.25,1.05,0.25,0\n",
             true);
      }),
      AllOf(HasSubstr("given.csv:2"), HasSubstr("fast")));
}

TEST(DatasetNode, ReadsAnyTableWithoutAProblem) {
  FakeContext context;
  read(context, "x,\"y\"\r\n1,2.50\r\n", false);
  EXPECT_EQ(text_of(context.folder() / kDatasetFile), "x,y\n1,2.5\n");
}

}  // namespace
}  // namespace coppice::testing
