#include "engine/graph/export.h"

#include <fmt/format.h>

#include <stdexcept>

#include "engine/data/file_system.h"
#include "engine/graph/artifacts.h"

namespace coppice {
namespace {

/// A policy in a format that other programs read. The policy comes from a node that makes a policy file.
struct ExportNode : Node {
  static constexpr const char* kExample = "<export id=\"onboard\" policy=\"fpf_pwl\" to=\"cpp\"/>";

  using Node::check;

  Reference policy;
  std::string to;
  std::string name = "policy";

  std::vector<std::string> makes() const override { return {"export"}; }
  bool random() const override { return false; }
  std::vector<const ComponentInfo*> uses() const override {
    const ComponentInfo* exporter = Catalogue::instance().find(Exporter::kInterface, to);
    if (exporter == nullptr) return {};
    return {exporter};
  }

  void check() const {
    Rules rules;
    const bool well_named = rules.check("name", [&] { check_export_name(name); });
    std::shared_ptr<const Exporter> exporter;
    rules.check("to", [&] { exporter = make_exporter(to); });
    if (exporter && well_named) rules.check("name", [&] { exporter->check_name(name); });
    rules.enforce();
  }

  /// What was not learned in this experiment is tried when planning.
  void check(const NodeContext& context) const override {
    const InputNode& input = context.inputs("policy").front();
    if (input.kind != "policy") return;
    const std::string file(input.element->get("file"));
    PolicyFile content;
    if (!file.empty()) {
      content = read_policy_file(file);
    } else {
      content.component = input.element->children.front();
    }
    if (input.spaces) content.spaces = *input.spaces;
    Rules rules;
    rules.check("policy", [&] { exported(content, input.id); });
    rules.enforce();
  }

  void run(NodeContext& context) const override {
    const InputNode& input = context.inputs("policy").front();
    write_file(context.folder() / (name + "." + make_exporter(to)->extension()),
               exported(read_policy_file(input.folder / kPolicyFile), input.id));
  }

  static Parameters<ExportNode> parameters() {
    return node_parameters<ExportNode>()
        .reference("policy", &ExportNode::policy, "policy", "What to export.")
        .require("to", &ExportNode::to, "", "The format: cpp, dot, json, onnx, or another exporter.")
        .add("name", &ExportNode::name, "",
             "Name of the file without its extension, and of the namespace in a C++ header.");
  }

 private:
  std::string exported(const PolicyFile& file, const std::string& policy_id) const {
    if (file.spaces.actions.empty()) {
      throw std::invalid_argument(fmt::format(
          "an export needs to know states and actions: give policy '{}' a problem=\"...\"", policy_id));
    }
    const MadePolicy made = make_policy(file);
    made.object->prepare(file.spaces, nullptr);
    return make_exporter(to)->write(exported_policy(name, made, file, file.spaces));
  }
};

const Component<Node, ExportNode> kExportNode("export",
                                              "Write a policy for programs on robots and elsewhere.",
                                              "no publication");

}  // namespace
}  // namespace coppice
