#include "registry/parameters.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "registry/component.h"
#include "registry/source.h"
#include "tests/support/temporary_folder.h"

namespace coppice {
namespace {

enum class Mode { slow, fast };

/// One parameter of every type.
struct Everything {
  double period = 0.05;
  double angle = 0.5;
  double gain = -1;
  double limit = std::numeric_limits<double>::infinity();
  std::int64_t samples = 100;
  int leaves = 50;
  bool noisy = false;
  std::string title = "untitled";
  Mode mode = Mode::slow;
  std::vector<double> angles = {0, 1};
  std::vector<std::string> words;
  FilePath data;
  std::optional<int> population;
  std::optional<double> width;

  static Parameters<Everything> parameters() {
    using T = Everything;
    return Parameters<T>()
        .add("period", &T::period, "s", "Time of a step.", above(0))
        .add("angle", &T::angle, "rad", "An angle.", between(-std::numbers::pi, std::numbers::pi))
        .add("gain", &T::gain, "", "A plain number.")
        .add("limit", &T::limit, "m", "May be infinite.", at_least(0))
        .add("samples", &T::samples, "", "How many.", at_least(2))
        .add("leaves", &T::leaves, "", "Leaves.", between(1, 1e9))
        .add("noisy", &T::noisy, "", "Whether there is noise.")
        .add("title", &T::title, "", "Any text.")
        .choice("mode", &T::mode, {"slow", "fast"}, "How.")
        .add("angles", &T::angles, "rad", "Several angles.", at_least(0))
        .add("words", &T::words, "", "Several texts.")
        .add("data", &T::data, "", "A file.")
        .automatic("population", &T::population, "", "Worked out.", at_least(2))
        .automatic("width", &T::width, "m", "Worked out.", above(0));
  }
};

struct Result {
  Everything value;
  Element resolved;
  std::vector<Diagnostic> errors;
  std::string text;  ///< of all errors
};

Result read(const std::string& attributes, const std::string& path = "a.xml") {
  const auto source = std::make_shared<SourceFile>(SourceFile{path, "<thing " + attributes + "/>"});
  const Element element = parse_xml(source);
  Diagnostics diagnostics;
  Result result;
  Reader reader(element, &result.resolved, &diagnostics);
  result.value = Everything::parameters().read(reader);
  result.errors = diagnostics.all();
  for (const Diagnostic& error : result.errors) result.text += to_text(error);
  return result;
}

TEST(Parameters, KeepDefaultsOfMembers) {
  const Result result = read("");
  EXPECT_TRUE(result.errors.empty());
  EXPECT_EQ(result.value.period, 0.05);
  EXPECT_EQ(result.value.title, "untitled");
  EXPECT_FALSE(result.value.population.has_value());
}

TEST(Parameters, ConvertUnitsToSi) {
  const Result result = read(R"(period="20 ms" angle="90 deg" angles="1 turn, 0.5, 180 deg" width="3 cm")");
  EXPECT_EQ(result.text, "");
  EXPECT_EQ(result.value.period, 0.02);
  EXPECT_EQ(result.value.angle, std::numbers::pi / 2);
  EXPECT_EQ(result.value.angles, (std::vector<double>{2 * std::numbers::pi, 0.5, std::numbers::pi}));
  EXPECT_EQ(result.value.width, 0.03);
}

TEST(Parameters, ReadEveryOtherType) {
  const Result result = read(
      R"(samples="1e5" leaves=" 10000 " noisy="1" title=" a, b " mode="fast" words="x, y z,w" population="7" limit="inf")");
  EXPECT_EQ(result.text, "");
  EXPECT_EQ(result.value.samples, 100000);
  EXPECT_EQ(result.value.leaves, 10000);
  EXPECT_TRUE(result.value.noisy);
  EXPECT_EQ(result.value.title, " a, b ");
  EXPECT_EQ(result.value.mode, Mode::fast);
  EXPECT_EQ(result.value.words, (std::vector<std::string>{"x", "y z", "w"}));
  EXPECT_EQ(result.value.population, 7);
  EXPECT_TRUE(std::isinf(result.value.limit));
}

TEST(Parameters, ReadLargeIntegersExactly) {
  EXPECT_EQ(read(R"(samples="9223372036854775807")").value.samples, INT64_MAX);
}

TEST(Parameters, ResolvedElementReadsBackToItself) {
  const Result once =
      read(R"(period="7 ms" angle="20 deg" angles="3 deg" mode="fast" population="9" title="&lt;")");
  const auto source = std::make_shared<SourceFile>(SourceFile{"resolved.xml", to_xml(once.resolved)});
  Diagnostics diagnostics;
  Element twice;
  const Element element = parse_xml(source);
  Reader reader(element, &twice, &diagnostics);
  Everything::parameters().read(reader);
  EXPECT_TRUE(diagnostics.empty());
  EXPECT_EQ(to_xml(twice), to_xml(once.resolved));
  EXPECT_EQ(to_xml(Everything::parameters().print(once.value, "thing")), to_xml(once.resolved));
}

struct Mistake {
  const char* attributes;
  const char* message;  ///< part of the text
};

class Mistakes : public testing::TestWithParam<Mistake> {};

TEST_P(Mistakes, AreReportedOnceWithRule) {
  const Result result = read(GetParam().attributes);
  ASSERT_EQ(result.errors.size(), 1u) << result.text;
  EXPECT_NE(result.text.find(GetParam().message), std::string::npos) << result.text;
  EXPECT_GT(result.errors.front().place.column, 0);
}

INSTANTIATE_TEST_SUITE_P(
    OfValues, Mistakes,
    testing::Values(
        Mistake{R"(period="20 deg")", "'20 deg' is an angle (rad); 'period' needs a time (s)"},
        Mistake{R"(period="0")", "'period' is 0 s, but must be > 0 s"},
        Mistake{R"(period="-1 ms")", "'period' is -0.001 s, but must be > 0 s"},
        Mistake{R"(period="nan")", "'nan' is not a number"},
        Mistake{R"(period="inf")", "'period' must be finite"},
        Mistake{R"(period="")", "'period' has an empty value"},
        Mistake{R"(period="0x10")", "'0x10' is not a number"},
        Mistake{R"(period="1,5")", "'1,5' is not a number"}, Mistake{R"(period="1e999")", "is not a number"},
        Mistake{R"(period="50 %")", "'50 %' is a plain number; 'period' needs a time (s)"},
        Mistake{R"(period="2 sec")", "'2 sec' is not a number with a known unit"},
        Mistake{R"(gain="3 m")", "'3 m' is a length (m); 'gain' needs a plain number"},
        Mistake{R"(angle="200 deg")", "but must be in [-3.141592653589793, 3.141592653589793] rad"},
        Mistake{R"(angles="1, -1, 2")", "'angles' is -1 rad, but must be >= 0 rad"},
        Mistake{R"(angles="1,,2")", "'angles' has an empty item"},
        Mistake{R"(samples="2.5")", "'2.5' is not a whole number"}, Mistake{R"(samples="1")", "must be >= 2"},
        Mistake{R"(samples="1e30")", "'1e30' is too large"},
        Mistake{R"(samples="99999999999999999999")", "is too large"},
        Mistake{R"(samples="3 m")", "is a length"}, Mistake{R"(leaves="1e10")", "'leaves' is 10000000000"},
        Mistake{R"(population="3000000000")", "'population' is 3000000000, but must be in [2, 2147483647]"},
        Mistake{R"(noisy="yes")", "'yes' is neither true nor false"},
        Mistake{R"(mode="fats")", "did you mean 'fast'? valid: slow, fast"},
        Mistake{R"(population="automatic")", "integer >= 2, default auto"},
        Mistake{R"(data="a/nowhere.csv")", "there is no file"},
        Mistake{R"(perod="1")", "<thing> has no parameter 'perod'"},
        Mistake{R"(perod="1")", "did you mean 'period' (number > 0 s, default 0.05 s)?"},
        Mistake{R"(popluation="20")", "did you mean 'population' (integer >= 2, default auto)?"}));

TEST(Parameters, PointAtTheWrongItemOfAList) {
  const Result result = read(R"(angles="1, x, 2")");
  ASSERT_EQ(result.errors.size(), 1u);
  EXPECT_EQ(result.errors[0].place.column, 19);
  EXPECT_EQ(result.errors[0].place.length, 1);
}

TEST(Parameters, ReportAllMistakesOfAnElement) {
  EXPECT_EQ(read(R"(period="x" angle="y" nothing="1" samples="0")").errors.size(), 4u);
}

TEST(Parameters, FileIsRelativeToTheConfig) {
  const TemporaryFolder folder;
  folder.write("samples.csv", "x\n");
  const std::string config = (folder / "config.xml").string();
  EXPECT_EQ(read(R"(data="samples.csv")", config).value.data.path, (folder / "samples.csv").string());
  EXPECT_EQ(read(R"(data="./samples.csv")", config).resolved.get("data"), (folder / "samples.csv").string());
  EXPECT_NE(read(R"(data="sample.csv")", config).text.find("did you mean 'samples.csv'?"), std::string::npos);
  EXPECT_NE(read(R"(data=".")", config).text.find("is a folder"), std::string::npos);
}

/// References and required parameters.
struct Linked {
  std::string id;
  Reference problem;
  Reference samples;
  References policies;
  double width = 0;

  static Parameters<Linked> parameters() {
    using T = Linked;
    return Parameters<T>()
        .require("id", &T::id, "", "Its name.")
        .require("width", &T::width, "m", "How wide.", above(0))
        .reference("problem", &T::problem, "problem", "What to solve.")
        .reference("samples", &T::samples, "dataset", "Where from.", false)
        .references("policies", &T::policies, "policy", "Which.", true, true);
  }
};

std::vector<Diagnostic> read_linked(const std::string& attributes, Linked* value = nullptr) {
  const auto source = std::make_shared<SourceFile>(SourceFile{"a.xml", "<linked " + attributes + "/>"});
  const Element element = parse_xml(source);
  Diagnostics diagnostics;
  Element resolved;
  Reader reader(element, &resolved, &diagnostics);
  const Linked read = Linked::parameters().read(reader);
  if (value != nullptr) *value = read;
  return diagnostics.all();
}

TEST(Parameters, ReadReferences) {
  Linked value;
  EXPECT_TRUE(read_linked(R"(id="a" width="1" problem=" p " policies="x, y")", &value).empty());
  EXPECT_EQ(value.problem.id, "p");
  ASSERT_EQ(value.policies.size(), 2u);
  EXPECT_EQ(value.policies[1].id, "y");
  EXPECT_EQ(value.samples.id, "");
}

TEST(Parameters, RequireWhatHasNoDefault) {
  const std::vector<Diagnostic> errors = read_linked(R"(id="a" problem="p")");
  ASSERT_EQ(errors.size(), 2u);
  EXPECT_EQ(errors[0].message, "<linked> needs 'width'");
  EXPECT_EQ(errors[0].hint, "How wide. (number > 0 m, required)");
  EXPECT_EQ(errors[1].message, "<linked> needs 'policies'");
}

TEST(Parameters, AMisspeltRequiredOneIsOneMistake) {
  const std::vector<Diagnostic> errors = read_linked(R"(id="a" widht="1" problem="p" policies="x")");
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_EQ(errors[0].message, "<linked> has no parameter 'widht'");
}

TEST(Parameters, RefuseEmptyAndDoubledReferences) {
  EXPECT_EQ(read_linked(R"(id="" width="1" problem="" policies="")").size(), 3u);
  const std::vector<Diagnostic> doubled = read_linked(R"(id="a" width="1" problem="p" policies="x, x")");
  ASSERT_EQ(doubled.size(), 1u);
  EXPECT_EQ(doubled[0].message, "'x' stands twice in 'policies'");
  EXPECT_EQ(read_linked(R"(id="a" width="1" problem="p, q" policies="x")").size(), 1u);
}

TEST(Parameters, DeclareWhatTheyRead) {
  const std::vector<ParameterInfo> infos = Linked::parameters().parameters();
  ASSERT_EQ(infos.size(), 5u);
  EXPECT_TRUE(infos[0].required);
  EXPECT_EQ(infos[2].artifact, "problem");
  EXPECT_TRUE(infos[4].fan_out);
  EXPECT_EQ(Everything::parameters().parameters()[0].default_text, "0.05");
}

}  // namespace
}  // namespace coppice
