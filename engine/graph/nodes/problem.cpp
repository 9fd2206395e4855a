#include "engine/vocabulary/problem.h"

#include "engine/graph/node.h"

namespace coppice {
namespace {

/// A problem under a name; shared by the nodes that use it.
struct ProblemNode : Node {
  Sub<Problem> named;

  std::vector<std::string> makes() const override { return {"problem"}; }
  std::shared_ptr<const Problem> problem() const override { return named.object; }
  bool definition() const override { return true; }
  bool random() const override { return false; }
  void run(NodeContext&) const override {}

  static Parameters<ProblemNode> parameters() {
    return node_parameters<ProblemNode>().direct(&ProblemNode::named, "The problem.");
  }
};

const Component<Node, ProblemNode> kProblemNode("problem", "Give a problem a name.", "no publication");

}  // namespace
}  // namespace coppice
