#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "engine/vocabulary/exporter.h"

namespace coppice {
namespace {

/// Nodes that are drawn at most: more make a drawing that nobody can read, and that takes minutes.
constexpr std::size_t kMaxNodes = 500;

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  }
  return result;
}

/// "0.5 + 2 position - speed"
std::string linear_text(double bias, const double* slopes, const Space& axes) {
  std::string text = fmt::format("{:.4g}", bias);
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if (slopes[i] == 0) continue;
    text += fmt::format(" {} {:.4g} {}", slopes[i] < 0 ? '-' : '+', slopes[i] < 0 ? -slopes[i] : slopes[i],
                        axes[i].name);
  }
  return text;
}

struct Drawing {
  const ExportedPolicy& policy;
  std::string text{};

  const Space& states() const { return policy.spaces.states; }
  std::string output_name(std::size_t o) const { return policy.action().axes[o].name; }

  void box(const std::string& id, const std::string& label) {
    text += fmt::format("  {} [label=\"{}\"];\n", id, escaped(label));
  }
  void note(const std::string& label) { text += fmt::format("  label=\"{}\";\n", escaped(label)); }

  void draw(const ConstantModel& model) {
    for (std::size_t o = 0; o < model.values.size(); ++o)
      box(fmt::format("o{}", o), fmt::format("{} = {:.6g}", output_name(o), model.values[o]));
  }
  void draw(const LinearModel& model) {
    for (std::size_t o = 0; o < model.bias.size(); ++o) {
      box(fmt::format("o{}", o),
          fmt::format("{} = {}", output_name(o),
                      linear_text(model.bias[o], &model.slopes[o * states().size()], states())));
    }
  }
  void draw(const ForestModel& model);
  std::string split_text(const ForestModel& model, const ForestModel::Node& node) const;
  void draw_tree(const ForestModel& model, std::size_t output, std::size_t tree, std::size_t depth);
};

/// Depth of each node below its root, and how many leaves are at or below it.
struct Shape {
  std::vector<std::size_t> depth, leaves;
  explicit Shape(const ForestModel::Tree& tree) : depth(tree.nodes.size()), leaves(tree.nodes.size(), 1) {
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
      if (tree.nodes[i].is_leaf()) continue;
      depth[tree.nodes[i].child] = depth[tree.nodes[i].child + 1] = depth[i] + 1;
    }
    for (std::size_t i = tree.nodes.size(); i-- > 0;) {
      const std::size_t child = tree.nodes[i].child;
      if (child != 0) leaves[i] = leaves[child] + leaves[child + 1];
    }
  }
};

/// Nodes of all trees at each depth.
std::vector<std::size_t> nodes_by_depth(const ForestModel& model) {
  std::vector<std::size_t> counts;
  for (const ForestModel::Output& output : model.outputs) {
    for (const ForestModel::Tree& tree : output.trees) {
      for (const std::size_t depth : Shape(tree).depth) {
        if (depth >= counts.size()) counts.resize(depth + 1);
        ++counts[depth];
      }
    }
  }
  return counts;
}

void Drawing::draw(const ForestModel& model) {
  const std::vector<std::size_t> counts = nodes_by_depth(model);
  std::size_t depth = 0, drawn = counts.front();
  while (depth + 1 < counts.size() && drawn + counts[depth + 1] <= kMaxNodes) drawn += counts[++depth];
  const std::size_t trees =
      std::min(model.trees(), std::max<std::size_t>(1, kMaxNodes / model.outputs.size()));
  std::string label = fmt::format("{}: {} of {} trees for each output", policy.name,
                                  model.trimmed ? "trimmed mean" : "mean", model.trees());
  if (trees < model.trees()) label += fmt::format("; the first {} are drawn", trees);
  if (depth + 1 < counts.size())
    label += fmt::format("; {} of {} levels are drawn", depth + 1, counts.size());
  note(label);
  for (std::size_t o = 0; o < model.outputs.size(); ++o) {
    for (std::size_t t = 0; t < trees; ++t) draw_tree(model, o, t, depth);
  }
}

std::string Drawing::split_text(const ForestModel& model, const ForestModel::Node& node) const {
  const auto threshold = static_cast<double>(node.value);
  if (node.index < model.inputs) return fmt::format("{} <= {:.6g}", states()[node.index].name, threshold);
  const double* row = &model.directions[(node.index - model.inputs) * (model.inputs + 1)];
  return fmt::format("{} <= {:.6g}", linear_text(row[0], row + 1, states()), threshold);
}

void Drawing::draw_tree(const ForestModel& model, std::size_t output, std::size_t tree, std::size_t depth) {
  const ForestModel::Output& forest = model.outputs[output];
  const ForestModel::Tree& drawn = forest.trees[tree];
  const Shape shape(drawn);
  const auto id = [&](std::size_t node) { return fmt::format("o{}t{}n{}", output, tree, node); };
  text += fmt::format("  subgraph cluster_o{}t{} {{\n", output, tree);
  note(fmt::format("{}, tree {}", output_name(output), tree + 1));
  for (std::size_t i = 0; i < drawn.nodes.size(); ++i) {
    const ForestModel::Node& node = drawn.nodes[i];
    if (shape.depth[i] > depth) continue;
    if (node.is_leaf() && model.linear_leaves) {
      const double* row = &drawn.models[node.index * model.width()];
      box(id(i), linear_text(row[0], row + 1, states()));
    } else if (node.is_leaf()) {
      box(id(i), fmt::format("{:.6g}", forest.offset + forest.scale * static_cast<double>(node.value)));
    } else if (shape.depth[i] == depth) {
      box(id(i), fmt::format("... {} leaves", shape.leaves[i]));
    } else {
      box(id(i), split_text(model, node));
      text += fmt::format("  {} -> {} [label=yes];\n  {} -> {} [label=no];\n", id(i), id(node.child), id(i),
                          id(node.child + 1));
    }
  }
  text += "  }\n";
}

/// The trees as Graphviz draws them, as far as people can read them.
class DotExporter : public Exporter {
 public:
  std::string extension() const override { return "dot"; }
  std::string write(const ExportedPolicy& policy) const override {
    if (policy.action().axes.empty()) {
      throw std::invalid_argument(
          fmt::format("action '{}' has no parameters: there is nothing to draw", policy.action().name));
    }
    Drawing drawing{policy};
    std::visit([&drawing](const auto& model) { drawing.draw(model); }, policy.model.function);
    return fmt::format("digraph {} {{\n  node [shape=box, fontname=\"sans-serif\"];\n{}}}\n",
                       "policy_" + policy.name, drawing.text);
  }
  static Parameters<DotExporter> parameters() { return {}; }
};

const Component<Exporter, DotExporter> kDotExporter("dot", "The trees, for Graphviz to draw.",
                                                    "no publication");

}  // namespace
}  // namespace coppice
