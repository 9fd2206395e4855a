#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "engine/config/expression_tree.h"
#include "engine/vocabulary/elementary.h"

namespace coppice::config {
namespace {

constexpr std::size_t kMany = 1000;

constexpr auto kFunctions = std::to_array<FunctionInfo>({
    {"abs", 1, 1, "abs(x)"},
    {"ceil", 1, 1, "ceil(x)"},
    {"dirname", 0, 0, "dirname()"},
    {"env", 1, 2, "env(NAME, default)"},
    {"exp", 1, 1, "exp(x)"},
    {"floor", 1, 1, "floor(x)"},
    {"len", 1, 1, "len(list)"},
    {"log", 1, 1, "log(x), the natural logarithm"},
    {"max", 1, kMany, "max(a, b, ...) or max(list)"},
    {"min", 1, kMany, "min(a, b, ...) or min(list)"},
    {"pick", 2, kMany, "pick(selector, key=value, key=value, ...)"},
    {"range", 2, 3, "range(from, to, step), both ends included"},
    {"round", 1, 1, "round(x), halves away from zero"},
    {"sqrt", 1, 1, "sqrt(x)"},
});

ExpressionError wrong(const ExpressionNode& call, std::size_t argument, const std::string& message,
                      const std::string& hint = {}) {
  const ExpressionNode& node = argument < call.children.size() ? *call.children[argument] : call;
  return {node.offset, node.length, message, hint};
}

const Quantity& number_argument(const ExpressionNode& call, const std::vector<Value>& arguments,
                                std::size_t i) {
  if (const Quantity* quantity = arguments[i].as_quantity()) return *quantity;
  throw wrong(call, i, fmt::format("{} needs a number, not {}", call.text, arguments[i].description()));
}

double plain_argument(const ExpressionNode& call, const std::vector<Value>& arguments, std::size_t i) {
  const Quantity& quantity = number_argument(call, arguments, i);
  if (quantity.dimension == Dimension{}) return quantity.value;
  throw wrong(call, i, fmt::format("{} needs a plain number, not {}", call.text, arguments[i].description()),
              "divide by a unit first: x / (1 h)");
}

Value extreme(const ExpressionNode& call, const std::vector<Value>& arguments) {
  const bool is_list = arguments.size() == 1 && arguments[0].as_list() != nullptr;
  const List& items = is_list ? *arguments[0].as_list() : arguments;
  if (items.empty()) throw wrong(call, 0, fmt::format("{} of an empty list", call.text));
  const Value* best = nullptr;
  for (std::size_t i = 0; i < items.size(); ++i) {
    const Quantity* quantity = items[i].as_quantity();
    const std::size_t place = is_list ? 0 : i;
    if (quantity == nullptr) {
      throw wrong(call, place, fmt::format("{} needs numbers, not {}", call.text, items[i].description()));
    }
    if (best != nullptr && quantity->dimension != best->as_quantity()->dimension) {
      throw wrong(call, place,
                  fmt::format("{} needs numbers of the same dimension: {}; {}", call.text,
                              items.front().description(), items[i].description()));
    }
    const bool better =
        best != nullptr && (call.text == "min" ? quantity->value < best->as_quantity()->value
                                               : quantity->value > best->as_quantity()->value);
    if (best == nullptr || better) best = &items[i];
  }
  return *best;
}

Value square_root(const ExpressionNode& call, const std::vector<Value>& arguments) {
  Quantity result = number_argument(call, arguments, 0);
  if (result.value < 0) throw wrong(call, 0, "a negative number has no square root");
  for (int& exponent : result.dimension) {
    if (exponent % 2 != 0) {
      throw wrong(call, 0, fmt::format("{} has no square root with a unit", arguments[0].description()));
    }
    exponent /= 2;
  }
  result.value = std::sqrt(result.value);
  return Value::quantity(result);
}

Value rounded(const ExpressionNode& call, const std::vector<Value>& arguments) {
  const double x = plain_argument(call, arguments, 0);
  if (call.text == "floor") return Value::number(std::floor(x));
  if (call.text == "ceil") return Value::number(std::ceil(x));
  return Value::number(std::round(x));
}

Value exponential(const ExpressionNode& call, const std::vector<Value>& arguments) {
  const double x = plain_argument(call, arguments, 0);
  if (call.text == "log" && x <= 0) throw wrong(call, 0, "only numbers above 0 have a logarithm");
  const double result = call.text == "log" ? elementary::log(x) : elementary::exp(x);
  return Value::number(checked(result, std::isfinite(x), call));
}

/// from + i step carries the rounding of both; where a short decimal lies within a few units in the last
/// place it is what was meant (0.30000000000000004 is 0.3).
double shortened(double value) {
  std::array<char, 32> digits{};
  const auto printed =
      std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::general, 15);
  double shorter = 0;
  std::from_chars(digits.data(), printed.ptr, shorter);
  return std::abs(shorter - value) <= 1e-15 * std::abs(value) ? shorter : value;
}

Value range(const ExpressionNode& call, const std::vector<Value>& arguments) {
  const Quantity from = number_argument(call, arguments, 0), to = number_argument(call, arguments, 1);
  Quantity step{1, {}};
  if (arguments.size() > 2) step = number_argument(call, arguments, 2);
  for (std::size_t i = 1; i < arguments.size(); ++i) {
    if (arguments[i].as_quantity()->dimension != from.dimension) {
      throw wrong(call, i,
                  fmt::format("range needs one dimension: {}; {}", arguments[0].description(),
                              arguments[i].description()));
    }
  }
  if (arguments.size() == 2 && from.dimension != Dimension{}) {
    throw wrong(call, 2, "range over numbers with a unit needs a step", "range(from, to, step)");
  }
  if (step.value == 0) throw wrong(call, 2, "the step of a range is 0");
  const double steps = std::floor((to.value - from.value) / step.value + 1e-9);
  if (std::isnan(steps) || steps < 0) {
    throw wrong(call, 2,
                fmt::format("range never gets from {} to {}", arguments[0].to_text(), arguments[1].to_text()),
                "the step must have the sign of to - from");
  }
  if (steps >= static_cast<double>(kMostItems))
    throw wrong(call, 2, fmt::format("a range has more than {} items", kMostItems));
  List items;
  for (double i = 0; i <= steps; ++i) {
    items.push_back(Value::quantity({shortened(from.value + i * step.value), from.dimension}));
  }
  return Value::list(std::move(items));
}

}  // namespace

const FunctionInfo* find_function(std::string_view name) {
  const auto found = std::find_if(kFunctions.begin(), kFunctions.end(),
                                  [&](const FunctionInfo& function) { return function.name == name; });
  return found == kFunctions.end() ? nullptr : &*found;
}

std::vector<std::string> function_names() {
  std::vector<std::string> names;
  for (const FunctionInfo& function : kFunctions) names.emplace_back(function.name);
  return names;
}

Value call_function(const ExpressionNode& call, const std::vector<Value>& arguments, const Names& names) {
  const std::string& name = call.text;
  if (name == "min" || name == "max") return extreme(call, arguments);
  if (name == "sqrt") return square_root(call, arguments);
  if (name == "exp" || name == "log") return exponential(call, arguments);
  if (name == "range") return range(call, arguments);
  if (name == "dirname") return Value::text(names.folder());
  if (name == "abs") {
    const Quantity& x = number_argument(call, arguments, 0);
    return Value::quantity({std::abs(x.value), x.dimension});
  }
  if (name == "len") {
    if (const List* list = arguments[0].as_list()) return Value::number(static_cast<double>(list->size()));
    throw wrong(call, 0, fmt::format("len needs a list, not {}", arguments[0].description()));
  }
  return rounded(call, arguments);
}

}  // namespace coppice::config
