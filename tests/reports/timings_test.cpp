#include <gtest/gtest.h>

#include "engine/data/table_file.h"
#include "engine/graph/artifacts.h"
#include "tests/engine/graph/nodes/fake_context.h"

namespace coppice::testing {
namespace {

TEST(Timings, SummarizesWhatNodesMeasured) {
  FakeContext context;
  for (int r = 0; r < 3; ++r) {
    InputNode& node = context.given["of"].emplace_back();
    node.id = "scores";
    node.replicate = r;
    node.labels = {{"policy", "fpf"}};
    node.folder = context.folder() / std::to_string(r);
    std::filesystem::create_directory(node.folder);
    const std::string cpu = std::to_string(2 * (r + 1));
    write_file(node.folder / "timing.csv", "wall_s,cpu_s,episodes" + std::string(r == 0 ? "" : ",action_s") +
                                               "\n9," + cpu + ",4" + (r == 0 ? "" : ",1e-06") + "\n");
  }
  const auto made = [&](std::vector<std::pair<std::string, std::string>> attributes) {
    attributes.insert(attributes.begin(), {{"id", "t"}, {"of", "scores"}, {"rows", "policy"}});
    const Sub<Node> node = make_node(element("timings", attributes));
    node->check(context);
    node->run(context);
    return read_table(context.folder() / kTableFile);
  };
  const auto value = [](const Table& table, const char* column) {
    return number(table.rows.at(0).at(table.column(column)));
  };
  const Table per_episode = made({{"per", "episodes"}});
  EXPECT_EQ(value(per_episode, "n"), 3);
  EXPECT_EQ(value(per_episode, "mean_s"), 1);  // of 0.5, 1, 1.5
  EXPECT_EQ(value(per_episode, "median_s"), 1);
  EXPECT_EQ(value(per_episode, "max_s"), 1.5);
  const Table action = made({{"time", "action"}});
  EXPECT_EQ(value(action, "n"), 2) << "one node did not measure it";
  EXPECT_EQ(value(action, "mean_s"), 1e-6);
}

}  // namespace
}  // namespace coppice::testing
