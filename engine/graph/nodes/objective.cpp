#include "engine/vocabulary/objective.h"

#include "engine/graph/node.h"

namespace coppice {
namespace {

/// A family of test functions under a name; other nodes draw from it.
struct ObjectiveNode : Node {
  static constexpr const char* kExample = "<objective id=\"f\"><sphere n=\"10\"/></objective>";

  Sub<Objective> objective;

  std::vector<std::string> makes() const override { return {"objective"}; }
  bool definition() const override { return true; }
  bool random() const override { return false; }
  void run(NodeContext&) const override {}

  static Parameters<ObjectiveNode> parameters() {
    return node_parameters<ObjectiveNode>().direct(&ObjectiveNode::objective, "The function.");
  }
};

const Component<Node, ObjectiveNode> kObjectiveNode("objective", "Give a function to be made large a name.",
                                                    "no publication");

}  // namespace
}  // namespace coppice
