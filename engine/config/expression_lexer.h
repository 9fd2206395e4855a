#pragma once

#include <cstddef>
#include <string_view>

#include "engine/config/expression.h"

namespace coppice::config {

struct Token {
  enum class Kind { end, value, name, symbol };
  Kind kind = Kind::end;
  std::size_t offset = 0, length = 0;
  std::string_view text;
  Value value = Value::boolean(false);  ///< of a number (with its unit) or a quoted text
};

/// Cuts text[begin, end) into tokens. Throws ExpressionError, whose offsets count from the beginning of
/// `text`.
class Lexer {
 public:
  Lexer(std::string_view text, std::size_t begin, std::size_t end) : text_(text), at_(begin), end_(end) {}

  Token next();

 private:
  Token token(Token::Kind kind, std::size_t length);
  Token number();
  Token quoted();
  Token symbol();
  void check_word_after_number(std::size_t begin) const;
  ExpressionError not_a_unit(std::size_t begin) const;
  ExpressionError unexpected(char c, std::string_view two) const;

  std::string_view text_;
  std::size_t at_, end_;
};

}  // namespace coppice::config
