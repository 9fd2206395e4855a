#include "engine/config/expression.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <numbers>

namespace coppice::config {
namespace {

/// Names with given values.
class Given : public Names {
 public:
  explicit Given(const std::map<std::string, std::string>& texts = {}) {
    for (const auto& [name, text] : texts) values_.emplace(name, Value::inferred(text));
  }
  const Value* find(std::string_view name) const override {
    const auto found = values_.find(std::string(name));
    return found == values_.end() ? nullptr : &found->second;
  }
  ExpressionError unknown(std::string_view name, std::size_t offset) const override {
    return {offset, name.size(), "unknown " + std::string(name)};
  }
  std::string folder() const override { return "/home/user/configs"; }

 private:
  std::map<std::string, Value> values_;
};

Value evaluate(const std::string& text, const std::map<std::string, std::string>& names = {}) {
  return Expression::parse(text, 0, text.size()).evaluate(Given(names));
}

double number(const std::string& text, const std::map<std::string, std::string>& names = {}) {
  const Value value = evaluate(text, names);
  EXPECT_NE(value.as_plain_number(), nullptr) << text << " is " << value.description();
  return value.as_plain_number() != nullptr ? *value.as_plain_number() : std::nan("");
}

bool truth(const std::string& text, const std::map<std::string, std::string>& names = {}) {
  const Value value = evaluate(text, names);
  EXPECT_NE(value.as_boolean(), nullptr) << text << " is " << value.description();
  return value.as_boolean() != nullptr && *value.as_boolean();
}

std::string text_of(const std::string& text, const std::map<std::string, std::string>& names = {}) {
  return evaluate(text, names).to_text();
}

/// The mistake in an expression: the characters it points at, and what it says.
struct Mistake {
  std::string marked, message, hint;
};
Mistake mistake(const std::string& text, const std::map<std::string, std::string>& names = {}) {
  try {
    const Value value = evaluate(text, names);
    ADD_FAILURE() << text << " was accepted: " << value.description();
  } catch (const ExpressionError& error) {
    EXPECT_LE(error.offset + error.length, text.size()) << text;
    return {text.substr(error.offset, error.length), error.what(), error.hint};
  }
  return {};
}

TEST(Expression, FollowsTheUsualPrecedence) {
  EXPECT_EQ(number("2 + 3 * 4"), 14);
  EXPECT_EQ(number("(2 + 3) * 4"), 20);
  EXPECT_EQ(number("10 - 4 - 3"), 3);
  EXPECT_EQ(number("100 / 5 / 4"), 5);
  EXPECT_EQ(number("2 ** 3 ** 2"), 512);
  EXPECT_EQ(number("2 ^ 3 ^ 2"), 512);
  EXPECT_EQ(number("-2 ** 2"), -4);
  EXPECT_EQ(number("(-2) ** 2"), 4);
  EXPECT_EQ(number("2 ** -1"), 0.5);
  EXPECT_EQ(number("2 * -3"), -6);
  EXPECT_EQ(number("--3"), 3);
  EXPECT_EQ(number("7 % 4 * 2"), 6);
  EXPECT_TRUE(truth("1 + 1 == 2 and not 2 lt 1"));
  EXPECT_TRUE(truth("true or false and false"));
  EXPECT_FALSE(truth("(true or false) and false"));
  EXPECT_TRUE(truth("not false or true"));
  EXPECT_EQ(number("1 if true else 2 if true else 3"), 1);
  EXPECT_EQ(number("1 if false else 2 if false else 3"), 3);
  EXPECT_EQ(number("1 + 1 if false or true else 0"), 2);
}

TEST(Expression, ComputesExactlyWhatDoublesGive) {
  EXPECT_EQ(number("0.1 + 0.2"), 0.1 + 0.2);
  EXPECT_EQ(number("1 / 3"), 1.0 / 3.0);
  EXPECT_EQ(number("10 ** 6"), 1e6);
  EXPECT_EQ(number("10 ** -3"), 1e-3);
  EXPECT_EQ(number("3 ** 20"), 3486784401.0);
  EXPECT_EQ(number("sqrt(2)"), std::sqrt(2.0));
  EXPECT_EQ(number("1e-3 * 1E3"), 1);
  EXPECT_EQ(number(".5"), 0.5);
  EXPECT_EQ(number("pi"), std::numbers::pi);
  EXPECT_NEAR(number("exp(1)"), std::numbers::e, 1e-15);
  EXPECT_NEAR(number("log(10)"), std::numbers::ln10, 1e-15);
  EXPECT_NEAR(number("2 ** 0.5"), std::sqrt(2.0), 1e-15);
  EXPECT_EQ(number("0 ** 0.5"), 0);
}

TEST(Expression, GivesTheRemainderTheSignOfTheDivisor) {
  EXPECT_EQ(number("7 % 3"), 1);
  EXPECT_EQ(number("-7 % 3"), 2);
  EXPECT_EQ(number("7 % -3"), -2);
  EXPECT_EQ(number("-7 % -3"), -1);
  EXPECT_EQ(number("5.5 % 2"), 1.5);
}

TEST(Expression, ReadsUnitsAsAttributesDo) {
  const auto si = [](const std::string& text) { return evaluate(text).as_quantity()->value; };
  EXPECT_EQ(si("3 h"), 10800);
  EXPECT_EQ(si("3h"), 10800);
  EXPECT_EQ(si("7 cm"), 0.07);
  EXPECT_EQ(si("200 Hz"), 200);
  EXPECT_DOUBLE_EQ(si("20 deg"), 20 * std::numbers::pi / 180);
  EXPECT_EQ(si("2 cm/s"), 0.02);
  EXPECT_EQ(si("3 kg*m^2"), 3);
  EXPECT_EQ(text_of("2 m * 3 m"), "6 m^2");
  EXPECT_EQ(text_of("2 m / (4 s)"), "0.5 m/s");
  EXPECT_EQ(text_of("1 / (2 s)"), "0.5 1/s");
  EXPECT_EQ(text_of("sqrt(4 m^2)"), "2 m");
  EXPECT_EQ(text_of("(2 m) ** 3"), "8 m^3");
  EXPECT_EQ(text_of("90 min + 0.5 h"), "7200 s");
  EXPECT_EQ(text_of("7 h % 2 h"), "3600 s");
  EXPECT_EQ(text_of("-(3 s)"), "-3 s");
  EXPECT_EQ(number("3 h / (1 min)"), 180);
  EXPECT_TRUE(truth("90 min == 1.5 h"));
  EXPECT_TRUE(truth("59 s < 1 min"));
}

TEST(Expression, EndsAUnitWhereItStopsBeingOne) {
  EXPECT_EQ(text_of("2 m / n", {{"n", "4"}}), "0.5 m");
  EXPECT_EQ(text_of("2 m/n", {{"n", "4"}}), "0.5 m");
  EXPECT_EQ(text_of("2 h*n", {{"n", "2"}}), "14400 s");
  EXPECT_EQ(text_of("4 s**2"), "16 s^2");
  EXPECT_EQ(text_of("4 m if 3 lt 5 else 1 m"), "4 m");
  EXPECT_EQ(number("5 % 3"), 2);  // not 5 per cent
}

TEST(Expression, RefusesToMixDimensions) {
  EXPECT_EQ(mistake("3 m + 2 s").marked, "+");
  EXPECT_EQ(mistake("3 m + 2 s").message,
            "'+' needs the same dimension on both sides: 3 m, a length (m); 2 s, a time (s)");
  EXPECT_EQ(mistake("1 - 2 deg").marked, "-");
  EXPECT_EQ(mistake("1 m < 2").marked, "<");
  EXPECT_EQ(mistake("1 m == 2 s").marked, "==");
  EXPECT_EQ(mistake("5 m % 2").marked, "%");
  EXPECT_EQ(mistake("2 ** (3 s)").marked, "3 s");
  EXPECT_EQ(mistake("(2 m) ** 0.5").marked, "0.5");
  EXPECT_EQ(mistake("sqrt(2 m)").marked, "2 m");
  EXPECT_EQ(mistake("exp(2 s)").marked, "2 s");
  EXPECT_EQ(mistake("floor(2.5 s)").marked, "2.5 s");
  EXPECT_EQ(mistake("min(1 m, 2 m, 3 s)").marked, "3 s");
  EXPECT_EQ(mistake("range(0 m, 1 s, 1 m)").marked, "1 s");
  EXPECT_EQ(mistake("(9 m^9) * (9 m)").marked, "*");
}

TEST(Expression, RefusesWhatIsNoNumber) {
  EXPECT_EQ(mistake("1 / 0").marked, "0");
  EXPECT_EQ(mistake("1 / 0").message, "division by zero");
  EXPECT_EQ(mistake("1 % (2 - 2)").message, "division by zero");
  EXPECT_EQ(mistake("1e308 * 10").message, "'*' overflows");
  EXPECT_EQ(mistake("10 ** 400").message, "'**' overflows");
  EXPECT_EQ(mistake("exp(1000)").message, "'exp' overflows");
  EXPECT_EQ(mistake("inf - inf").message, "the result of '-' is not a number");
  EXPECT_EQ(mistake("0 * inf").message, "the result of '*' is not a number");
  EXPECT_EQ(mistake("0 ** -1").marked, "**");
  EXPECT_EQ(mistake("(-8) ** 0.5").message, "a negative number has only integer powers");
  EXPECT_EQ(mistake("sqrt(-1)").marked, "-");
  EXPECT_EQ(mistake("log(0)").marked, "0");
  EXPECT_EQ(mistake("1e999").marked, "1e999");
  EXPECT_EQ(number("inf + 1"), std::numeric_limits<double>::infinity());
}

TEST(Expression, ComparesInBothSpellings) {
  for (const auto& [sign, word] :
       std::map<std::string, std::string>{{"<", "lt"}, {"<=", "le"}, {">", "gt"}, {">=", "ge"}}) {
    for (const char* pair : {"1 2", "2 1", "2 2"}) {
      const std::string left(1, pair[0]), right(1, pair[2]);
      EXPECT_EQ(truth(left + sign + right), truth(left + " " + word + " " + right)) << sign << pair;
    }
  }
  EXPECT_TRUE(truth("1 < 2"));
  EXPECT_FALSE(truth("2 < 2"));
  EXPECT_TRUE(truth("2 <= 2"));
  EXPECT_TRUE(truth("1 != 2"));
  EXPECT_TRUE(truth("'a' == 'a'"));
  EXPECT_TRUE(truth("'a' != 'b'"));
  EXPECT_TRUE(truth("[1, 2] == [1, 2]"));
  EXPECT_FALSE(truth("[1, 2] == [1, 2, 3]"));
}

TEST(Expression, ComparesValuesFromTextWithTextsByTheirSpelling) {
  EXPECT_TRUE(truth("x == 'auto'", {{"x", "auto"}}));
  EXPECT_FALSE(truth("x == 'auto'", {{"x", "3"}}));
  EXPECT_TRUE(truth("x == '3'", {{"x", "3"}}));
  EXPECT_TRUE(truth("x == 3", {{"x", "3.0"}}));
  EXPECT_FALSE(truth("x == '3'", {{"x", "3.0"}}));
  EXPECT_EQ(mistake("1 + 1 == 'a'").marked, "==");
  EXPECT_EQ(mistake("true == 1").marked, "==");
  EXPECT_EQ(mistake("'a' < 'b'").marked, "'a'");
}

TEST(Expression, DoesNotChainComparisons) {
  EXPECT_EQ(mistake("1 < 2 < 3").marked, "<");
  EXPECT_EQ(mistake("1 < 2 < 3").hint, "write a < b and b < c");
}

TEST(Expression, AsksForTruthValues) {
  EXPECT_EQ(mistake("1 and true").marked, "1");
  EXPECT_EQ(mistake("true and 'x'").marked, "'x'");
  EXPECT_EQ(mistake("not 3").marked, "3");
  EXPECT_EQ(mistake("1 if 2 else 3").marked, "2");
  EXPECT_EQ(mistake("1 if 2 else 3").message, "the condition must be true or false, not 2, a plain number");
}

TEST(Expression, EvaluatesOnlyTheChosenBranchButChecksTheNamesOfAll) {
  EXPECT_EQ(number("1 / x if x != 0 else 0", {{"x", "0"}}), 0);
  EXPECT_FALSE(truth("x != 0 and 1 / x > 2", {{"x", "0"}}));
  EXPECT_TRUE(truth("x == 0 or 1 / x > 2", {{"x", "0"}}));
  EXPECT_EQ(number("pick(x, a=1, b=1/0)", {{"x", "a"}}), 1);
  EXPECT_EQ(mistake("1 if true else nowhere").marked, "nowhere");
  EXPECT_EQ(mistake("false and nowhere").marked, "nowhere");
  EXPECT_EQ(mistake("pick('a', a=1, b=nowhere)").marked, "nowhere");
}

TEST(Expression, PicksByKey) {
  EXPECT_EQ(number("pick(scale, ci=500, desk=10000, paper=10000)", {{"scale", "desk"}}), 10000);
  EXPECT_EQ(text_of("pick(n, 1='one', 2='two')", {{"n", "2"}}), "two");
  EXPECT_EQ(text_of("pick(1 + 1, 1='one', 2='two')"), "two");
  EXPECT_EQ(text_of("pick(x, 'a-b'=3 m, 'c d'=4 m)", {{"x", "c d"}}), "4 m");
  EXPECT_EQ(text_of("pick(x, true='yes', false='no')", {{"x", "false"}}), "no");
  const Mistake missing = mistake("pick(scale, ci=1, desk=2)", {{"scale", "paper"}});
  EXPECT_EQ(missing.marked, "scale");
  EXPECT_EQ(missing.message, "pick has no key 'paper'");
  EXPECT_EQ(missing.hint, "its keys: ci, desk");
  EXPECT_EQ(mistake("pick(scale, ci)", {{"scale", "ci"}}).marked, "ci");
  EXPECT_EQ(mistake("pick('a', a=1, a=2)").message, "pick has the key 'a' twice");
  EXPECT_EQ(mistake("min(a=1)").marked, "=");
}

TEST(Expression, BuildsRangesWithBothEnds) {
  EXPECT_EQ(text_of("range(1, 5)"), "1, 2, 3, 4, 5");
  EXPECT_EQ(text_of("range(0.1, 0.5, 0.1)"), "0.1, 0.2, 0.3, 0.4, 0.5");
  EXPECT_EQ(text_of("range(0, 1, 0.3)"), "0, 0.3, 0.6, 0.9");
  EXPECT_EQ(text_of("range(5, 1, -2)"), "5, 3, 1");
  EXPECT_EQ(text_of("range(1 s, 2 s, 500 ms)"), "1 s, 1.5 s, 2 s");
  EXPECT_EQ(text_of("range(2, 2)"), "2");
  EXPECT_EQ(number("len(range(0, 1, 0.001))"), 1001);
  EXPECT_EQ(mistake("range(5, 1)").message, "range never gets from 5 to 1");
  EXPECT_EQ(mistake("range(1, 5, 0)").marked, "0");
  EXPECT_EQ(mistake("range(0, 1, 1e-9)").message, "a range has more than 1000000 items");
  EXPECT_EQ(mistake("range(1, 6e5) + range(1, 6e5)").message, "a list grows beyond 1000000 items");
  EXPECT_EQ(mistake("range(0 m, 1 m)").message, "range over numbers with a unit needs a step");
}

TEST(Expression, HasListsWithIndices) {
  EXPECT_EQ(number("[10, 20, 30][1]"), 20);
  EXPECT_EQ(number("x[2]", {{"x", "5, 6, 7"}}), 7);
  EXPECT_EQ(text_of("[1, 2] + [3]"), "1, 2, 3");
  EXPECT_EQ(number("[[1, 2], [3, 4]][1][0]"), 3);
  EXPECT_EQ(number("len([])"), 0);
  EXPECT_EQ(number("len(x)", {{"x", "a, b"}}), 2);
  EXPECT_EQ(mistake("[1, 2][2]").marked, "2");
  EXPECT_EQ(mistake("[1, 2][2]").hint, "valid: 0 to 1");
  EXPECT_EQ(mistake("[1, 2][-1]").marked, "-");
  EXPECT_EQ(mistake("[1, 2][0.5]").message, "an index must be an integer, not 0.5, a plain number");
  EXPECT_EQ(mistake("3[0]").marked, "3");
}

TEST(Expression, HasTheFunctionsOfTheLanguage) {
  EXPECT_EQ(number("min(3, 1, 2)"), 1);
  EXPECT_EQ(number("max([3, 1, 2])"), 3);
  EXPECT_EQ(text_of("max(1 m, 20 cm)"), "1 m");
  EXPECT_EQ(text_of("abs(-3 m)"), "3 m");
  EXPECT_EQ(number("floor(-1.5)"), -2);
  EXPECT_EQ(number("ceil(1.2)"), 2);
  EXPECT_EQ(number("round(2.5)"), 3);
  EXPECT_EQ(number("round(-2.5)"), -3);
  EXPECT_EQ(text_of("dirname()"), "/home/user/configs");
  EXPECT_EQ(text_of("dirname"), "/home/user/configs");
  EXPECT_EQ(text_of("dirname", {{"dirname", "mine"}}), "mine");
  EXPECT_EQ(mistake("min([])").message, "min of an empty list");
  EXPECT_EQ(mistake("sqr(2)").marked, "sqr");
  EXPECT_EQ(mistake("sqr(2)").hint, "did you mean 'sqrt'?");
  EXPECT_EQ(mistake("sqrt(1, 2)").hint, "it is sqrt(x)");
  EXPECT_EQ(mistake("len(3)").marked, "3");
}

TEST(Expression, ReadsTheEnvironment) {
  ::setenv("COPPICE_TEST_NUMBER", "42", 1);
  ::unsetenv("COPPICE_TEST_NOTHING");
  EXPECT_EQ(number("env(COPPICE_TEST_NUMBER) + 1"), 43);
  EXPECT_EQ(number("env('COPPICE_TEST_NUMBER', 1)"), 42);
  EXPECT_EQ(text_of("env(COPPICE_TEST_NOTHING, 'none')"), "none");
  EXPECT_EQ(mistake("env(COPPICE_TEST_NOTHING)").marked, "COPPICE_TEST_NOTHING");
}

TEST(Expression, QuotesTexts) {
  EXPECT_EQ(text_of("'it''s'"), "it's");
  EXPECT_EQ(text_of("'a' + 'b'"), "ab");
  EXPECT_EQ(text_of("'}'"), "}");
  EXPECT_EQ(mistake("'abc").message, "a text is not closed");
  EXPECT_EQ(mistake("\"abc\"").hint, "texts stand in single quotes: 'text'");
  EXPECT_EQ(mistake("'a' + 1").hint, "texts are joined by standing side by side: name_${n}");
  EXPECT_EQ(mistake("'a' * 2").marked, "'a'");
}

TEST(Expression, PointsAtTheWrongToken) {
  EXPECT_EQ(mistake("1 + ").marked, " ");
  EXPECT_EQ(mistake("1 + * 2").marked, "*");
  EXPECT_EQ(mistake("(1 + 2").message, "the expression ends where ')' is expected");
  EXPECT_EQ(mistake("1 + 2)").marked, ")");
  EXPECT_EQ(mistake("[1, 2").message, "the expression ends where ',' or ']' is expected");
  EXPECT_EQ(mistake("1 2").marked, "2");
  EXPECT_EQ(mistake("x = 2", {{"x", "1"}}).hint, "'==' compares; key=value stands only in pick(...)");
  EXPECT_EQ(mistake("1 && 2").hint, "write 'and'");
  EXPECT_EQ(mistake("1 || 2").hint, "write 'or'");
  EXPECT_EQ(mistake("!true").marked, "!");
  EXPECT_EQ(mistake("${x}").marked, "$");
  EXPECT_EQ(mistake("3 hous").marked, "hous");
  EXPECT_EQ(mistake("2 x", {{"x", "1"}}).marked, "x");
  EXPECT_EQ(mistake("1 + nowhere * 2").marked, "nowhere");
  EXPECT_EQ(mistake("a \xC3\xA9 b").marked, "\xC3\xA9");
  EXPECT_EQ(mistake("else").marked, "else");
  EXPECT_EQ(mistake("1 if true").message, "the expression ends where 'else' is expected");
  EXPECT_EQ(mistake(" ").message, "an expression is empty");
}

TEST(Expression, LimitsItsDepth) {
  EXPECT_EQ(number(std::string(50, '(') + "1" + std::string(50, ')')), 1);
  EXPECT_NE(mistake(std::string(5000, '(') + "1" + std::string(5000, ')')).message, "");
  EXPECT_NE(mistake(std::string(5000, '-') + "1").message, "");
  std::string powers = "1", sums = "1", conditions = "1";
  for (int i = 0; i < 5000; ++i) {
    powers += "**1";
    sums += "+1";
    conditions += " if true else 1";
  }
  EXPECT_NE(mistake(powers).message, "");
  EXPECT_NE(mistake(sums).message, "");
  EXPECT_NE(mistake(conditions).message, "");
}

TEST(Expression, TellsTheNamesThatItUses) {
  const std::string text = "a + min(b, 3 m) if c == 'd' else [e][f]";
  EXPECT_EQ(Expression::parse(text, 0, text.size()).names(),
            (std::vector<std::string>{"a", "b", "c", "e", "f"}));
}

}  // namespace
}  // namespace coppice::config
