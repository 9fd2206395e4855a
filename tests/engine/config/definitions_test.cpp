#include <fmt/format.h>

#include <cstdlib>

#include "tests/engine/config/config_testing.h"

namespace coppice {
namespace {

using namespace config_testing;

TEST(Text, JoinsExpressionsAndLiterals) {
  const std::string lets =
      R"(<let name="n" value="3"/><let name="word" value="tree"/><let name="on" value="true"/>)";
  EXPECT_EQ(value_of("a_${n}_b", lets), "a_3_b");
  EXPECT_EQ(value_of("${word}${n}", lets), "tree3");
  EXPECT_EQ(value_of("${n + 1}, ${n * 2}", lets), "4, 6");
  EXPECT_EQ(value_of("${on and n gt 2}", lets), "true");
  EXPECT_EQ(value_of("${[n, n + 1]}", lets), "3, 4");
  EXPECT_EQ(value_of("plain", lets), "plain");
  EXPECT_EQ(value_of("", lets), "");
}

TEST(Text, KeepsTheSpellingOfWhatWasWritten) {
  EXPECT_EQ(value_of("${angle}", R"(<let name="angle" value="20 deg"/>)"), "20 deg");
  EXPECT_EQ(value_of("${gamma}", R"(<let name="gamma" value="0.90"/>)"), "0.90");
  EXPECT_EQ(value_of("${id}", R"(<let name="id" value="007"/>)"), "007");
  EXPECT_EQ(value_of("${list}", R"(<let name="list" value="1,2 , 3"/>)"), "1,2 , 3");
}

TEST(Text, KeepsTheUnitOfWhatWasComputed) {
  EXPECT_EQ(value_of("${2 * t}", R"(<let name="t" value="3 h"/>)"), "21600 s");
  EXPECT_EQ(value_of("${v * t}", R"(<let name="t" value="3 s"/><let name="v" value="2 m/s"/>)"), "6 m");
  EXPECT_EQ(value_of("${180 deg / 2}"), "1.5707963267948966 rad");
  EXPECT_EQ(value_of("${n} h", R"(<let name="n" value="3"/>)"), "3 h");
}

TEST(Text, PrintsNumbersSoThatTheyReadBackEqual) {
  EXPECT_EQ(value_of("${10 ** 6}"), "1000000");
  EXPECT_EQ(value_of("${1 / 3}"), "0.3333333333333333");
  EXPECT_EQ(value_of("${0.1 + 0.2}"), "0.30000000000000004");
  EXPECT_EQ(value_of("${2 ** 53}"), "9007199254740992");
}

TEST(Text, EscapesDollars) {
  EXPECT_EQ(value_of("$${x}"), "${x}");
  EXPECT_EQ(value_of("$$(arg x)"), "$(arg x)");
  EXPECT_EQ(value_of("$$${x}"), "$${x}");
  EXPECT_EQ(value_of("5 $ and $$"), "5 $ and $$");
  EXPECT_EQ(value_of("a}b"), "a}b");
}

TEST(Text, KnowsTheSpellingsOfRos) {
  ::setenv("COPPICE_TEST_WORD", "forest", 1);
  ::unsetenv("COPPICE_TEST_NOTHING");
  const std::string arg = R"(<arg name="n" default="3"/>)";
  EXPECT_EQ(value_of("$(arg n)", arg), "3");
  EXPECT_EQ(value_of("$(var n)-$(arg n)", arg), "3-3");
  EXPECT_EQ(value_of("$(env COPPICE_TEST_WORD)"), "forest");
  EXPECT_EQ(value_of("$(env COPPICE_TEST_NOTHING a b)"), "a b");
  EXPECT_EQ(value_of("$(dirname)"), std::filesystem::current_path().string());
  EXPECT_EQ(value_of("${dirname()}"), std::filesystem::current_path().string());
}

TEST(Text, RefusesOtherSubstitutions) {
  EXPECT_EQ(marked(bad(R"x(<x value="a $(find pkg)/b"/>)x")), "find");
  EXPECT_EQ(bad(R"x(<x value="$(eval 1 + 1)"/>)x").hint, "expressions stand in ${...}");
  EXPECT_EQ(bad(R"x(<x value="$(optenv A b)"/>)x").hint, "write $(env NAME default)");
  EXPECT_EQ(marked(bad(R"x(<x value="$(arg)"/>)x")), "arg");
  EXPECT_EQ(marked(bad(R"x(<x value="$(arg a b)"/>)x")), "a b");
  EXPECT_EQ(bad(R"x(<x value="$(arg n"/>)x").message, "a substitution is not closed");
  EXPECT_EQ(bad(R"(<x value="${n"/>)").message, "an expression is not closed");
}

TEST(Text, FindsEveryMistakeOfAnAttribute) {
  const Outcome outcome = expand_body(R"x(<x value="${a} and ${1 +} and $(b)"/>)x");
  ASSERT_EQ(outcome.errors.size(), 3u) << outcome.text();
  EXPECT_EQ(marked(outcome.errors[0]), "a");
  EXPECT_EQ(marked(outcome.errors[2]), "b");
  EXPECT_TRUE(outcome.config.nodes.at(0).element.find("value")->failed);
  EXPECT_TRUE(outcome.config.complete);
}

TEST(Let, KeepsTheTypeOfALoneExpression) {
  EXPECT_EQ(value_of("${len(a)}", R"(<let name="a" value="${range(1, 4)}"/>)"), "4");
  EXPECT_EQ(value_of("${not a}", R"(<let name="a" value=" ${1 == 2} "/>)"), "true");
  EXPECT_EQ(value_of("${a + 1}", R"(<let name="a" value="1${0}"/>)"), "11");
}

TEST(Let, IsDefinedOnce) {
  const Diagnostic error = bad("<let name=\"n\" value=\"1\"/>\n<let name=\"n\" value=\"2\"/>");
  EXPECT_EQ(error.place.line, 3);
  EXPECT_EQ(error.message, "'n' is defined a second time");
  EXPECT_EQ(error.hint, "it is the constant defined at test.xml:2:12");
  EXPECT_EQ(bad("<arg name=\"n\" default=\"1\"/>\n<let name=\"n\" value=\"1\"/>").message,
            "'n' is defined a second time");
}

TEST(Let, NeedsAName) {
  for (const char* name : {"", "2x", "a-b", "a b", "if", "true", "and", "min", "${x}"}) {
    const Diagnostic error = bad(std::string("<let name=\"") + name + "\" value=\"1\"/>");
    EXPECT_EQ(error.message, std::string("'") + name + "' cannot be a name");
  }
}

TEST(Let, IsKnownOnlyBelowItsDefinition) {
  const Diagnostic error = bad("<x value=\"${n}\"/>\n<let name=\"n\" value=\"1\"/>");
  EXPECT_EQ(error.message, "'n' has no value here");
  EXPECT_EQ(error.hint,
            "it is defined at test.xml:3; a definition stands before its use, where its conditions hold");
}

TEST(Let, CannotDefineItselfInACircle) {
  EXPECT_EQ(bad(R"(<let name="a" value="${a + 1}"/>)").message, "'a' is defined by itself");
  const Diagnostic error =
      bad(R"(<let name="a" value="${b}"/><let name="b" value="${c}"/><let name="c" value="${a}"/>)");
  EXPECT_EQ(error.message, "'a' is defined by itself, in a circle: a -> b -> c -> a");
}

TEST(Let, ReportsNothingTwiceAfterAMistake) {
  const Diagnostic error =
      bad(R"(<let name="a" value="${1 / 0}"/><let name="b" value="${a + 1}"/><x value="${b}"/>)");
  EXPECT_EQ(error.message, "division by zero");
}

TEST(Names, AreSuggestedWhenMisspelt) {
  const std::string lets = R"(<let name="horizon" value="50"/><let name="gamma" value="0.9"/>)";
  EXPECT_EQ(bad(lets + R"(<x value="${horizn}"/>)").hint, "did you mean 'horizon'?");
  EXPECT_EQ(bad(lets + R"(<x value="${zzz == 1}"/>)").hint,
            "valid: gamma, horizon; a text stands in single quotes: 'zzz'");
  EXPECT_EQ(bad(R"(<x value="${min}"/>)").message, "'min' is a function");
}

TEST(Arg, TakesDefaultOrCommandLine) {
  const std::string arg = R"(<arg name="n" default="3"/>)";
  EXPECT_EQ(value_of("${n + 1}", arg), "4");
  EXPECT_EQ(value_of("${n + 1}", arg, {"n:=10"}), "11");
  EXPECT_EQ(value_of("${n}", R"(<arg name="n"/>)", {"n:=a b"}), "a b");
  const Diagnostic error = bad(R"(<arg name="n"/><x value="${n}"/>)");
  EXPECT_EQ(error.message, "the argument 'n' has no value");
  EXPECT_EQ(error.hint, "give n:=... on the command line, or a default");
}

TEST(Arg, RecordsFinalValues) {
  const ExperimentConfig config =
      good(R"(<arg name="n" default="3"/><arg name="m" default="${n * 2} h"/><arg name="k" default="1"/>)",
           {"n:=4", "k:=1,2"});
  EXPECT_EQ(config.arguments, (std::map<std::string, std::string>{{"k", "1,2"}, {"m", "8 h"}, {"n", "4"}}));
  ASSERT_EQ(config.overrides.size(), 2u);
  EXPECT_EQ(config.overrides[0].name, "n");
}

TEST(Arg, ChecksItsType) {
  const auto arg = [](const std::string& type) {
    return "<arg name=\"n\" type=\"" + type + "\"/><x value=\"${n}\"/>";
  };
  EXPECT_EQ(good(arg("integer"), {"n:=12"}).nodes[0].element.get("value"), "12");
  EXPECT_EQ(good(arg("boolean"), {"n:=true"}).nodes[0].element.get("value"), "true");
  EXPECT_EQ(good(arg("number"), {"n:=2 cm"}).nodes[0].element.get("value"), "2 cm");
  EXPECT_EQ(bad(arg("integer"), {"n:=1.5"}).message,
            "the argument 'n' must be an integer, not 1.5, a plain number");
  EXPECT_EQ(bad(arg("integer"), {"n:=2 cm"}).message,
            "the argument 'n' must be an integer, not 2 cm, a length (m)");
  EXPECT_EQ(bad(arg("number"), {"n:=many"}).message, "the argument 'n' must be a number, not text 'many'");
  EXPECT_EQ(bad(arg("boolean"), {"n:=1"}).message,
            "the argument 'n' must be true or false, not 1, a plain number");
  EXPECT_EQ(marked(bad(arg("boolean"), {"n:=1"})), "1");
  EXPECT_EQ(bad(R"(<arg name="n" type="intger" default="1"/>)").hint, "did you mean 'integer'?");
}

TEST(Arg, OfTypeTextIsNeverANumber) {
  EXPECT_EQ(value_of("${n == '007'}", R"(<arg name="n" type="text" default="007"/>)"), "true");
  EXPECT_EQ(bad(R"(<arg name="n" type="text" default="7"/><x value="${n + 1}"/>)").message,
            "'+' needs numbers, not text '7'");
}

TEST(Arg, OfTypeListIsNotSwept) {
  EXPECT_EQ(value_of("${len(n)}", R"(<arg name="n" type="list" default="1"/>)"), "1");
  EXPECT_EQ(value_of("${len(n)}", R"(<arg name="n" type="list" default="1"/>)", {"n:=1,2,3"}), "3");
}

TEST(Arg, HasAUnit) {
  const std::string arg = R"(<arg name="t" default="2" unit="h"/>)";
  EXPECT_EQ(value_of("${t}", arg), "2 h");
  EXPECT_EQ(value_of("${t / (1 min)}", arg), "120");
  EXPECT_EQ(value_of("${t}", arg, {"t:=90 min"}), "90 min");
  EXPECT_EQ(bad(arg, {"t:=3 m"}).message, "the argument 't' must be a time (s), not 3 m, a length (m)");
  EXPECT_EQ(bad(R"(<arg name="t" default="2" unit="hour"/>)").message, "'hour' is not a unit");
}

TEST(Arg, ChecksItsValues) {
  const std::string arg = R"(<arg name="scale" default="desk" values="ci, desk, paper"/>)";
  EXPECT_EQ(value_of("${scale}", arg, {"scale:=paper"}), "paper");
  const Diagnostic error = bad(arg, {"scale:=papr"});
  EXPECT_EQ(error.message, "the argument 'scale' cannot be 'papr'; its values: ci, desk, paper");
  EXPECT_EQ(error.hint, "did you mean 'paper'?");
  EXPECT_EQ(error.place.file->path, "<command line>");
  EXPECT_EQ(marked(error), "papr");
  EXPECT_EQ(bad(R"(<arg name="n" default="3" values="1, 2"/>)").message,
            "the argument 'n' cannot be '3'; its values: 1, 2");
  EXPECT_EQ(value_of("${n}", R"(<arg name="n" default="2.0" values="1, 2"/>)"), "2.0");
}

TEST(Overrides, MustBeDeclared) {
  const Diagnostic error = bad(R"(<arg name="episodes" default="3"/>)", {"episods:=4"});
  EXPECT_EQ(error.message, "no config declares an argument 'episods'");
  EXPECT_EQ(error.hint, "did you mean 'episodes'?");
  EXPECT_EQ(bad("", {"a:=1"}).hint, "they declare none");
}

TEST(Overrides, AreGivenOnce) {
  EXPECT_EQ(bad(R"(<arg name="n" default="3"/>)", {"n:=4", "n:=5"}).message,
            "the argument 'n' is given twice");
}

TEST(Overrides, BelongToTheConfigsThatDeclareThem) {
  const std::vector<Override> given = overrides({"a:=1", "b:=2", "c:=3"});
  std::vector<ExperimentConfig> experiments;
  Diagnostics diagnostics;
  for (const char* name : {"a", "b"}) {
    const auto source = std::make_shared<const SourceFile>(
        SourceFile{"t.xml", document(std::string("<arg name=\"") + name + "\" default=\"0\"/>")});
    experiments.push_back(expand(source, ExpandOptions{given, std::nullopt}, diagnostics));
  }
  EXPECT_TRUE(diagnostics.empty());
  EXPECT_EQ(experiments[1].arguments.at("b"), "2");
  EXPECT_EQ(experiments[1].overrides.size(), 1u);
  check_overrides(experiments, given, diagnostics);
  ASSERT_EQ(diagnostics.all().size(), 1u);
  EXPECT_EQ(diagnostics.all()[0].message, "no config declares an argument 'c'");
}

TEST(Overrides, SweepWithACommaList) {
  const ExperimentConfig config = good(
      R"(<arg name="a" default="0"/><arg name="b" default="0"/><let name="s" value="${a + b}"/><x id="x" v="${s}"/>)"
      R"(<y id="y" if="${a == 2}"/>)",
      {"b:=10,20", "a:=1,2"});
  EXPECT_EQ(nodes_text(config),
            "<x id=\"x\" v=\"11\"/> {a=1} {b=10}\n"
            "<x id=\"x\" v=\"21\"/> {a=1} {b=20}\n"
            "<x id=\"x\" v=\"12\"/> {a=2} {b=10}\n"
            "<x id=\"x\" v=\"22\"/> {a=2} {b=20}\n"
            "<y id=\"y\"/> {a=2} {b=10}\n"
            "<y id=\"y\"/> {a=2} {b=20}\n");
  ASSERT_EQ(config.sweeps.size(), 2u);
  EXPECT_EQ(config.sweeps[0].id, "a");
  EXPECT_TRUE(config.sweeps[0].from_command_line);
  EXPECT_EQ(config.sweeps[0].points, (std::vector<Point>{{{"a", "1"}}, {{"a", "2"}}}));
  EXPECT_EQ(config.nodes[0].sweeps, (std::vector<std::string>{"a", "b"}));
}

TEST(Overrides, SweepBesideTheSweepsOfTheConfig) {
  const ExperimentConfig config = good(
      R"(<arg name="n" default="1"/><sweep id="s"><grid><param name="v" values="${range(1, n)}"/></grid></sweep>)"
      R"(<x id="x" over="s" at2="${v}"/>)",
      {"n:=1,2"});
  EXPECT_EQ(nodes_text(config),
            "<x id=\"x\" at2=\"1\"/> {n=1} {v=1}\n<x id=\"x\" at2=\"1\"/> {n=2} {v=1}\n<x id=\"x\" "
            "at2=\"2\"/> {n=2} {v=2}\n");
  EXPECT_EQ(config.sweeps.at(1).points.size(), 2u);
}

TEST(Overrides, CannotSweepUnderATakenName) {
  EXPECT_EQ(bad(R"(<arg name="s" default="1"/><sweep id="s"><list><point v="1"/></list></sweep>)", {"s:=1,2"})
                .message,
            "the argument 's' cannot be swept: a sweep has the same name");
  const Outcome outcome = expand_body(
      R"(<arg name="s" default="1"/><sweep id="s"><grid><param name="v" values="${s}"/></grid></sweep>)"
      R"(<x id="x" over="s" at2="${v}"/>)",
      {"s:=1,2"});
  EXPECT_EQ(outcome.errors.size(), 1u) << outcome.text();
  EXPECT_EQ(nodes_text(outcome.config), "") << "no nodes at points that are not there, to be wrong in turn";
  for (const auto& [given, value] :
       {std::pair("s:=1,1", "1"), {"s:=2,2.0", "2.0"}, {"s:=5,1,05", "05"}, {"s:=100 cm,1 m", "1 m"}}) {
    const Diagnostic twice = bad(R"(<arg name="s" default="1"/>)", {given});
    EXPECT_EQ(twice.message, fmt::format("the argument 's' is given the value {} twice", value));
    const auto column = std::string("runner ").size() + std::string(given).rfind(value) + 1;
    EXPECT_EQ(twice.place.column, static_cast<int>(column)) << given;
  }
  const Outcome unread = expand_body(R"(<arg name="n" type="integer" default="1"/>)", {"n:=a,b"});
  EXPECT_EQ(unread.errors.size(), 2u) << "two values that are no numbers, and not one twice\n"
                                      << unread.text();
  for (const char* given : {"s:=1,", "s:=1,,2", "s:=,1"})
    EXPECT_EQ(bad(R"(<arg name="s" default="1"/>)", {given}).message, "'s' has an empty item") << given;
  EXPECT_EQ(
      bad(R"(<arg name="a" default="1"/><group if="${a == 1}"><arg name="b" default="1"/></group>)",
          {"b:=1,2", "a:=2,1"})
          .message,
      "the argument 'b' cannot be swept: it is declared for some values of another swept argument only");
}

TEST(Overrides, QuoteACommaThatIsNoSweep) {
  EXPECT_EQ(value_of("${t}", R"(<arg name="t"/>)", {"t:='a, b'"}), "a, b");
}

TEST(Conditions, HoldOnEveryElement) {
  const ExperimentConfig config = good(
      R"(<let name="yes" value="true"/><let name="no" value="false" if="${yes}"/>)"
      R"(<x id="a" if="${yes}"/><x id="b" if="${no}"/><x id="c" unless="${no}"/><x id="d" unless="true"/>)"
      R"(<x id="e"><y><z if="false"/><z unless="false"/></y></x><let name="yes" value="1" if="false"/>)"
      R"(<group if="${no}"><x id="f" value="${nowhere}"/></group><x id="g" if="true" unless="true"/>)");
  EXPECT_EQ(nodes_text(config),
            "<x id=\"a\"/>\n<x id=\"c\"/>\n<x id=\"e\">\n  <y>\n    <z/>\n  </y>\n</x>\n");
}

TEST(Conditions, AreTrueOrFalse) {
  const Diagnostic error = bad(R"(<x id="a" if="yes"/>)");
  EXPECT_EQ(error.message, "'if' must be true or false, not text 'yes'");
  EXPECT_EQ(marked(error), "yes");
  EXPECT_EQ(bad(R"(<x id="a" unless="1"/>)").message,
            "'unless' must be true or false, not 1, a plain number");
}

TEST(Conditions, LeaveOutANodeWithItsSweep) {
  const std::string sweep = R"(<sweep id="s"><grid><param name="g" values="1, 2"/></grid></sweep>)";
  const std::string left_out =
      R"(<arg name="more" default="false"/><group if="${more}">)" + sweep + "</group>";
  for (const char* condition :
       {"${more}", "${more and g gt 1}", "${g gt 1 and more}", "${not (g gt 1 or not more)}",
        "${g gt 1 and env(NO_SUCH_NAME) == 'a' and more}", "${g gt 1}\" unless=\"${not more}"}) {
    const Outcome outcome = expand_body(left_out + R"(<x id="x" over="s" if=")" + condition + R"("/>)");
    EXPECT_TRUE(outcome.config.complete) << "arguments that nothing declares are reported";
    EXPECT_EQ(outcome.text(), "") << condition;
    EXPECT_EQ(nodes_text(outcome.config), "") << condition;
    EXPECT_EQ(outcome.config.left_out.size(), 2u);
  }
  EXPECT_EQ(bad(left_out + R"(<x id="x" over="s" if="${g gt 1 or more}"/>)").message,
            "the sweep 's' is left out here");
}

TEST(Root, NeedsTheVersionOfTheLanguage) {
  const auto error = [](const std::string& text) {
    const Outcome outcome = expand_document(text);
    EXPECT_EQ(outcome.errors.size(), 1u) << outcome.text();
    return outcome.errors.empty() ? "" : outcome.errors[0].message;
  };
  EXPECT_EQ(error("<experiment/>"), "<experiment> needs the attribute 'coppice'");
  EXPECT_EQ(error("<experiment coppice=\"2\"><anything/></experiment>"),
            "the file is written in version 2 of the language");
  EXPECT_EQ(error("<experiment coppice=\"one\"/>"), "'one' is not a version of the language");
  EXPECT_EQ(error("<experiment coppice=\"0\"/>"), "'0' is not a version of the language");
  EXPECT_EQ(error("<launch coppice=\"1\"/>"), "the root element is <launch>");
  EXPECT_EQ(error("<experiment coppice=\"1\" sed=\"3\"/>"), "<experiment> has no attribute 'sed'");
}

TEST(Root, HasNameSeedAndDoc) {
  const ExperimentConfig plain = expand_document("<experiment coppice=\"1\"/>").config;
  EXPECT_EQ(plain.name, "test");
  EXPECT_EQ(plain.seed, 1u);
  const ExperimentConfig full =
      expand_document(
          "<experiment coppice=\"1\" name=\"a.b-c_1\" seed=\"18446744073709551615\" doc=\"d &amp; e\"/>")
          .config;
  EXPECT_EQ(full.name, "a.b-c_1");
  EXPECT_EQ(full.seed, 18446744073709551615u);
  EXPECT_EQ(full.doc, "d & e");
}

TEST(Root, RefusesSeedsAndNamesThatCannotBe) {
  const auto errors = [](const std::string& attribute) {
    return expand_document("<experiment coppice=\"1\" " + attribute + "/>").errors.size();
  };
  for (const char* seed : {"-1", "1.5", "18446744073709551616", "", "x", "1e3"}) {
    EXPECT_EQ(errors(std::string("seed=\"") + seed + "\""), 1u) << seed;
  }
  for (const char* name : {"", "a/b", "..", ".hidden", "-x", "a b", "store"}) {
    EXPECT_EQ(errors(std::string("name=\"") + name + "\""), 1u) << name;
  }
}

TEST(Root, AllowsTheSchemaOfEditors) {
  const Outcome outcome = expand_document(
      "<experiment xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" "
      "xsi:noNamespaceSchemaLocation=\"c.xsd\" "
      "coppice=\"1\"/>");
  EXPECT_EQ(outcome.text(), "");
}

TEST(ControlElements, RefuseUnknownAttributesAndChildren) {
  EXPECT_EQ(bad(R"(<let name="a" value="1" vale="2"/>)").message, "<let> has no attribute 'vale'");
  EXPECT_EQ(bad(R"(<let name="a" value="1" vale="2"/>)").hint, "did you mean 'value'?");
  EXPECT_EQ(bad(R"(<arg name="a" value="1"/>)").message, "<arg> has no attribute 'value'");
  EXPECT_EQ(bad(R"(<let name="a"/>)").message, "<let> needs the attribute 'value'");
  EXPECT_EQ(bad(R"(<let name="a" value="1"><x/></let>)").message, "<x> does not belong in <let>");
  EXPECT_EQ(bad(R"(<group when="true"/>)").message, "<group> has no attribute 'when'");
  EXPECT_EQ(bad(R"(<x><arg name="a" default="1"/></x>)").message,
            "<arg> does not belong inside another element");
  EXPECT_EQ(bad(R"(<x><macro name="a"/></x>)").message, "<macro> does not belong inside another element");
  EXPECT_EQ(bad(R"(<x><sweep id="a"/></x>)").message, "<sweep> does not belong inside another element");
}

TEST(ControlElements, AreDeclaredWithDocs) {
  for (const ControlElement& element : control_elements()) {
    EXPECT_NE(element.doc, "") << element.name;
    for (const auto& [name, doc] : element.attributes) EXPECT_NE(doc, "") << element.name << " " << name;
  }
}

TEST(Let, InsideANodeBelongsToIt) {
  const ExperimentConfig config = good(
      R"(<x id="a"><let name="n" value="1"/><y v="${n}"/></x><x id="b"><let name="n" value="2"/><y v="${n}"/></x>)");
  EXPECT_EQ(config.nodes[0].element.children[0].get("v"), "1");
  EXPECT_EQ(config.nodes[1].element.children[0].get("v"), "2");
  EXPECT_EQ(bad(R"(<x id="a"><let name="n" value="1"/></x><x id="b" v="${n}"/>)").message,
            "'n' has no value here");
}

}  // namespace
}  // namespace coppice
