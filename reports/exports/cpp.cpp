#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "engine/vocabulary/exporter.h"
#include "reports/exports/cpp_text.h"
#include "reports/exports/identifiers.h"

namespace coppice {
namespace {

/// A literal of exactly this value.
std::string literal(double value) {
  if (std::isinf(value)) return value > 0 ? "detail::kInfinity" : "-detail::kInfinity";
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

std::string literal(float value) {
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text + "f";
}

/// Text between quotes, in a comment or in a literal: other bytes than printable ASCII become question marks.
std::string plain(const std::string& text, bool quoted) {
  std::string result;
  for (const char c : text) {
    if (quoted && (c == '"' || c == '\\')) result += '\\';
    result += c >= ' ' && c <= '~' ? c : '?';
  }
  if (!quoted && !result.empty() && result.back() == '\\') result += '.';  // would join the next line
  return result;
}

/// The items of an array, wrapped at 110 columns.
class Items {
 public:
  void add(const std::string& item) {
    if (column_ + item.size() + 2 > 110) {
      text_ += "\n    ";
      column_ = 4;
    } else if (column_ > 4) {
      text_ += ' ';
      ++column_;
    }
    text_ += item + ',';
    column_ += item.size() + 1;
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_ = "\n    ";
  std::size_t column_ = 4;
};

std::string array(const std::string& type, const std::string& name, const std::string& items) {
  return fmt::format("inline constexpr {} {}[] = {{{}}};\n", type, name, items);
}

std::string numbers(const std::vector<double>& values) {
  Items items;
  for (const double value : values) items.add(literal(value));
  return items.text();
}

std::string range(const Axis& axis) {
  return fmt::format("{}{}from {} to {}{}", plain(axis.unit, false), axis.unit.empty() ? "" : ", ", axis.low,
                     axis.high, axis.circular ? ", circular" : "");
}

/// A struct with a member for each axis.
std::string members(const std::string& name, const Space& axes) {
  const std::vector<std::string> names = identifiers(axes);
  std::string text = fmt::format("struct {} {{\n", name);
  for (std::size_t i = 0; i < axes.size(); ++i)
    text += fmt::format("  double {} = 0;  ///< {}\n", names[i], range(axes[i]));
  return text + "};\n";
}

std::string axes_table(const std::string& name, const Space& axes) {
  if (axes.empty()) return "";
  std::string items;
  for (const Axis& axis : axes) {
    items += fmt::format("\n    {{\"{}\", \"{}\", {}, {}, {}}},", plain(axis.name, true),
                         plain(axis.unit, true), literal(axis.low), literal(axis.high), axis.circular);
  }
  return array("Axis", name, items);
}

std::string function(const ConstantModel& model) {
  if (model.values.empty()) return std::string(kCppNothing);
  return array("double", "kValues", numbers(model.values)) + std::string(kCppConstant);
}

std::string function(const LinearModel& model) {
  return array("double", "kSlopes", numbers(model.slopes)) + array("double", "kBias", numbers(model.bias)) +
         std::string(model.bias_last ? kCppBiasLast : kCppLinear);
}

constexpr std::uint32_t kMaxAhead = (1u << 24) - 1;  // places; and rows, which a float has to hold exactly

[[noreturn]] void too_large() {
  throw std::invalid_argument("a C++ header holds at most 2^24 nodes in a tree, and 2^24 linear leaves");
}

/// A node as the header has it: {threshold, input, places to its first child}; of a leaf its constant or
/// the row of its model in place of the threshold, and 0 places.
std::string node_text(const ForestModel& model, const ForestModel::Node& node, std::size_t at,
                      std::size_t first_row) {
  if (!node.is_leaf()) {
    if (node.child - at > kMaxAhead) too_large();
    return fmt::format("{{{}, {}, {}}}", literal(node.value), node.index, node.child - at);
  }
  if (!model.linear_leaves) return fmt::format("{{{}, {}, 0}}", literal(node.value), model.features());
  const std::size_t row = first_row + node.index;
  if (row > kMaxAhead) too_large();
  return fmt::format("{{{}, {}, 0}}", literal(static_cast<float>(row)), model.features());
}

std::string function(const ForestModel& model) {
  Items nodes, roots, rows, scales;
  std::size_t size = 0, first_row = 0;
  for (const ForestModel::Output& output : model.outputs) {
    scales.add(fmt::format("{{{}, {}}}", literal(output.offset), literal(output.scale)));
    for (const ForestModel::Tree& tree : output.trees) {
      roots.add(std::to_string(size));
      for (std::size_t i = 0; i < tree.nodes.size(); ++i)
        nodes.add(node_text(model, tree.nodes[i], i, first_row));
      for (const double number : tree.models) rows.add(literal(number));
      size += tree.nodes.size();
      first_row += tree.models.size() / model.width();
    }
  }
  std::string text = std::string(kCppNode) + array("Node", "kNodes", nodes.text()) +
                     array("std::uint32_t", "kRoots", roots.text()) +
                     fmt::format("inline constexpr std::size_t kTrees = {};\n", model.trees());
  text += model.linear_leaves ? array("double", "kModels", rows.text())
                              : std::string(kCppScale) + array("Scale", "kScales", scales.text());
  text += kCppDescent;
  text += model.linear_leaves ? kCppLinearLeaf : std::string_view();
  if (model.trimmed) {
    text += fmt::format("\ninline constexpr std::size_t kTrimmed = {};  // on each side\n", *model.trimmed);
    text += kCppTrimmed;
    text += model.linear_leaves ? kCppTrimmedOfLinear : kCppTrimmedOfConstants;
  } else {
    text += model.linear_leaves ? kCppMeanOfLinear : kCppMeanOfConstants;
  }
  if (model.directions.empty()) return text + std::string(kCppForest);
  text += fmt::format(
      "\n/// Of oblique splits: rows of offset and weights.\ninline constexpr std::size_t "
      "kDirectionCount = {};\n",
      model.direction_count());
  return text + array("double", "kDirections", numbers(model.directions)) + std::string(kCppObliqueForest);
}

/// The header's functions over structs: call act with arrays.
std::string struct_act(const ExportedPolicy& policy) {
  std::string text = "/// The action in a state.\ninline Action act(const State& state) noexcept {\n";
  std::string inputs;
  for (const std::string& name : identifiers(policy.spaces.states))
    inputs += (inputs.empty() ? "" : ", ") + ("state." + name);
  text += fmt::format("  const double x[kStateSize] = {{{}}};\n", inputs);
  const std::vector<std::string> names = identifiers(policy.action().axes);
  if (names.empty()) return text + "  act(x, nullptr);\n  return {};\n}\n";
  std::string outputs;
  for (std::size_t i = 0; i < names.size(); ++i) outputs += (i == 0 ? "" : ", ") + fmt::format("y[{}]", i);
  return text + fmt::format("  double y[kActionSize] = {{}};\n  act(x, y);\n  return {{{}}};\n}}\n", outputs);
}

/// A C++17 header of constant tables and a loop.
class CppExporter : public Exporter {
 public:
  std::string extension() const override { return "h"; }
  void check_name(const std::string& name) const override {
    if (identifiers({{name, "", 0, 0}}).front() == name) return;
    throw std::invalid_argument(
        fmt::format("'{}' has a meaning of its own in C++: give the export another name", name));
  }
  std::string write(const ExportedPolicy& policy) const override {
    check_name(policy.name);
    std::string guard = policy.name;
    for (char& c : guard) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    const Space& states = policy.spaces.states;
    const Space& actions = policy.action().axes;
    const std::string first_state = identifiers(states).front();
    std::string text = fmt::format(kCppTop, fmt::arg("writer", plain(policy.writer, false)),
                                   fmt::arg("name", policy.name), fmt::arg("component", policy.component),
                                   fmt::arg("provenance", plain(policy.provenance, false)),
                                   fmt::arg("state", first_state), fmt::arg("guard", guard));
    text += members("State", states);
    text += fmt::format("\n/// The parameters of action {} ({}), inside their ranges.\n", policy.model.action,
                        plain(policy.action().name, false));
    text += members("Action", actions);
    text += fmt::format(kCppConstants, fmt::arg("states", states.size()), fmt::arg("actions", actions.size()),
                        fmt::arg("id", policy.model.action),
                        fmt::arg("provenance", plain(policy.provenance, true)));
    text += axes_table("kStates", states) + axes_table("kActions", actions);
    text += kCppProduct;
    text += std::visit([](const auto& model) { return function(model); }, policy.model.function);
    if (!actions.empty()) text += kCppClamp;
    text += "\n}  // namespace detail\n";
    text += actions.empty() ? kCppActWithoutParameters : kCppAct;
    text += struct_act(policy);
    return text + fmt::format("\n}}  // namespace {}\n\n#endif\n", policy.name);
  }
  static Parameters<CppExporter> parameters() { return {}; }
};

const Component<Exporter, CppExporter> kCppExporter(
    "cpp", "One C++17 header: constant tables and a loop, the same bits, no heap, nothing to link.",
    "no publication");

}  // namespace
}  // namespace coppice
