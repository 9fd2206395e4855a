#include "reports/html.h"

#include <gtest/gtest.h>

namespace coppice::html {
namespace {

TEST(Html, EscapesWhatWouldBeMarkup) {
  EXPECT_EQ(escaped("<a href=\"x\">'&'</a>"), "&lt;a href=&quot;x&quot;&gt;&#39;&amp;&#39;&lt;/a&gt;");
  EXPECT_EQ(escaped("gr\xC3\xB6\xC3\x9F"
                    "er\n"),
            "gr\xC3\xB6\xC3\x9F"
            "er\n");
}

TEST(Html, ReplacesWhatXmlForbids) {
  EXPECT_EQ(escaped(std::string_view("a\0b\x1B\xFF", 5)),
            "a\xEF\xBF\xBD"
            "b\xEF\xBF\xBD\xEF\xBF\xBD");
}

TEST(Html, EscapesPaths) {
  EXPECT_EQ(link("tables/a b.variant=H%2FA.csv"), "tables/a%20b.variant%3DH%252FA.csv");
}

TEST(Html, WritesElements) {
  EXPECT_EQ(text_element("td", "1 < 2", {{"class", "number"}, {"title", ""}}),
            "<td class=\"number\">1 &lt; 2</td>");
  EXPECT_EQ(element("tr", "<td></td>"), "<tr><td></td></tr>");
}

}  // namespace
}  // namespace coppice::html
