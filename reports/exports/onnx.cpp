#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "engine/vocabulary/exporter.h"
#include "reports/exports/onnx_graph.h"

namespace coppice {
namespace {

using Name = OnnxGraph::Name;

std::vector<float> singles(const std::vector<double>& values) {
  std::vector<float> result;
  for (const double value : values) result.push_back(static_cast<float>(value));
  return result;
}

std::int64_t signed_size(std::size_t size) {
  return static_cast<std::int64_t>(size);
}

/// The attributes of TreeEnsembleRegressor (ai.onnx.ml 3). A leaf adds numbers to several targets: its
/// constant to its output, or its linear model's numbers to a target each, since the sum of linear models is
/// the linear model of the sums.
class TreeAttributes {
 public:
  void add(const ForestModel& model) {
    for (std::size_t o = 0; o < model.outputs.size(); ++o) {
      for (const ForestModel::Tree& tree : model.outputs[o].trees) add(tree, model, o);
    }
  }

  std::vector<OnnxAttribute> attributes(std::size_t targets) const {
    return {{"n_targets", signed_size(targets)},
            {"aggregate_function", "SUM"},
            {"post_transform", "NONE"},
            {"nodes_treeids", trees_},
            {"nodes_nodeids", nodes_},
            {"nodes_featureids", features_},
            {"nodes_values", values_},
            {"nodes_modes", modes_},
            {"nodes_truenodeids", yes_},
            {"nodes_falsenodeids", no_},
            {"nodes_missing_value_tracks_true", nan_is_yes_},
            {"target_treeids", target_trees_},
            {"target_nodeids", target_nodes_},
            {"target_ids", target_ids_},
            {"target_weights", weights_}};
  }

 private:
  void add(const ForestModel::Tree& tree, const ForestModel& model, std::size_t output) {
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
      const ForestModel::Node& node = tree.nodes[i];
      const auto child = static_cast<std::int64_t>(node.child);
      trees_.push_back(tree_);
      nodes_.push_back(signed_size(i));
      features_.push_back(node.is_leaf() ? 0 : static_cast<std::int64_t>(node.index));
      values_.push_back(node.is_leaf() ? 0 : node.value);
      modes_.emplace_back(node.is_leaf() ? "LEAF" : "BRANCH_LEQ");
      yes_.push_back(child);
      no_.push_back(node.is_leaf() ? 0 : child + 1);
      nan_is_yes_.push_back(1);  // a NaN is not above any threshold
      if (!node.is_leaf()) continue;
      if (!model.linear_leaves) {
        add_weight(i, output, node.value);
        continue;
      }
      for (std::size_t k = 0; k < model.width(); ++k) {
        add_weight(i, output * model.width() + k,
                   static_cast<float>(tree.models[node.index * model.width() + k]));
      }
    }
    ++tree_;
  }
  void add_weight(std::size_t node, std::size_t target, float weight) {
    target_trees_.push_back(tree_);
    target_nodes_.push_back(signed_size(node));
    target_ids_.push_back(signed_size(target));
    weights_.push_back(weight);
  }

  std::int64_t tree_ = 0;
  std::vector<std::int64_t> trees_, nodes_, features_, yes_, no_, nan_is_yes_, target_trees_, target_nodes_,
      target_ids_;
  std::vector<float> values_, weights_;
  std::vector<std::string_view> modes_;
};

/// Puts the action together, operator by operator.
class Writer {
 public:
  Writer(const ExportedPolicy& policy, OnnxGraph& graph)
      : policy_(policy), graph_(graph), state_(graph.input("state", policy.spaces.states.size())) {}

  void write() {
    const Name value =
        std::visit([this](const auto& model) { return function(model); }, policy_.model.function);
    graph_.output("action", inside(value), axes().size());
  }

 private:
  const Space& axes() const { return policy_.action().axes; }
  Name row(const std::vector<double>& values) {
    return graph_.constant({1, signed_size(values.size())}, singles(values));
  }

  /// As many rows as the state has.
  Name function(const ConstantModel& model) {
    const Name rows = graph_.node("Shape", {state_}, {{"start", std::int64_t{0}}, {"end", std::int64_t{1}}});
    const Name columns = graph_.constant(std::vector<std::int64_t>{signed_size(model.values.size())});
    const Name shape = graph_.node("Concat", {rows, columns}, {{"axis", std::int64_t{0}}});
    return graph_.node("Expand", {row(model.values), shape});
  }

  Name function(const LinearModel& model) {
    const Name slopes = graph_.constant(
        {signed_size(model.bias.size()), signed_size(policy_.spaces.states.size())}, singles(model.slopes));
    return graph_.node("Gemm", {state_, slopes, row(model.bias)}, {{"transB", std::int64_t{1}}});
  }

  Name function(const ForestModel& model) {
    if (model.trimmed) {
      throw std::invalid_argument(
          "ONNX's TreeEnsembleRegressor sums the trees; it cannot express their trimmed mean (cpp and json "
          "can)");
    }
    if (!model.directions.empty()) {
      throw std::invalid_argument(
          "ONNX's TreeEnsembleRegressor splits by single inputs; it cannot express oblique splits (cpp and "
          "json "
          "can)");
    }
    TreeAttributes trees;
    trees.add(model);
    const std::size_t targets = model.outputs.size() * (model.linear_leaves ? model.width() : 1);
    const Name sum = graph_.node("TreeEnsembleRegressor", {state_}, trees.attributes(targets), true);
    if (model.linear_leaves) return linear_leaves(model, sum);
    std::vector<double> scale, offset;
    for (const ForestModel::Output& output : model.outputs) {
      scale.push_back(output.scale / static_cast<double>(model.trees()));
      offset.push_back(output.offset);
    }
    return graph_.node("Add", {graph_.node("Mul", {sum, row(scale)}), row(offset)});
  }

  /// From the sums of bias, slopes and range over trees.
  Name linear_leaves(const ForestModel& model, const Name& sum) {
    const std::int64_t inputs = signed_size(model.inputs), outputs = signed_size(model.outputs.size());
    const Name models = reshaped(sum, {0, outputs, inputs + 3});
    const Name x = reshaped(state_, {0, 1, inputs});
    const Name products = graph_.node("Mul", {part(models, 1, inputs + 1), x});
    const Name feedback = graph_.node("ReduceSum", {products, graph_.constant(std::vector<std::int64_t>{2})});
    const Name value = graph_.node("Add", {part(models, 0, 1), feedback});
    const Name above = graph_.node("Max", {value, part(models, inputs + 1, inputs + 2)});
    const Name held = graph_.node("Min", {above, part(models, inputs + 2, inputs + 3)});
    const std::vector<double> share(model.outputs.size(), 1 / static_cast<double>(model.trees()));
    return graph_.node("Mul", {reshaped(held, {0, outputs}), row(share)});
  }
  Name reshaped(const Name& value, const std::vector<std::int64_t>& shape) {
    return graph_.node("Reshape", {value, graph_.constant(shape)});
  }
  Name part(const Name& models, std::int64_t from, std::int64_t to) {
    const auto number = [this](std::int64_t n) { return graph_.constant(std::vector<std::int64_t>{n}); };
    return graph_.node("Slice", {models, number(from), number(to), number(2)});
  }

  /// Moved into the action's box, as clamp_in_place does it.
  Name inside(Name value) {
    std::vector<double> low, high, centre, width;
    std::vector<std::uint8_t> wraps;
    for (const Axis& axis : axes()) {
      const bool bounded = std::isfinite(axis.low) && std::isfinite(axis.high);
      low.push_back(axis.low);
      high.push_back(axis.high);
      centre.push_back(bounded ? axis.low / 2 + axis.high / 2 : std::clamp(0.0, axis.low, axis.high));
      wraps.push_back(axis.circular && bounded && axis.high > axis.low ? 1 : 0);
      width.push_back(wraps.back() != 0 ? axis.high - axis.low : 1);
    }
    const Name least = row(low), most = row(high);
    value = graph_.node("Where", {graph_.node("IsNaN", {value}), row(centre), value});
    if (std::count(wraps.begin(), wraps.end(), 1) != 0) {
      const Name below = graph_.node("Less", {value, least}), above = graph_.node("Greater", {value, most});
      const Name finite =
          graph_.node("LessOrEqual", {graph_.node("Abs", {value}), row({std::numeric_limits<float>::max()})});
      const Name outside = graph_.node("And", {graph_.node("Or", {below, above}), finite});
      const Name turns = graph_.node(
          "Floor", {graph_.node("Div", {graph_.node("Sub", {value, finite_low(wraps)}), row(width)})});
      const Name wrapped = graph_.node("Sub", {value, graph_.node("Mul", {row(width), turns})});
      value = graph_.node("Where", {graph_.node("And", {outside, graph_.constant(wraps)}), wrapped, value});
    }
    return graph_.node("Min", {graph_.node("Max", {value, least}), most});
  }
  Name finite_low(const std::vector<std::uint8_t>& wraps) {
    std::vector<double> low;
    for (std::size_t i = 0; i < wraps.size(); ++i) low.push_back(wraps[i] != 0 ? axes()[i].low : 0);
    return row(low);
  }

  const ExportedPolicy& policy_;
  OnnxGraph& graph_;
  Name state_;
};

std::string axes_text(const Space& axes) {
  std::string text;
  for (const Axis& axis : axes) {
    text +=
        fmt::format("{}{}{}{} [{}, {}]{}", text.empty() ? "" : "; ", axis.name, axis.unit.empty() ? "" : " ",
                    axis.unit, axis.low, axis.high, axis.circular ? " circular" : "");
  }
  return text;
}

/// Forests become TreeEnsembleRegressor, everything else ordinary operators, in single precision.
class OnnxExporter : public Exporter {
 public:
  std::string extension() const override { return "onnx"; }
  bool binary() const override { return true; }
  std::string write(const ExportedPolicy& policy) const override {
    if (policy.action().axes.empty()) {
      throw std::invalid_argument(fmt::format(
          "action '{}' has no parameters, and ONNX has no tensors without columns", policy.action().name));
    }
    OnnxGraph graph(policy.name);
    Writer(policy, graph).write();
    return graph.model(policy.writer, {{"component", policy.component},
                                       {"provenance", policy.provenance},
                                       {"action_id", std::to_string(policy.model.action)},
                                       {"action_name", policy.action().name},
                                       {"states", axes_text(policy.spaces.states)},
                                       {"actions", axes_text(policy.action().axes)}});
  }
  static Parameters<OnnxExporter> parameters() { return {}; }
};

const Component<Exporter, OnnxExporter> kOnnxExporter(
    "onnx", "ONNX in single precision: TreeEnsembleRegressor for forests, ordinary operators for the rest.",
    "onnx.ai/onnx/operators");

}  // namespace
}  // namespace coppice
