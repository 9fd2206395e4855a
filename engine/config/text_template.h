#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "engine/config/expression.h"

namespace coppice::config {

/// The text of an attribute, cut into literal text and expressions: ${expression}, $(arg x), $(var x),
/// $(env NAME default), $(dirname); $${ and $$( stand for ${ and $(.
class TextTemplate {
 public:
  explicit TextTemplate(std::string_view text);

  /// No expressions.
  bool constant() const;

  /// The joined text. Nothing after a mistake; mistakes that were not reported before are added to `errors`.
  std::optional<std::string> text(const Names& names, std::vector<ExpressionError>& errors) const;

  /// The typed value: that of the expression when there is nothing else, otherwise what the joined text
  /// stands for.
  std::optional<Value> value(const Names& names, std::vector<ExpressionError>& errors) const;

  /// Every name that the expressions use.
  std::vector<std::string> names() const;

  /// What is wrong whatever the values are: expressions that cannot be read, and with `known`, names that are
  /// not among them.
  std::vector<ExpressionError> mistakes(const std::vector<std::string>* known) const;

 private:
  using Piece = std::variant<std::string, Expression, ExpressionError>;

  std::size_t add_expression(std::string_view text, std::size_t begin);
  std::size_t add_substitution(std::string_view text, std::size_t begin);
  std::optional<Value> evaluate(const Piece& piece, const Names& names,
                                std::vector<ExpressionError>& errors) const;

  std::vector<Piece> pieces_;
};

/// Text that a TextTemplate turns back into `text`.
std::string escaped(std::string_view text);

}  // namespace coppice::config
