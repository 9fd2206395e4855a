#include <fmt/format.h>

#include <cmath>

#include "engine/config/expression_tree.h"
#include "engine/vocabulary/elementary.h"

namespace coppice::config {
namespace {

constexpr int kLargestExponent = 9;  // as in registry/units.h: what can be written can be read back

ExpressionError mismatch(const ExpressionNode& node, const Value& left, const Value& right) {
  return node.error(fmt::format("'{}' needs the same dimension on both sides: {}; {}", node.text,
                                left.description(), right.description()));
}

Value make(const ExpressionNode& node, double value, const Dimension& dimension, const Quantity& a,
           const Quantity& b) {
  for (const int exponent : dimension) {
    if (std::abs(exponent) > kLargestExponent) {
      throw node.error(
          fmt::format("'{}' gives a quantity in {}, a power too high", node.text, unit_text(dimension)));
    }
  }
  return Value::quantity({checked(value, std::isfinite(a.value) && std::isfinite(b.value), node), dimension});
}

Dimension scaled(const Dimension& dimension, int factor) {
  Dimension result = dimension;
  for (int& exponent : result) exponent *= factor;
  return result;
}

Dimension sum(const Dimension& a, const Dimension& b, int sign) {
  Dimension result = a;
  for (std::size_t i = 0; i < result.size(); ++i) result[i] += sign * b[i];
  return result;
}

/// x^n by repeated squaring: exact where the result is (10 ** 6), and the same on every machine.
double integer_power(double x, int n) {
  double result = 1, square = x;
  for (unsigned left = static_cast<unsigned>(std::abs(n)); left != 0; left >>= 1u) {
    if ((left & 1u) != 0) result *= square;
    if (left > 1) square *= square;
  }
  return n < 0 ? 1 / result : result;
}

Value power(const ExpressionNode& node, const Quantity& base, const Quantity& exponent) {
  constexpr double kSmall = 1024;
  if (exponent.dimension != Dimension{}) {
    throw node.children[1]->error(
        fmt::format("an exponent must be a plain number, not {}", Value::quantity(exponent).description()));
  }
  const bool integer = exponent.value == std::floor(exponent.value) && std::abs(exponent.value) <= kSmall;
  if (base.value == 0 && exponent.value < 0) throw node.error("zero has no negative power");
  if (integer) {
    const int n = static_cast<int>(exponent.value);
    return make(node, integer_power(base.value, n), scaled(base.dimension, n), base, exponent);
  }
  if (base.dimension != Dimension{}) {
    throw node.children[1]->error("a quantity with a unit can only be raised to an integer",
                                  "sqrt(x) halves the unit");
  }
  if (base.value < 0) throw node.children[0]->error("a negative number has only integer powers");
  if (base.value == 0) return make(node, 0, {}, base, exponent);
  return make(node, elementary::pow(base.value, exponent.value), {}, base, exponent);
}

/// The remainder with the sign of the divisor: x - y floor(x / y).
double modulo(double x, double y) {
  const double remainder = std::fmod(x, y);
  return remainder != 0 && (remainder < 0) != (y < 0) ? remainder + y : remainder;
}

Value arithmetic(const ExpressionNode& node, const Value& left, const Value& right) {
  const Quantity &a = *left.as_quantity(), &b = *right.as_quantity();
  const char op = node.text == "**" ? '^' : node.text.front();
  const bool same = a.dimension == b.dimension;
  if ((op == '+' || op == '-' || op == '%') && !same) throw mismatch(node, left, right);
  if ((op == '/' || op == '%') && b.value == 0) throw node.children[1]->error("division by zero");
  switch (op) {
    case '+':
      return make(node, a.value + b.value, a.dimension, a, b);
    case '-':
      return make(node, a.value - b.value, a.dimension, a, b);
    case '*':
      return make(node, a.value * b.value, sum(a.dimension, b.dimension, 1), a, b);
    case '/':
      return make(node, a.value / b.value, sum(a.dimension, b.dimension, -1), a, b);
    case '%':
      return make(node, modulo(a.value, b.value), a.dimension, a, b);
    default:
      return power(node, a, b);
  }
}

Value comparison(const ExpressionNode& node, const Value& left, const Value& right) {
  if (node.text == "==" || node.text == "!=") {
    const std::optional<bool> same = equal(left, right);
    if (!same) {
      throw node.error(
          fmt::format("'{}' cannot compare {} and {}", node.text, left.description(), right.description()));
    }
    return Value::boolean(*same == (node.text == "=="));
  }
  const Quantity *a = left.as_quantity(), *b = right.as_quantity();
  if (a == nullptr || b == nullptr) {
    const Value& wrong = a == nullptr ? left : right;
    throw node.children[a == nullptr ? 0 : 1]->error(
        fmt::format("'{}' compares numbers, not {}", node.text, wrong.description()));
  }
  if (a->dimension != b->dimension) throw mismatch(node, left, right);
  const bool less = a->value<b->value, more = a->value> b->value;
  if (node.text == "<") return Value::boolean(less);
  if (node.text == ">") return Value::boolean(more);
  return Value::boolean(node.text == "<=" ? !more : !less);
}

}  // namespace

double checked(double value, bool finite_operands, const ExpressionNode& node) {
  if (std::isnan(value)) throw node.error(fmt::format("the result of '{}' is not a number", node.text));
  if (std::isinf(value) && finite_operands) throw node.error(fmt::format("'{}' overflows", node.text));
  return value;
}

Value apply_operator(const ExpressionNode& node, const Value& left, const Value& right) {
  const std::string& op = node.text;
  if (op.find_first_of("<>=") != std::string::npos) return comparison(node, left, right);
  if (left.as_quantity() && right.as_quantity()) return arithmetic(node, left, right);
  if (op == "+" && left.as_text() && right.as_text()) return Value::text(*left.as_text() + *right.as_text());
  if (op == "+" && left.as_list() && right.as_list()) {
    if (left.as_list()->size() + right.as_list()->size() > kMostItems)
      throw node.error(fmt::format("a list grows beyond {} items", kMostItems));
    List items = *left.as_list();
    items.insert(items.end(), right.as_list()->begin(), right.as_list()->end());
    return Value::list(std::move(items));
  }
  const bool left_is_wrong = left.as_quantity() == nullptr;
  const bool joins = op == "+" && (left.as_text() || right.as_text());
  throw node.children[left_is_wrong ? 0 : 1]->error(
      fmt::format("'{}' needs numbers, not {}", op, (left_is_wrong ? left : right).description()),
      joins ? "texts are joined by standing side by side: name_${n}" : "");
}

}  // namespace coppice::config
