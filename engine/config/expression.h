#pragma once

#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "engine/config/value.h"

namespace coppice::config {

/// A mistake inside an expression: the characters of the text that are wrong, which rule they break, what is
/// valid.
class ExpressionError : public std::runtime_error {
 public:
  ExpressionError(std::size_t where, std::size_t characters, const std::string& message,
                  std::string help = {})
      : std::runtime_error(message), offset(where), length(characters), hint(std::move(help)) {}

  std::size_t offset;  ///< from the beginning of the text that holds the expression
  std::size_t length;
  std::string hint;
};

/// Thrown where a value is missing because of a mistake that was reported before.
class AlreadyReported : public std::exception {};

/// What the names in an expression mean.
class Names {
 public:
  virtual ~Names() = default;
  /// Null when nothing has this name. Throws AlreadyReported when its definition failed.
  virtual const Value* find(std::string_view name) const = 0;
  /// The error for a name that find does not know.
  virtual ExpressionError unknown(std::string_view name, std::size_t offset) const = 0;
  /// The absolute path of the folder of the file that holds the expression.
  virtual std::string folder() const = 0;
};

struct ExpressionNode;

/// An expression of the config language; docs/config-language.md has its grammar. Immutable, cheap to copy.
class Expression {
 public:
  /// Parses text[begin, end). Throws ExpressionError, whose offsets count from the beginning of `text`.
  static Expression parse(std::string_view text, std::size_t begin, std::size_t end);

  /// The expression that is just a name, or the value of an environment variable: `$(arg x)`, `$(env X
  /// default)`.
  static Expression name(std::string name, std::size_t offset);
  static Expression environment(std::string name, std::size_t offset, std::size_t length);
  static Expression environment(std::string name, const std::string& otherwise, std::size_t offset,
                                std::size_t length);
  static Expression folder(std::size_t offset, std::size_t length);

  /// Throws ExpressionError or AlreadyReported.
  Value evaluate(const Names& names) const;

  /// Every name that the expression uses.
  std::vector<std::string> names() const;
  /// Errors for the names that are not among `known`.
  std::vector<ExpressionError> unknown_names(const std::vector<std::string>& known) const;

 private:
  explicit Expression(std::shared_ptr<const ExpressionNode> root) : root_(std::move(root)) {}
  std::shared_ptr<const ExpressionNode> root_;
};

/// Names that the language keeps for itself: true, false, pi, inf, and, or, not, if, else, lt, le, gt, ge.
bool is_reserved_name(std::string_view name);

/// Letters, digits and '_', not beginning with a digit.
bool is_identifier(std::string_view name);

/// Names of the functions, for suggestions.
std::vector<std::string> function_names();

}  // namespace coppice::config
