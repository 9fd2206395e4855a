#include <stdexcept>

#include "engine/graph/artifacts.h"

namespace coppice {
namespace {

/// A policy under a name: configured here, or trained elsewhere and saved in a file. With a problem, or from
/// a file, it makes a policy file.
struct PolicyNode : Node {
  static constexpr const char* kExample = "<policy id=\"explorer\"><random/></policy>";

  using Node::check;

  Sub<Policy> policy;
  FilePath file;
  Reference problem;

  std::vector<std::string> makes() const override { return {"policy"}; }
  bool definition() const override { return problem.id.empty() && file.path.empty(); }
  bool random() const override { return false; }
  bool learns() const override { return !file.path.empty(); }  // its file does not tell

  void check() const {
    if (file.path.empty() == !policy) {
      throw std::invalid_argument("give either a policy inside, as <random/>, or file=\"...\"");
    }
  }

  void check(const NodeContext& context) const override {
    Rules rules;
    if (!problem.id.empty()) {
      rules.check(file.path.empty() ? "" : "file",
                  [&] { content(*load_problem(context.inputs("problem").front()), context.key()); });
    } else if (!file.path.empty()) {
      rules.check("file", [&] { make_policy(read_policy_file(file.path)); });
    }
    rules.enforce();
  }

  std::shared_ptr<const Spaces> spaces(const NodeContext& context) const override {
    return problem.id.empty() ? nullptr : load_spaces(context.inputs("problem").front());
  }

  void run(NodeContext& context) const override {
    const std::filesystem::path target = context.folder() / kPolicyFile;
    if (problem.id.empty()) {
      write_policy_file(target, read_policy_file(file.path));
    } else {
      write_policy_file(target, content(*load_problem(context.inputs("problem").front()), context.key()));
    }
  }

  static Parameters<PolicyNode> parameters() {
    return node_parameters<PolicyNode>()
        .add("file", &PolicyNode::file, "", "A policy file, instead of a policy inside.")
        .reference("problem", &PolicyNode::problem, "problem",
                   "Problem that the policy is for: checked when planning, and its spaces go into the "
                   "policy file that the node then makes.",
                   false)
        .direct(&PolicyNode::policy, "The policy.", false);
  }

 private:
  /// What the policy file holds, after trying whether the policy fits the problem.
  PolicyFile content(const Problem& target, const std::string& key) const {
    if (!file.path.empty()) {
      PolicyFile content = read_policy_file(file.path);
      const bool general = content.spaces.actions.empty();  // saved without a problem
      if (!general) require_same_axes(content.spaces, target.spaces(), "the policy file");
      make_policy(content).object->prepare(target.spaces(), target.simulator());
      content.spaces = target.spaces();
      return content;
    }
    Diagnostics diagnostics;
    const MadePolicy made = make<Policy>(policy.resolved, diagnostics);
    diagnostics.throw_if_any();
    made.object->prepare(target.spaces(), target.simulator());
    PolicyFile content{
        .writer = {}, .provenance = key, .spaces = target.spaces(), .component = made.resolved, .arrays = {}};
    made->save(content.arrays);
    return content;
  }
};

const Component<Node, PolicyNode> kPolicyNode("policy",
                                              "Give a policy a name, configured here or read from a file.",
                                              "no publication");

}  // namespace
}  // namespace coppice
