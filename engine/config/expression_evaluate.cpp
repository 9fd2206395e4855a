#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <optional>

#include "engine/config/expression_tree.h"
#include "registry/suggest.h"
#include "registry/text.h"

namespace coppice::config {
namespace {

using Kind = ExpressionNode::Kind;

Value lookup(const ExpressionNode& node, const Names& names) {
  if (const Value* value = names.find(node.text)) return *value;
  if (node.text == "dirname") return Value::text(names.folder());  // as $(dirname), which has no parentheses
  throw names.unknown(node.text, node.offset);
}

Value evaluate_node(const ExpressionNode& node, const Names& names);

/// The part of a conditional that is not evaluated may divide by zero, but not use names that do not exist.
void require_names(const ExpressionNode& node, const Names& names) {
  try {
    if (node.kind == Kind::name) lookup(node, names);
  } catch (const AlreadyReported&) {  // its value does not matter here
  }
  for (const Tree& child : node.children) require_names(*child, names);
}

bool truth(const ExpressionNode& node, const Names& names, std::string_view role) {
  const Value value = evaluate_node(node, names);
  if (const bool* truth_value = value.as_boolean()) return *truth_value;
  throw node.error(fmt::format("{} must be true or false, not {}", role, value.description()),
                   "compare it: x > 0");
}

/// An operand beside one that is not known, which might have kept it from being evaluated at all.
std::optional<bool> decided(const ExpressionNode& node, const Names& names, std::string_view role) {
  try {
    return truth(node, names, role);
  } catch (const ExpressionError&) {
    require_names(node, names);
  } catch (const AlreadyReported&) {
  }
  return std::nullopt;
}

Value logical(const ExpressionNode& node, const Names& names) {
  const std::string role = fmt::format("an operand of '{}'", node.text);
  bool left = false;
  try {
    left = truth(*node.children[0], names, role);
  } catch (const AlreadyReported&) {
    const std::optional<bool> right = decided(*node.children[1], names, role);
    if (right && *right == (node.text == "or")) return Value::boolean(*right);
    throw;
  }
  if (left == (node.text == "or")) {
    require_names(*node.children[1], names);
    return Value::boolean(left);
  }
  return Value::boolean(truth(*node.children[1], names, role));
}

Value conditional(const ExpressionNode& node, const Names& names) {
  const bool holds = truth(*node.children[1], names, "the condition");
  require_names(*node.children[holds ? 2 : 0], names);
  return evaluate_node(*node.children[holds ? 0 : 2], names);
}

Value pick(const ExpressionNode& node, const Names& names) {
  const Value selector = evaluate_node(*node.children[0], names);
  std::vector<std::string> keys;
  const ExpressionNode* chosen = nullptr;
  for (std::size_t i = 0; i < node.keys.size(); ++i) {
    const ExpressionNode& choice = *node.children[i + 1];
    keys.push_back(node.keys[i].to_text());
    if (equal(selector, node.keys[i]).value_or(false)) {
      chosen = &choice;
    } else {
      require_names(choice, names);
    }
  }
  if (chosen == nullptr) {
    throw node.children[0]->error(fmt::format("pick has no key '{}'", selector.to_text()),
                                  fmt::format("its keys: {}", join(keys)));
  }
  return evaluate_node(*chosen, names);
}

Value index(const ExpressionNode& node, const Names& names) {
  const Value value = evaluate_node(*node.children[0], names);
  const Value position = evaluate_node(*node.children[1], names);
  const List* list = value.as_list();
  if (list == nullptr) {
    throw node.children[0]->error(fmt::format("only a list has an index, not {}", value.description()));
  }
  const double* number = position.as_plain_number();
  if (number == nullptr || *number != std::floor(*number)) {
    throw node.children[1]->error(fmt::format("an index must be an integer, not {}", position.description()));
  }
  if (!(*number >= 0 && *number < static_cast<double>(list->size()))) {
    throw node.children[1]->error(
        fmt::format("index {} is outside of a list of {}", position.to_text(), list->size()),
        list->empty() ? "the list is empty" : fmt::format("valid: 0 to {}", list->size() - 1));
  }
  return (*list)[static_cast<std::size_t>(*number)];
}

Value negate(const ExpressionNode& node, const Names& names) {
  const Value value = evaluate_node(*node.children[0], names);
  const Quantity* quantity = value.as_quantity();
  if (quantity == nullptr) {
    throw node.children[0]->error(fmt::format("'{}' needs a number, not {}", node.text, value.description()));
  }
  if (node.kind == Kind::plus) return value;
  return Value::quantity({-quantity->value, quantity->dimension});
}

Value environment(const ExpressionNode& node, const Names& names) {
  const Value name = evaluate_node(*node.children[0], names);
  if (name.as_text() == nullptr) throw node.children[0]->error("env needs a name, such as env(HOME)");
  if (const char* value = std::getenv(name.as_text()->c_str())) {
    if (node.children.size() > 1) require_names(*node.children[1], names);
    return Value::inferred(value);
  }
  if (node.children.size() > 1) return evaluate_node(*node.children[1], names);
  throw node.children[0]->error(fmt::format("there is no environment variable '{}'", *name.as_text()),
                                "env(NAME, default) gives a default");
}

Value call(const ExpressionNode& node, const Names& names) {
  if (node.text == "pick") return pick(node, names);
  if (node.text == "env") return environment(node, names);
  std::vector<Value> arguments;
  for (const Tree& child : node.children) arguments.push_back(evaluate_node(*child, names));
  return call_function(node, arguments, names);
}

Value evaluate_node(const ExpressionNode& node, const Names& names) {
  switch (node.kind) {
    case Kind::literal:
      return node.value;
    case Kind::name:
      return lookup(node, names);
    case Kind::call:
      return call(node, names);
    case Kind::index:
      return index(node, names);
    case Kind::negate:
    case Kind::plus:
      return negate(node, names);
    case Kind::logical:
      return logical(node, names);
    case Kind::conditional:
      return conditional(node, names);
    case Kind::logical_not:
      return Value::boolean(!truth(*node.children[0], names, "the operand of 'not'"));
    case Kind::list: {
      List items;
      for (const Tree& child : node.children) items.push_back(evaluate_node(*child, names));
      return Value::list(std::move(items));
    }
    case Kind::binary:
      break;
  }
  const Value left = evaluate_node(*node.children[0], names);
  return apply_operator(node, left, evaluate_node(*node.children[1], names));
}

}  // namespace

Value Expression::evaluate(const Names& names) const {
  return evaluate_node(*root_, names);
}

}  // namespace coppice::config
