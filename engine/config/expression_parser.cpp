#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <numbers>
#include <utility>

#include "engine/config/expression_lexer.h"
#include "engine/config/expression_tree.h"
#include "registry/suggest.h"

namespace coppice::config {
namespace {

using Kind = ExpressionNode::Kind;

constexpr int kDeepest = 100;  // parentheses and operators within each other; keeps the stack small
constexpr int kLongest = 1000;

/// Precedence, loosest first: a if c else b; or; and; not; comparison; + -; * / %; sign; ** ^; [index].
class Parser {
 public:
  Parser(std::string_view text, std::size_t begin, std::size_t end)
      : lexer_(text, begin, end), begin_(begin) {
    token_ = lexer_.next();
  }

  Tree whole() {
    if (token_.kind == Token::Kind::end) {
      throw ExpressionError(begin_, std::max<std::size_t>(1, token_.offset - begin_),
                            "an expression is empty", "$${ gives the characters ${");
    }
    Tree tree = conditional();
    if (token_.kind != Token::Kind::end) throw expected("an operator or the end");
    return tree;
  }

 private:
  using Rule = Tree (Parser::*)();

  bool is(std::string_view symbol) const {
    return (token_.kind == Token::Kind::symbol || token_.kind == Token::Kind::name) && token_.text == symbol;
  }
  Token take() { return std::exchange(token_, lexer_.next()); }
  bool accept(std::string_view symbol) {
    if (!is(symbol)) return false;
    take();
    return true;
  }
  void require(std::string_view symbol) {
    if (!accept(symbol)) throw expected(fmt::format("'{}'", symbol));
  }

  /// Between the items of a list; a comma may stand before the end, too.
  void separator(std::string_view end) {
    if (!is(end) && !accept(",")) throw expected(fmt::format("',' or '{}'", end));
  }

  ExpressionError expected(const std::string& what) const {
    if (is("=")) {
      return {token_.offset, 1, "'=' has no place here", "'==' compares; key=value stands only in pick(...)"};
    }
    if (token_.kind == Token::Kind::end) {
      return {token_.offset > begin_ ? token_.offset - 1 : token_.offset, 1,
              fmt::format("the expression ends where {} is expected", what)};
    }
    return {token_.offset, token_.length, fmt::format("'{}' stands where {} is expected", token_.text, what)};
  }

  /// Counts how deep the rules are within each other.
  struct Depth {
    explicit Depth(Parser* parser) : depth(parser->depth_) {
      if (++depth > kDeepest) {
        throw ExpressionError(parser->token_.offset, std::max<std::size_t>(1, parser->token_.length),
                              fmt::format("an expression is more than {} levels deep", kDeepest));
      }
    }
    ~Depth() { --depth; }
    Depth(const Depth&) = delete;
    Depth& operator=(const Depth&) = delete;
    int& depth;
  };

  static std::unique_ptr<ExpressionNode> node(Kind kind, const Token& at) {
    auto made = std::make_unique<ExpressionNode>();
    made->kind = kind;
    made->offset = at.offset;
    made->length = at.length;
    made->text = std::string(at.text);
    return made;
  }
  static Tree binary(Kind kind, const Token& at, std::string_view op, Tree left, Tree right) {
    auto made = node(kind, at);
    made->text = std::string(op);
    made->children.push_back(std::move(left));
    made->children.push_back(std::move(right));
    return made;
  }
  static Tree unary(Kind kind, const Token& at, Tree operand) {
    auto made = node(kind, at);
    made->children.push_back(std::move(operand));
    return made;
  }

  Tree conditional() {
    const Depth depth(this);
    Tree value = chain(&Parser::conjunction, Kind::logical, {"or"});
    if (!is("if")) return value;
    auto made = node(Kind::conditional, take());
    made->children.push_back(std::move(value));
    made->children.push_back(chain(&Parser::conjunction, Kind::logical, {"or"}));
    require("else");
    made->children.push_back(conditional());
    return made;
  }

  Tree conjunction() { return chain(&Parser::negation, Kind::logical, {"and"}); }

  Tree negation() {
    if (!is("not")) return comparison();
    const Depth depth(this);
    const Token at = take();
    return unary(Kind::logical_not, at, negation());
  }

  Tree comparison() {
    Tree left = sum();
    const std::string_view op = comparison_operator();
    if (op.empty()) return left;
    const Token at = take();
    Tree made = binary(Kind::binary, at, op, std::move(left), sum());
    if (!comparison_operator().empty()) {
      throw ExpressionError(token_.offset, token_.length, "comparisons do not chain",
                            "write a < b and b < c");
    }
    return made;
  }

  std::string_view comparison_operator() const {
    static constexpr auto kOperators = std::to_array<std::array<std::string_view, 2>>({{"<", "<"},
                                                                                       {"<=", "<="},
                                                                                       {">", ">"},
                                                                                       {">=", ">="},
                                                                                       {"==", "=="},
                                                                                       {"!=", "!="},
                                                                                       {"lt", "<"},
                                                                                       {"le", "<="},
                                                                                       {"gt", ">"},
                                                                                       {"ge", ">="}});
    for (const auto& [spelling, op] : kOperators) {
      if (is(spelling)) return op;
    }
    return {};
  }

  Tree sum() { return chain(&Parser::product, Kind::binary, {"+", "-"}); }
  Tree product() { return chain(&Parser::sign, Kind::binary, {"*", "/", "%"}); }

  /// Left-associative operators of one precedence.
  Tree chain(Rule operand, Kind kind, std::vector<std::string_view> operators) {
    Tree left = (this->*operand)();
    for (int length = 0;; ++length) {
      const auto op =
          std::find_if(operators.begin(), operators.end(), [&](std::string_view o) { return is(o); });
      if (op == operators.end()) return left;
      if (length == kLongest) {
        throw ExpressionError(token_.offset, token_.length,
                              fmt::format("an expression has more than {} operators in a row", kLongest));
      }
      const Token at = take();
      left = binary(kind, at, *op, std::move(left), (this->*operand)());
    }
  }

  Tree sign() {
    if (!is("-") && !is("+")) return power();
    const Depth depth(this);
    const Token at = take();
    return unary(at.text == "-" ? Kind::negate : Kind::plus, at, sign());
  }

  Tree power() {  // right-associative, and -2 ** 2 is -(2 ** 2)
    Tree base = indexed();
    if (!is("**") && !is("^")) return base;
    const Depth depth(this);
    const Token at = take();
    return binary(Kind::binary, at, "**", std::move(base), sign());
  }

  Tree indexed() {
    Tree value = primary();
    for (int length = 0; is("[") && length < kDeepest; ++length) {
      auto made = node(Kind::index, take());
      made->children.push_back(std::move(value));
      made->children.push_back(conditional());
      require("]");
      value = std::move(made);
    }
    return value;
  }

  Tree primary() {
    if (token_.kind == Token::Kind::value) {
      const Token at = take();
      auto made = node(Kind::literal, at);
      made->value = at.value;
      return made;
    }
    if (is("(")) {
      take();
      Tree inside = conditional();
      require(")");
      return inside;
    }
    if (is("[")) return list();
    if (token_.kind == Token::Kind::name) return word();
    throw expected("a value");
  }

  Tree list() {
    auto made = node(Kind::list, take());
    while (!is("]")) {
      made->children.push_back(conditional());
      separator("]");
    }
    take();
    return made;
  }

  Tree word() {
    const Token at = take();
    if (is("(")) return call(at);
    if (!is_reserved_name(at.text)) return node(Kind::name, at);
    auto made = node(Kind::literal, at);
    if (at.text == "true" || at.text == "false")
      made->value = Value::boolean(at.text == "true");
    else if (at.text == "pi")
      made->value = Value::number(std::numbers::pi);
    else if (at.text == "inf")
      made->value = Value::number(std::numeric_limits<double>::infinity());
    else
      throw ExpressionError(at.offset, at.length,
                            fmt::format("'{}' stands where a value is expected", at.text));
    return made;
  }

  Tree call(const Token& name) {
    const FunctionInfo* function = find_function(name.text);
    if (function == nullptr) {
      throw ExpressionError(name.offset, name.length, fmt::format("there is no function '{}'", name.text),
                            suggestion(name.text, function_names()));
    }
    auto made = node(Kind::call, name);
    require("(");
    while (!is(")")) {
      argument(*function, *made);
      separator(")");
    }
    take();
    const std::size_t count = made->children.size();
    if (count < function->least || count > function->most) {
      throw ExpressionError(
          name.offset, name.length,
          fmt::format("{} does not take {} argument{}", name.text, count, count == 1 ? "" : "s"),
          fmt::format("it is {}", function->signature));
    }
    return made;
  }

  void argument(const FunctionInfo& function, ExpressionNode& call) {
    const bool first = call.children.empty();
    if (function.name == "env" && first && token_.kind == Token::Kind::name) {  // env(HOME): the name itself
      const Token at = take();
      auto made = node(Kind::literal, at);
      made->value = Value::text(std::string(at.text));
      call.children.push_back(std::move(made));
      return;
    }
    if (function.name == "pick" && !first) call.keys.push_back(key(call));
    call.children.push_back(conditional());
  }

  Value key(const ExpressionNode& call) {
    if (token_.kind != Token::Kind::name && token_.kind != Token::Kind::value) throw expected("key=value");
    const Token at = take();
    const Value key = at.kind == Token::Kind::value ? at.value : Value::inferred(at.text);
    if (!is("=")) {
      throw ExpressionError(at.offset, at.length,
                            fmt::format("pick's choices are key=value, but '{}' has no value", at.text),
                            std::string(find_function("pick")->signature));
    }
    take();
    for (const Value& other : call.keys) {
      if (other.to_text() == key.to_text()) {
        throw ExpressionError(at.offset, at.length, fmt::format("pick has the key '{}' twice", at.text));
      }
    }
    return key;
  }

  Lexer lexer_;
  std::size_t begin_;
  Token token_;
  int depth_ = 0;
};

std::unique_ptr<ExpressionNode> leaf(Kind kind, std::string text, std::size_t offset, std::size_t length) {
  auto made = std::make_unique<ExpressionNode>();
  made->kind = kind;
  made->text = std::move(text);
  made->offset = offset;
  made->length = length;
  return made;
}

std::unique_ptr<ExpressionNode> env_call(std::string name, std::size_t offset, std::size_t length) {
  auto made = leaf(Kind::call, "env", offset, length);
  auto argument = leaf(Kind::literal, {}, offset, length);
  argument->value = Value::text(std::move(name));
  made->children.push_back(std::move(argument));
  return made;
}

void collect_names(const ExpressionNode& node, std::vector<std::string>& names) {
  if (node.kind == Kind::name) names.push_back(node.text);
  for (const Tree& child : node.children) collect_names(*child, names);
}

void collect_unknown(const ExpressionNode& node, const std::vector<std::string>& known,
                     std::vector<ExpressionError>& errors) {
  if (node.kind == Kind::name && std::find(known.begin(), known.end(), node.text) == known.end()) {
    errors.emplace_back(node.offset, node.length, fmt::format("there is no name '{}'", node.text),
                        suggestion(node.text, known));
  }
  for (const Tree& child : node.children) collect_unknown(*child, known, errors);
}

}  // namespace

Expression Expression::parse(std::string_view text, std::size_t begin, std::size_t end) {
  return Expression(Parser(text, begin, end).whole());
}

Expression Expression::name(std::string name, std::size_t offset) {
  const std::size_t length = name.size();
  return Expression(leaf(Kind::name, std::move(name), offset, length));
}

Expression Expression::environment(std::string name, std::size_t offset, std::size_t length) {
  return Expression(env_call(std::move(name), offset, length));
}

Expression Expression::environment(std::string name, const std::string& otherwise, std::size_t offset,
                                   std::size_t length) {
  auto made = env_call(std::move(name), offset, length);
  auto argument = leaf(Kind::literal, {}, offset, length);
  argument->value = Value::inferred(otherwise);
  made->children.push_back(std::move(argument));
  return Expression(std::move(made));
}

Expression Expression::folder(std::size_t offset, std::size_t length) {
  return Expression(leaf(Kind::call, "dirname", offset, length));
}

std::vector<std::string> Expression::names() const {
  std::vector<std::string> names;
  collect_names(*root_, names);
  return names;
}

std::vector<ExpressionError> Expression::unknown_names(const std::vector<std::string>& known) const {
  std::vector<ExpressionError> errors;
  collect_unknown(*root_, known, errors);
  return errors;
}

}  // namespace coppice::config
