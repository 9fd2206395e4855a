#include "engine/graph/planned_context.h"

#include <stdexcept>

namespace coppice {
namespace {

[[noreturn]] void only_while_running() {
  throw std::logic_error("a node asked for what it has only while it runs");
}

InputNode input_node(const Plan& plan, const PlannedNode& node, const std::filesystem::path& run_folder) {
  InputNode input;
  input.id = node.id;
  input.kind = node.kind;
  input.point = node.point;
  input.replicate = node.replicate;
  input.element = node.resolved;
  input.problem = node.node->problem();
  if (!node.definition && !run_folder.empty()) {
    input.folder = run_folder / node.folder;
  }
  input.key = node.key;
  input.labels = node.labels;
  input.units = node.units;
  input.streams = node.streams;
  input.makes = node.node->makes();
  if (node.training) input.training = plan.nodes[*node.training].key;
  input.columns = node.columns;
  input.progress_columns = node.progress_columns;
  input.spaces = node.spaces;
  return input;
}

}  // namespace

PlannedContext::PlannedContext(const Plan& plan, std::size_t node, const std::filesystem::path& run_folder)
    : node_(plan.nodes[node]), seed_(plan.experiment.seed) {
  for (const PlannedInput& input : node_.inputs) {
    std::vector<InputNode>& list = inputs_[input.parameter];
    list.reserve(input.nodes.size());
    for (const std::size_t i : input.nodes) list.push_back(input_node(plan, plan.nodes[i], run_folder));
  }
}

const std::vector<InputNode>& PlannedContext::inputs(std::string_view parameter) const {
  static const std::vector<InputNode> kNone;
  const auto found = inputs_.find(parameter);
  return found == inputs_.end() ? kNone : found->second;
}

Draws PlannedContext::draws() const {
  const std::string& label = node_.node->seed_label.empty() ? node_.kind : node_.node->seed_label;
  return {seed_, label, static_cast<std::uint64_t>(node_.replicate.value_or(0))};
}

const std::string& PlannedContext::stream() const {
  static const std::string kNone;
  return node_.streams.empty() ? kNone : node_.streams.front();
}

const std::filesystem::path& PlannedContext::folder() const {
  only_while_running();
}
Parallel& PlannedContext::parallel() {
  only_while_running();
}
void PlannedContext::count(std::string_view, std::int64_t) {
  only_while_running();
}
void PlannedContext::measure(std::string_view, double) {
  only_while_running();
}
void PlannedContext::progress(std::int64_t, std::int64_t) {
  only_while_running();
}
std::optional<Archive> PlannedContext::checkpoint() {
  only_while_running();
}
void PlannedContext::save_checkpoint(const Archive&) {
  only_while_running();
}

}  // namespace coppice
