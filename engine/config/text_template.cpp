#include "engine/config/text_template.h"

#include <fmt/format.h>

#include <utility>

#include "registry/suggest.h"
#include "registry/text.h"

namespace coppice::config {
namespace {

constexpr std::size_t kLongestText = std::size_t{1} << 20u;

/// The '}' that closes an expression, outside of quoted texts.
std::size_t closing_brace(std::string_view text, std::size_t begin) {
  bool quoted = false;
  for (std::size_t i = begin; i < text.size(); ++i) {
    if (text[i] == '\'') quoted = !quoted;
    if (text[i] == '}' && !quoted) return i;
  }
  const std::size_t first = text.find('}', begin);  // an unclosed quote: let the parser report it
  return first;
}

std::string_view first_word(std::string_view text) {
  return text.substr(0, text.find_first_of(" \t\n"));
}

/// $(arg x) and its like, given what stands in the parentheses.
Expression substitution(std::string_view content, std::size_t offset) {
  const std::string_view command = first_word(content);
  const std::string_view rest = trim(content.substr(command.size()));
  const std::size_t rest_offset =
      rest.empty() ? offset : offset + static_cast<std::size_t>(rest.data() - content.data());
  if (command == "dirname") {
    if (rest.empty()) return Expression::folder(offset, content.size());
    throw ExpressionError(rest_offset, rest.size(), "$(dirname) takes no argument");
  }
  if (command == "arg" || command == "var" || command == "env") {
    const std::string_view name = first_word(rest);
    if (!is_identifier(name)) {
      throw ExpressionError(offset, content.size(), fmt::format("$({} ...) needs a name", command),
                            fmt::format("$({} NAME)", command));
    }
    const std::string_view otherwise = trim(rest.substr(name.size()));
    if (command == "env" && !otherwise.empty()) {
      return Expression::environment(std::string(name), std::string(otherwise), rest_offset, name.size());
    }
    if (command == "env") return Expression::environment(std::string(name), rest_offset, name.size());
    if (otherwise.empty()) return Expression::name(std::string(name), rest_offset);
    throw ExpressionError(rest_offset, rest.size(), fmt::format("$({} NAME) takes one name", command));
  }
  std::string hint =
      "$$( gives the characters $(; known are $(arg NAME), $(var NAME), $(env NAME default), $(dirname)";
  if (command == "eval") hint = "expressions stand in ${...}";
  if (command == "optenv") hint = "write $(env NAME default)";
  throw ExpressionError(offset, std::max<std::size_t>(1, command.size()),
                        fmt::format("there is no substitution $({} ...)", command), hint);
}

}  // namespace

TextTemplate::TextTemplate(std::string_view text) {
  std::string literal;
  const auto flush = [&] {
    if (!literal.empty()) pieces_.emplace_back(std::exchange(literal, {}));
  };
  for (std::size_t i = 0; i < text.size();) {
    const std::string_view rest = text.substr(i);
    if (rest.starts_with("$${") || rest.starts_with("$$(")) {
      literal += rest.substr(1, 2);
      i += 3;
    } else if (rest.starts_with("${")) {
      flush();
      i = add_expression(text, i);
    } else if (rest.starts_with("$(")) {
      flush();
      i = add_substitution(text, i);
    } else {
      literal += text[i++];
    }
  }
  flush();
}

std::size_t TextTemplate::add_expression(std::string_view text, std::size_t begin) {
  const std::size_t end = closing_brace(text, begin + 2);
  try {
    if (end == std::string_view::npos) {
      throw ExpressionError(begin, text.size() - begin, "an expression is not closed",
                            "'}' is missing; $${ gives the characters ${");
    }
    pieces_.emplace_back(Expression::parse(text, begin + 2, end));
  } catch (const ExpressionError& error) {
    pieces_.emplace_back(error);
  }
  return end == std::string_view::npos ? text.size() : end + 1;
}

std::size_t TextTemplate::add_substitution(std::string_view text, std::size_t begin) {
  const std::size_t end = text.find(')', begin);
  try {
    if (end == std::string_view::npos) {
      throw ExpressionError(begin, text.size() - begin, "a substitution is not closed",
                            "')' is missing; $$( gives the characters $(");
    }
    const std::string_view content = trim(text.substr(begin + 2, end - begin - 2));
    const std::size_t offset =
        content.empty() ? begin : static_cast<std::size_t>(content.data() - text.data());
    pieces_.emplace_back(substitution(content, offset));
  } catch (const ExpressionError& error) {
    pieces_.emplace_back(error);
  }
  return end == std::string_view::npos ? text.size() : end + 1;
}

bool TextTemplate::constant() const {
  return pieces_.empty() || (pieces_.size() == 1 && std::holds_alternative<std::string>(pieces_.front()));
}

std::optional<Value> TextTemplate::evaluate(const Piece& piece, const Names& names,
                                            std::vector<ExpressionError>& errors) const {
  if (const auto* literal = std::get_if<std::string>(&piece)) return Value::text(*literal);
  try {
    if (const auto* error = std::get_if<ExpressionError>(&piece)) throw ExpressionError(*error);
    return std::get<Expression>(piece).evaluate(names);
  } catch (const ExpressionError& error) {
    errors.push_back(error);
  } catch (const AlreadyReported&) {
  }
  return std::nullopt;
}

std::optional<std::string> TextTemplate::text(const Names& names,
                                              std::vector<ExpressionError>& errors) const {
  std::string joined;
  bool complete = true;
  for (const Piece& piece : pieces_) {
    if (const auto* literal = std::get_if<std::string>(&piece)) {
      joined += *literal;
    } else if (const std::optional<Value> value = evaluate(piece, names, errors)) {
      joined += value->to_text();
    } else {
      complete = false;
    }
    if (joined.size() > kLongestText) {
      errors.emplace_back(0, 1, fmt::format("a text grows beyond {} bytes", kLongestText));
      return std::nullopt;
    }
  }
  return complete ? std::optional(std::move(joined)) : std::nullopt;
}

std::optional<Value> TextTemplate::value(const Names& names, std::vector<ExpressionError>& errors) const {
  const Piece* only = nullptr;
  bool alone = true;
  for (const Piece& piece : pieces_) {
    const auto* literal = std::get_if<std::string>(&piece);
    if (literal != nullptr && trim(*literal).empty()) continue;
    alone = alone && only == nullptr && literal == nullptr;
    only = &piece;
  }
  if (only != nullptr && alone) return evaluate(*only, names, errors);
  const std::optional<std::string> joined = text(names, errors);
  return joined ? std::optional(Value::inferred(*joined)) : std::nullopt;
}

std::vector<std::string> TextTemplate::names() const {
  std::vector<std::string> all;
  for (const Piece& piece : pieces_) {
    if (const auto* expression = std::get_if<Expression>(&piece)) {
      for (std::string& name : expression->names()) all.push_back(std::move(name));
    }
  }
  return all;
}

std::vector<ExpressionError> TextTemplate::mistakes(const std::vector<std::string>* known) const {
  std::vector<ExpressionError> all;
  for (const Piece& piece : pieces_) {
    if (const auto* error = std::get_if<ExpressionError>(&piece)) all.push_back(*error);
    const auto* expression = std::get_if<Expression>(&piece);
    if (expression == nullptr || known == nullptr) continue;
    for (ExpressionError& error : expression->unknown_names(*known)) all.push_back(std::move(error));
  }
  return all;
}

std::string escaped(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool begins = text[i] == '$' && i + 1 < text.size() && (text[i + 1] == '{' || text[i + 1] == '(');
    result += begins ? "$$" : text.substr(i, 1);
  }
  return result;
}

}  // namespace coppice::config
