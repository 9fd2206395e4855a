#include <gmock/gmock.h>

#include "tests/engine/config/config_testing.h"

namespace coppice {
namespace {

using config_testing::document;
using testing::HasSubstr;

/// What is said of the parts that the expansion of a body leaves out.
std::string said(const std::string& body, const std::vector<std::string>& words = {}) {
  const ExperimentConfig config = config_testing::good(body, words);
  Diagnostics diagnostics;
  check_unused(config, diagnostics);
  std::string all;
  for (const Diagnostic& error : diagnostics.all()) all += to_text(error);
  return all;
}

TEST(UnusedParts, WordsThatExistPass) {
  EXPECT_EQ(said("<group if=\"false\"><let name=\"n\" value=\"${1 / 0}\"/>"
                 "<sweep id=\"S\"><random n=\"${n}\"><param name=\"w\" min=\"0\" max=\"1\"/></random>"
                 "<exclude when=\"${w gt 2}\"/></sweep>"
                 "<problem id=\"p\" over=\"S\"><double_integrator cost=\"${w}\"/></problem></group>"),
            "");
  EXPECT_EQ(
      said("<macro name=\"m\" params=\"a, b:=${a}, *c\" doc=\"d\">"
           "<collect id=\"${a}\" problem=\"p\" samples=\"${b}\" horizon=\"${w}\"/>"
           "<train id=\"t\" problem=\"p\"><insert block=\"c\"/></train><extra_trees trees=\"5\"/></macro>"
           "<sweep id=\"S\"><list><point w=\"1\"/></list></sweep>"),
      "");
}

TEST(UnusedParts, PartsOfComponentsAndSweepsKnowWhereTheyStand) {
  EXPECT_THAT(said("<problem id=\"p\"><double_integrater if=\"false\"/></problem>"),
              HasSubstr("'double_integrater'"));
  EXPECT_THAT(said("<sweep id=\"S\"><grid><param name=\"a\" values=\"1\"/>"
                   "<param if=\"false\" name=\"b\" value=\"1\"/></grid></sweep>"),
              HasSubstr("<param> has no attribute 'value'"));
  EXPECT_THAT(said("<let if=\"false\" name=\"a\" valu=\"1\"/>"), HasSubstr("<let> has no attribute 'valu'"));
}

TEST(UnusedParts, MissWhatTheyWouldNeed) {
  EXPECT_THAT(said("<macro name=\"m\"><train id=\"t\"><fqi/></train><insert/></macro>"),
              AllOf(HasSubstr("<train> needs 'problem'"), HasSubstr("<insert> needs the attribute 'block'")));
  EXPECT_THAT(said("<evaluate if=\"false\" id=\"e\" problem=\"p\" policies=\"q\"/>"),
              HasSubstr("<evaluate> needs 'episodes'"));
  EXPECT_THAT(said("<let if=\"false\" name=\"a\"/>"), HasSubstr("<let> needs the attribute 'value'"));
}

TEST(UnusedParts, NamesAreThoseOfAllFilesWhateverTheirConditions) {
  const std::string macro = "<macro name=\"m\" params=\"a\"><policy id=\"${a + n}\"/></macro>";
  EXPECT_THAT(said(macro), HasSubstr("there is no name 'n'"));
  EXPECT_EQ(said("<let name=\"n\" value=\"1\" if=\"false\"/>" + macro), "");
  EXPECT_EQ(said("<include file=\"elsewhere.xml\" if=\"false\"/>" + macro), "");
  const config_testing::Folder folder(
      {{"library.xml", document(macro)}, {"main.xml", document("<include file=\"library.xml\"/>")}});
  Diagnostics diagnostics;
  check_unused(folder.expand_file("main.xml").config, diagnostics);
  EXPECT_TRUE(diagnostics.empty()) << "a library may be meant for names that other configs have";
}

TEST(UnusedParts, AMacroThatIsCalledForSomeValuesOnlyIsSaidOnce) {
  const std::string body =
      "<arg name=\"a\" type=\"integer\" default=\"1\"/><macro name=\"m\" params=\"\">"
      "<policy id=\"p\"><randm/></policy></macro><call macro=\"m\" if=\"${a == 3}\"/>";
  const std::string all = said(body, {"a:=1,2"});
  EXPECT_THAT(all, HasSubstr("has no element <randm>"));
  EXPECT_EQ(all.find("error: "), all.rfind("error: "));
  EXPECT_EQ(said(body, {"a:=3"}), "") << "what is used is checked when planning";
}

}  // namespace
}  // namespace coppice
