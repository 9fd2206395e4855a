#include "engine/vocabulary/problem.h"

#include "engine/graph/node.h"

namespace coppice {
namespace {

/// A problem under a name; other nodes make it from the element.
struct ProblemNode : Node {
  Sub<Problem> problem;

  std::vector<std::string> makes() const override { return {"problem"}; }
  bool definition() const override { return true; }
  bool random() const override { return false; }
  void run(NodeContext&) const override {}

  static Parameters<ProblemNode> parameters() {
    return node_parameters<ProblemNode>().direct(&ProblemNode::problem, "The problem.");
  }
};

const Component<Node, ProblemNode> kComponent("problem", "Give a problem a name.", "no publication");

}  // namespace
}  // namespace coppice
