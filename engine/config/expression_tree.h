#pragma once

// The parsed form of an expression, shared by its parser and its evaluator.

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "engine/config/expression.h"

namespace coppice::config {

struct ExpressionNode {
  enum class Kind {
    literal,
    name,
    list,
    call,
    index,
    negate,
    plus,
    logical_not,
    binary,
    logical,
    conditional
  };

  Kind kind = Kind::literal;
  std::size_t offset = 0, length = 0;   ///< of the characters that a message underlines
  std::string text;                     ///< name, function or operator ("<=" for both spellings)
  Value value = Value::boolean(false);  ///< of a literal
  /// Operands in the order of the text; a conditional's are: value, condition, other value.
  std::vector<std::unique_ptr<const ExpressionNode>> children;
  std::vector<Value> keys;  ///< of pick's choices: keys[i] belongs to children[i + 1]

  /// A mistake here.
  ExpressionError error(const std::string& message, const std::string& hint = {}) const {
    return {offset, length, message, hint};
  }
};

using Tree = std::unique_ptr<const ExpressionNode>;

/// Longer lists are errors.
inline constexpr std::size_t kMostItems = 1'000'000;

/// A function of the language; a call outside these limits is a parse error.
struct FunctionInfo {
  std::string_view name;
  std::size_t least, most;     ///< number of arguments
  std::string_view signature;  ///< "range(from, to, step)"
};

/// Null when there is none.
const FunctionInfo* find_function(std::string_view name);

/// Applies a function to its evaluated arguments (all functions but pick).
Value call_function(const ExpressionNode& call, const std::vector<Value>& arguments, const Names& names);

/// Applies + - * / % ** or a comparison.
Value apply_operator(const ExpressionNode& node, const Value& left, const Value& right);

/// `value` if it is a number that arithmetic may give from finite operands, else an ExpressionError.
double checked(double value, bool finite_operands, const ExpressionNode& node);

}  // namespace coppice::config
