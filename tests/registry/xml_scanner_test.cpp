#include "registry/xml_scanner.h"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "tests/registry/helpers.h"

namespace coppice {
namespace {

using test::mistakes_of;
using test::text_of;

struct Malformed {
  const char* text;
  const char* where;    ///< "line:column"
  const char* message;  ///< part of the report
};

class MalformedXml : public testing::TestWithParam<Malformed> {};

TEST_P(MalformedXml, IsLocatedAndExplained) {
  const std::vector<Diagnostic> mistakes = mistakes_of(GetParam().text);
  ASSERT_EQ(mistakes.size(), 1u) << text_of(mistakes);
  EXPECT_EQ(std::to_string(mistakes[0].place.line) + ":" + std::to_string(mistakes[0].place.column),
            GetParam().where);
  EXPECT_NE(text_of(mistakes).find(GetParam().message), std::string::npos) << text_of(mistakes);
}

INSTANTIATE_TEST_SUITE_P(Tags, MalformedXml,
                         testing::Values(Malformed{"<a>\n  <b>\n  </a>", "3:3", "</a> does not close <b>"},
                                         Malformed{"<a>\n  <b>\n  </a>", "3:3",
                                                   "<b> opens at line 2, column 4"},
                                         Malformed{"<a>\n  <b/>", "1:2", "<a> is never closed"},
                                         Malformed{"<a></a></a>", "1:8", "</a> closes nothing"},
                                         Malformed{"</a>", "1:1", "closes nothing"},
                                         Malformed{"<a/>\n<b/>", "2:2", "<b> is a second root element"},
                                         Malformed{"<a", "1:2", "the tag <a> is never closed"},
                                         Malformed{"<a x=\"1\"\n<b/>", "1:2", "the tag <a> is never closed"},
                                         Malformed{"<a></a b>", "1:4", "</a> has no closing '>'"},
                                         Malformed{"<>", "1:1", "begins no element"},
                                         Malformed{"<a>< b/></a>", "1:4", "begins no element"},
                                         Malformed{"<a><1/></a>", "1:4", "begins no element"},
                                         Malformed{"<a / >", "1:4", "unexpected '/' in the tag <a>"}));

INSTANTIATE_TEST_SUITE_P(
    Attributes, MalformedXml,
    testing::Values(
        Malformed{"<a x=\"1\" x=\"2\"/>", "1:10", "<a> has the attribute 'x' twice"},
        Malformed{"<a x/>", "1:4", "'x' has no value"}, Malformed{"<a x=1/>", "1:4", "is not in quotes"},
        Malformed{"<a x=\"1/>", "1:6", "the value of 'x' has no closing quote"},
        Malformed{"<a x=\"1>\n  <b y=\"2\"/>\n</a>", "1:6", "the value of 'x' has no closing quote"},
        Malformed{"<a x=\"1\"y=\"2\"/>", "1:9", "separated by spaces"},
        Malformed{"<a x=\"1<2\"/>", "1:8", "'<' inside the value of 'x'"},
        Malformed{"<a =\"1\"/>", "1:4", "unexpected '='"}, Malformed{"<a \xC2\xB0/>", "1:4", "has no value"},
        Malformed{"<a x=\"a & b\"/>", "1:9", "'&' by itself"}, Malformed{"<a x=\"&\"/>", "1:7", "by itself"},
        Malformed{"<a x=\"&;\"/>", "1:7", "by itself"},
        Malformed{"<a x=\"&nbsp;\"/>", "1:7", "unknown entity '&nbsp;'"},
        Malformed{"<a x=\"&#0;\"/>", "1:7", "is not a character"},
        Malformed{"<a x=\"&#xD800;\"/>", "1:7", "is not a character"},
        Malformed{"<a x=\"&#x110000;\"/>", "1:7", "is not a character"},
        Malformed{"<a x=\"&#99999999999;\"/>", "1:7", "is not a character"},
        Malformed{"<a x=\"&#12a;\"/>", "1:7", "is not a character"}));

INSTANTIATE_TEST_SUITE_P(
    Content, MalformedXml,
    testing::Values(Malformed{"<a>\n hello\n</a>", "2:2", "text between elements"},
                    Malformed{"<a/>\nrest", "2:1", "text after the end of the root"},
                    Malformed{"period=1", "1:1", "this is not an XML file"},
                    Malformed{"<a><![CDATA[x]]></a>", "1:4", "text between elements"},
                    Malformed{"<a><![CDATA[x</a>", "1:4", "the CDATA is never closed"},
                    Malformed{"<!DOCTYPE a><a/>", "1:1", "document types"},
                    Malformed{"<!DOCTYPE a [<!ENTITY x \"y\">]><a x=\"&x;\"/>", "1:1", "document types"},
                    Malformed{"<a><!-- x </a>", "1:4", "the comment is never closed"},
                    Malformed{"<a>\n<!-- a -- b --></a>", "2:8", "'--' may not stand inside a comment"},
                    Malformed{"<a><?x </a>", "1:4", "the instruction is never closed"},
                    Malformed{"<a><? x?></a>", "1:4", "needs a name"},
                    Malformed{" <?xml version=\"1.0\"?><a/>", "1:2", "at the very beginning"},
                    Malformed{"<?xml version=\"1.0\" encoding=\"latin1\"?><a/>", "1:21",
                              "the encoding 'LATIN1'"},
                    Malformed{"<!-- only -->", "1:14", "no element"}, Malformed{"", "1:1", "no element"},
                    Malformed{"<a>\x01</a>", "1:4", "U+0001"},
                    Malformed{"<a>\n \xFF</a>", "2:2", "not UTF-8"},
                    Malformed{"<a x=\"\xC3\"/>", "1:7", "not UTF-8"}));

TEST(XmlScanner, ReportsSeveralMistakesAtOnce) {
  EXPECT_EQ(mistakes_of("<a x=\"&b;\" x=\"1\">text<b c=\"1<2\"/>more</a>").size(), 5u);
}

TEST(XmlScanner, AcceptsTheSpellingsThatXmlAllows) {
  for (const char* text :
       {"<a/>", "<a />", "<a></a >", "<a\n\tx\n=\n'1'\r\n/>", "<a x=\"'\" y='\"'/>", "<_a.b-c:d x1=\"\"/>",
        "<\xC3\xA9/>", "<a x=\">\"/>", "<a x=\"]]>\"/>", "<?xml version='1.0' encoding='utf-8'?><a/>",
        "<a><!----></a>", "<a><!-- - --></a>"}) {
    EXPECT_EQ(text_of(mistakes_of(text)), "") << text;
  }
}

std::string nested(std::size_t depth) {
  std::string open, close;
  for (std::size_t i = 0; i < depth; ++i) {
    open += "<a>";
    close += "</a>";
  }
  return open + close;
}

TEST(XmlScanner, LimitsTheDepth) {
  EXPECT_TRUE(mistakes_of(nested(kMaxXmlDepth)).empty());
  const std::vector<Diagnostic> mistakes = mistakes_of(nested(kMaxXmlDepth + 1));
  ASSERT_EQ(mistakes.size(), 1u);
  EXPECT_EQ(mistakes[0].message, "elements are nested more than 90 deep");
}

TEST(XmlScanner, IsLinearInLongLines) {
  std::string text = "<a>";
  for (int i = 0; i < 100000; ++i) text += "<b c=\"1\"/>";
  EXPECT_EQ(scan_xml(test::text_file(text + "</a>")).tags.size(), 100001u);
}

/// A config damaged in a few places never does worse than a ConfigError, and what passes reads back the same.
TEST(XmlScanner, SurvivesEveryMutation) {
  const std::string good =
      "<?xml version=\"1.0\"?>\n<experiment coppice=\"1\" seed='2017'>\n  <!-- scale -->\n  <arg name=\"n\" "
      "default=\"${pick(scale, ci=5)}\"/>\n  <train id=\"t\" x=\"&lt;&#65;\"><fqi a=\"\xC3\xA9\"/></train>\n"
      "</experiment>\n";
  const std::vector<std::string> pieces = {
      "<",    ">",   "/",    "\"",        "'",           "&",    "=",  "<!--", "-->",
      "<?",   "?>",  "]]>",  "<![CDATA[", "\xC3",        "\xFF", "\n", "\r",   std::string(1, '\0'),
      "</a>", "<a>", "&#0;", "x=\"1\"",   "<!DOCTYPE a>"};
  std::mt19937 random(1);
  int accepted = 0;
  for (int round = 0; round < 5000; ++round) {
    std::string text = good;
    for (std::size_t edits = 1 + random() % 3; edits > 0; --edits) {
      const std::size_t at = random() % (text.size() + 1);
      switch (random() % 4) {
        case 0:
          text.insert(at, pieces[random() % pieces.size()]);
          break;
        case 1:
          text.erase(at, random() % 8);
          break;
        case 2:
          text = text.substr(0, at) + text.substr(std::min(text.size(), at + random() % 40));
          break;
        default:
          if (at < text.size()) text[at] = static_cast<char>(random() % 256);
      }
    }
    try {
      const Element element = test::parse(text);
      ++accepted;
      const std::string printed = to_xml(element);
      EXPECT_EQ(to_xml(test::parse(printed)), printed) << text;
    } catch (const ConfigError& error) {
      for (const Diagnostic& mistake : error.diagnostics()) EXPECT_GT(mistake.place.line, 0) << text;
    }
  }
  EXPECT_GT(accepted, 100);   // some edits are harmless,
  EXPECT_LT(accepted, 2500);  // most are not
}

}  // namespace
}  // namespace coppice
