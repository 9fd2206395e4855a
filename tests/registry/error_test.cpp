#include "registry/error.h"

#include <gtest/gtest.h>

#include "registry/text.h"
#include "tests/registry/helpers.h"

namespace coppice {
namespace {

using test::text_file;

TEST(SourceFile, GivesLinesWithoutTheirEnds) {
  const SourceFile file{"a", "one\r\n\nthree"};
  EXPECT_EQ(file.line(1), "one");
  EXPECT_EQ(file.line(2), "");
  EXPECT_EQ(file.line(3), "three");
  EXPECT_EQ(file.line(4), "");
  EXPECT_EQ(file.line(0), "");
}

std::string lines(int count) {
  return std::string(static_cast<std::size_t>(count), '\n');
}

TEST(DiagnosticText, QuotesTheLineAndTellsHowItWasReached) {
  const auto all = text_file("", "configs/thesis/all.xml");
  const auto outer =
      std::make_shared<TraceFrame>(TraceFrame{"in macro 'trainer' called at", all, 19, nullptr});
  const auto inner = std::make_shared<TraceFrame>(TraceFrame{"included from", all, 4, outer});
  const auto file =
      text_file(lines(11) + "        <cma_es populaton=\"20\"/>\n", "configs/thesis/pendulum.xml");
  EXPECT_EQ(to_text({{file, 12, 17, 9, inner},
                     "<cma_es> has no parameter 'populaton'",
                     "did you mean 'population' (integer >= 2, default 4)?",
                     {}}),
            "configs/thesis/pendulum.xml:12:17: error: <cma_es> has no parameter 'populaton'\n"
            "   12 |         <cma_es populaton=\"20\"/>\n"
            "      |                 ^~~~~~~~~ did you mean 'population' (integer >= 2, default 4)?\n"
            "   note: included from configs/thesis/all.xml:4, in macro 'trainer' called at "
            "configs/thesis/all.xml:19\n");
}

TEST(DiagnosticText, WithoutLineKeepsTheHint) {
  EXPECT_EQ(
      to_text(
          {{text_file("", "a.xml"), 0, 0, 1, nullptr}, "the file is empty", "write something", {"first"}}),
      "a.xml: error: the file is empty\n   note: write something\n   note: first\n");
  EXPECT_EQ(to_text({{}, "nothing to do", "", {}}), "error: nothing to do\n");
}

TEST(DiagnosticText, CaretStandsBelowItsCharacterAfterTabsAndWideCharacters) {
  const auto tabs = text_file("\t\t<a b=\"1\"/>");
  EXPECT_EQ(to_text({{tabs, 1, 6, 1, nullptr}, "m", "", {}}),
            "a.xml:1:6: error: m\n    1 | \t\t<a b=\"1\"/>\n      | \t\t   ^\n");
  const auto accents = text_file("<h\xC3\xA9 x=\"\"/>");  // two bytes, one column
  EXPECT_EQ(to_text({{accents, 1, 5, 1, nullptr}, "m", "", {}}),
            "a.xml:1:5: error: m\n    1 | <h\xC3\xA9 x=\"\"/>\n      |     ^\n");
  const auto wide = text_file("<\xE4\xB8\xAD x=\"\"/>");  // one character, two columns
  EXPECT_EQ(to_text({{wide, 1, 4, 1, nullptr}, "m", "", {}}),
            "a.xml:1:4: error: m\n    1 | <\xE4\xB8\xAD x=\"\"/>\n      |     ^\n");
}

TEST(DiagnosticText, UnderlineEndsWithTheLine) {
  EXPECT_EQ(to_text({{text_file("<ab"), 1, 2, 100, nullptr}, "m", "h", {}}),
            "a.xml:1:2: error: m\n    1 | <ab\n      |  ^~ h\n");
  EXPECT_EQ(to_text({{text_file("<ab"), 1, 4, 1, nullptr}, "m", "", {}}),
            "a.xml:1:4: error: m\n    1 | <ab\n      |    ^\n");
}

TEST(DiagnosticText, CutsLongLinesAroundTheCaret) {
  const auto file = text_file(std::string(5000, 'x') + "HERE" + std::string(5000, 'y'));
  const std::string text = to_text({{file, 1, 5001, 4, nullptr}, "m", "", {}});
  EXPECT_LT(text.size(), 600u);
  const std::size_t quoted = text.find("    1 | ");
  const std::size_t caret = text.find("      | ");
  EXPECT_EQ(text.substr(quoted + (text.find("^~~~") - caret), 4), "HERE");
}

TEST(DiagnosticText, SendsNoControlCodesToTheTerminal) {
  const std::string text = to_text({{text_file("a\x1B[31mb\xFF"), 1, 1, 1, nullptr}, "m", "", {}});
  EXPECT_EQ(text.find('\x1B'), std::string::npos);
  EXPECT_NE(text.find("a?[31mb?"), std::string::npos);
}

TEST(ConfigError, SortsByFileAndPlaceAndDropsRepetitions) {
  const auto a = text_file("1\n2\n3\n", "a.xml");
  const auto b = text_file("1\n", "b.xml");
  const auto trace = std::make_shared<TraceFrame>(TraceFrame{"included from", b, 1, nullptr});
  const ConfigError error({{{b, 1, 1, 1, nullptr}, "fourth", "", {}},
                           {{a, 3, 1, 1, nullptr}, "third", "", {}},
                           {{a, 2, 5, 1, nullptr}, "second", "", {}},
                           {{a, 2, 1, 1, nullptr}, "first", "", {}},
                           {{a, 2, 1, 1, trace}, "first", "", {}}});
  ASSERT_EQ(error.diagnostics().size(), 4u);
  EXPECT_EQ(error.diagnostics()[0].message, "first");
  EXPECT_EQ(error.diagnostics()[1].message, "second");
  EXPECT_EQ(error.diagnostics()[2].message, "third");
  EXPECT_EQ(error.diagnostics()[3].message, "fourth");
  EXPECT_EQ(std::string(error.what()).find("a.xml:2:1: error: first\n    2 | 2\n"), 0u);
}

TEST(ConfigError, WithoutPlaceIsASentence) {
  EXPECT_STREQ(ConfigError("no such node").what(), "error: no such node");
}

TEST(Diagnostics, CollectEachMistakeOnceButCountAll) {
  Diagnostics diagnostics;
  EXPECT_TRUE(diagnostics.empty());
  EXPECT_NO_THROW(diagnostics.throw_if_any());
  const Place place{text_file("x"), 1, 1, 1, nullptr};
  diagnostics.error(place, "wrong", "hint");
  diagnostics.error(place, "wrong", "hint");
  EXPECT_EQ(diagnostics.all().size(), 1u);
  EXPECT_EQ(diagnostics.size(), 2u);  // whoever compares sizes sees the second one too
  EXPECT_THROW(diagnostics.throw_if_any(), ConfigError);
}

TEST(Diagnostics, AMistakeReportedElsewhereCountsButIsNotShown) {
  Diagnostics diagnostics;
  diagnostics.already_reported();
  EXPECT_EQ(diagnostics.size(), 1u);
  EXPECT_NO_THROW(diagnostics.throw_if_any());
}

TEST(Diagnostics, TakeOverThoseOfAnError) {
  Diagnostics diagnostics;
  diagnostics.add(ConfigError({{{}, "a", "", {"note"}}, {{}, "b", "", {}}}));
  ASSERT_EQ(diagnostics.all().size(), 2u);
  EXPECT_EQ(diagnostics.all()[0].notes, std::vector<std::string>{"note"});
}

TEST(Diagnostics, KeepAsManyAsAnybodyReads) {
  Diagnostics diagnostics;
  for (int i = 0; i < 5000; ++i) diagnostics.error({}, "mistake " + std::to_string(i));
  EXPECT_EQ(diagnostics.size(), 5000u);
  EXPECT_EQ(diagnostics.all().size(), Diagnostics::kMost);
}

TEST(Diagnostics, ShortenWhatQuotesTooMuch) {
  Diagnostics diagnostics;
  std::string long_text = "'";
  for (int i = 0; i < 100'000; ++i) long_text += "\xc3\xa9";  // two bytes each: not to be cut apart
  diagnostics.error({}, long_text + "' is too large", "a hint");
  const std::string& message = diagnostics.all().front().message;
  EXPECT_LT(message.size(), 1000u);
  EXPECT_TRUE(message.ends_with("' is too large")) << message;
  EXPECT_NE(message.find("bytes left out"), std::string::npos) << message;
  for (std::size_t i = 0; i < message.size();) {
    const auto character = decode_utf8(message, i);
    ASSERT_TRUE(character) << i;
    i += character->bytes;
  }
  EXPECT_EQ(diagnostics.all().front().hint, "a hint");
}

TEST(Diagnostics, SayTenTimesAtMostWhatIsRepeatedWithOtherNumbers) {
  const auto file = std::make_shared<const SourceFile>(SourceFile{"a.xml", "<a b='${x}' c=''/>"});
  Diagnostics diagnostics;
  for (int i = 0; i < 200; ++i) {
    diagnostics.error({file, 1, 7, 4, nullptr}, "'b' must be > 0, not " + std::to_string(-i));
  }
  diagnostics.error({file, 1, 7, 4, nullptr}, "'b' is of another kind");
  diagnostics.error({file, 1, 16, 1, nullptr}, "'c' must be > 0, not -1");
  ASSERT_EQ(diagnostics.all().size(), 12U);
  EXPECT_EQ(diagnostics.all()[0].message, "'b' must be > 0, not 0");
  EXPECT_EQ(diagnostics.all()[9].notes, std::vector<std::string>{"and more like it here"});
  EXPECT_EQ(diagnostics.size(), 202U);
}

}  // namespace
}  // namespace coppice
