#include "engine/config/expression_lexer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

namespace coppice::config {
namespace {

constexpr auto kWords = std::to_array<std::string_view>(
    {"true", "false", "pi", "inf", "and", "or", "not", "if", "else", "lt", "le", "gt", "ge"});

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}
bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

/// Where the unit that follows a number ends: the longest product of names, written without blanks, that is a
/// unit.
std::size_t unit_end(std::string_view text, std::size_t begin, std::size_t end) {
  std::size_t best = begin;
  for (std::size_t i = begin; i < end && is_letter(text[i]);) {
    while (i < end && is_letter(text[i])) ++i;
    if (i + 1 < end && text[i] == '^' && (is_digit(text[i + 1]) || text[i + 1] == '-')) {
      i += 2;
      while (i < end && is_digit(text[i])) ++i;
    }
    if (parse_unit(text.substr(begin, i - begin))) best = i;
    if (i >= end || (text[i] != '*' && text[i] != '/')) break;
    ++i;
  }
  return best;
}

}  // namespace

bool is_reserved_name(std::string_view name) {
  return std::find(kWords.begin(), kWords.end(), name) != kWords.end();
}

bool is_identifier(std::string_view name) {
  return !name.empty() && is_letter(name.front()) &&
         std::all_of(name.begin(), name.end(), [](char c) { return is_letter(c) || is_digit(c); });
}

Token Lexer::next() {
  while (at_ < end_ && is_blank(text_[at_])) ++at_;
  if (at_ == end_) return token(Token::Kind::end, 0);
  const char c = text_[at_];
  if (is_digit(c) || (c == '.' && at_ + 1 < end_ && is_digit(text_[at_ + 1]))) return number();
  if (c == '\'') return quoted();
  if (is_letter(c)) {
    std::size_t length = 1;
    while (at_ + length < end_ && (is_letter(text_[at_ + length]) || is_digit(text_[at_ + length]))) ++length;
    return token(Token::Kind::name, length);
  }
  return symbol();
}

Token Lexer::token(Token::Kind kind, std::size_t length) {
  Token made{kind, at_, length, text_.substr(at_, length)};
  at_ += length;
  return made;
}

Token Lexer::number() {
  double ignored = 0;
  const char* first = text_.data() + at_;
  const auto [stop, failure] = std::from_chars(first, text_.data() + end_, ignored);
  const auto digits = static_cast<std::size_t>(stop - first);
  if (failure == std::errc::result_out_of_range) {
    throw ExpressionError(at_, digits, fmt::format("{} does not fit a number", text_.substr(at_, digits)),
                          "numbers reach from about 1e-308 to 1e308");
  }
  std::size_t unit = at_ + digits;
  while (unit < end_ && is_blank(text_[unit])) ++unit;
  std::size_t end = unit_end(text_, unit, end_);
  if (end == unit) {
    check_word_after_number(unit);
    end = at_ + digits;
  } else if (end < end_ && (is_letter(text_[end]) || is_digit(text_[end]))) {
    throw not_a_unit(unit);
  }
  const std::optional<Quantity> quantity = parse_quantity(text_.substr(at_, end - at_));
  if (!quantity) {
    throw ExpressionError(at_, end - at_,
                          fmt::format("{} does not fit a number", text_.substr(at_, end - at_)));
  }
  Token made = token(Token::Kind::value, end - at_);
  made.value = Value::quantity(*quantity);
  return made;
}

/// "3 hous": a word after a number must be a unit or an operator.
void Lexer::check_word_after_number(std::size_t begin) const {
  std::size_t end = begin;
  while (end < end_ && (is_letter(text_[end]) || is_digit(text_[end]))) ++end;
  if (end == begin || is_reserved_name(text_.substr(begin, end - begin))) return;
  throw not_a_unit(begin);
}

ExpressionError Lexer::not_a_unit(std::size_t begin) const {
  std::size_t end = begin;
  while (end < end_ && (is_letter(text_[end]) || is_digit(text_[end]))) ++end;
  return ExpressionError(
      begin, end - begin,
      fmt::format("'{}' is neither a unit nor an operator", text_.substr(begin, end - begin)),
      "units: m, cm, s, ms, min, h, Hz, deg, rad, kg, N, byte, MB, m/s, kg*m^2, ...");
}

Token Lexer::quoted() {
  std::string content;
  std::size_t i = at_ + 1;
  for (;; ++i) {
    if (i >= end_) {
      throw ExpressionError(at_, end_ - at_, "a text is not closed", "texts stand in single quotes: 'text'");
    }
    if (text_[i] == '\'') {
      if (i + 1 >= end_ || text_[i + 1] != '\'') break;
      ++i;
    }
    content += text_[i];
  }
  Token made = token(Token::Kind::value, i + 1 - at_);
  made.value = Value::text(std::move(content));
  return made;
}

Token Lexer::symbol() {
  static constexpr auto kTwo = std::to_array<std::string_view>({"**", "<=", ">=", "==", "!="});
  const std::string_view two = text_.substr(at_, std::min<std::size_t>(2, end_ - at_));
  if (std::find(kTwo.begin(), kTwo.end(), two) != kTwo.end()) return token(Token::Kind::symbol, 2);
  const char c = text_[at_];
  if (std::string_view("+-*/%^()[],<>=").find(c) != std::string_view::npos)
    return token(Token::Kind::symbol, 1);
  throw unexpected(c, two);
}

ExpressionError Lexer::unexpected(char c, std::string_view two) const {
  if (two == "&&") return {at_, 2, "'&&' is not an operator", "write 'and'"};
  if (two == "||") return {at_, 2, "'||' is not an operator", "write 'or'"};
  if (c == '!') return {at_, 1, "'!' is not an operator", "write 'not', or '!=' to compare"};
  if (c == '"') return {at_, 1, "a double quote has no place here", "texts stand in single quotes: 'text'"};
  if (c == '$')
    return {at_, 1, "'$' has no place inside an expression", "names stand alone here: x, not ${x}"};
  std::size_t length = 1;  // the whole UTF-8 character
  while (at_ + length < end_ && (static_cast<unsigned char>(text_[at_ + length]) & 0xC0u) == 0x80u) ++length;
  const bool shown = static_cast<unsigned char>(c) >= 0x20 && c != 0x7F;
  return {at_, length,
          fmt::format("{} has no place in an expression",
                      shown ? fmt::format("'{}'", text_.substr(at_, length)) : "a control character")};
}

}  // namespace coppice::config
