#include "registry/schema.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <stdexcept>

#include "tests/registry/drawing.h"
#include "tests/registry/helpers.h"
#include "tests/support/temporary_folder.h"

namespace coppice {
namespace {

/// The catalogue of the drawings alone, with a parameter of every type besides.
Catalogue drawings() {
  Catalogue catalogue;
  for (const char* interface : {"test_pen", "test_shape", "test_drawing"}) {
    for (const ComponentInfo* info : Catalogue::instance().all(interface)) catalogue.add(*info);
  }
  ComponentInfo every{"test_shape", "every", "Every type.", "no publication", 1, {}, {}, nullptr};
  const auto add = [&](const char* name, ValueType type, const char* unit, Bounds bounds,
                       const char* default_text) {
    ParameterInfo info;
    info.name = name;
    info.type = type;
    info.unit = unit;
    info.bounds = bounds;
    info.doc = "Doc of <" + info.name + ">.";
    info.default_text = default_text;
    every.parameters.push_back(info);
  };
  add("angle", ValueType::number, "rad", between(-4, 4), "0");
  add("share", ValueType::number, "", {.low = 0, .high = 1, .low_open = true}, "1");
  add("limit", ValueType::number, "m", at_least(0), "inf");
  add("count", ValueType::integer, "", at_least(2), "4");
  add("size", ValueType::integer, "", at_least(2), "auto");
  every.parameters.back().automatic = true;
  add("flag", ValueType::boolean, "", {}, "true");
  add("note", ValueType::text, "", {}, "");
  add("mode", ValueType::choice, "", {}, "slow");
  every.parameters.back().choices = {"slow", "fast"};
  add("steps", ValueType::numbers, "m", {}, "");
  add("words", ValueType::texts, "", {}, "");
  add("data", ValueType::file, "", {}, "");
  add("from", ValueType::reference, "", {}, "");
  add("others", ValueType::references, "", {}, "");
  catalogue.add(every);
  catalogue.add({"test_pen", "box", "Also the name of a shape.", "no publication", 1, {}, {}, nullptr});
  return catalogue;
}

class Schema : public testing::Test {
 protected:
  Schema() { folder_.write("album.xsd", xml_schema(drawings(), test::drawing_language())); }

  /// Whether xmllint accepts a file; 0 is its status for a valid one, 3 for an invalid one.
  int status(const std::string& text) const {
    folder_.write("a.xml", text);
    const std::string path = folder_.path().string();
    const int result = std::system(
        ("xmllint --noout --schema '" + path + "/album.xsd' '" + path + "/a.xml' 2> '" + path + "/messages'")
            .c_str());
    return WEXITSTATUS(result);
  }
  void accepts(const std::string& text) const { EXPECT_EQ(status(text), 0) << text; }
  void refuses(const std::string& text) const { EXPECT_EQ(status(text), 3) << text; }
  static std::string shape(const std::string& attributes) {
    return "<album version=\"1\"><sheet id=\"a\"><every " + attributes + "/></sheet></album>";
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(Schema, AcceptsWhatTheLanguageAllows) {
  accepts("<album version=\"1\"/>");
  accepts(R"xml(<?xml version="1.0"?>
<album xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xsi:noNamespaceSchemaLocation="album.xsd"
       version="1" title="x">
  <macro name="m"><anything at="all"><sheet/></anything></macro>
  <sweep id="s"><list values="1, 2"/><zip><list columns="3" if="1"/></zip></sweep>
  <sheet id="a" framed="${x}" if="${y}"><box width="3 cm"/><pen if="0"><brush/></pen></sheet>
  <group if="1">
    <sheet id="b">
      <heap><parts><box/><group><circle radius="$(arg r)"/><call macro="m" any="1"/></group></parts></heap>
    </sheet>
    <group><call macro="m"><sheet/></call></group>
  </group>
</album>)xml");
}

TEST_F(Schema, RefusesWhatReadingRefuses) {
  refuses("<album/>");
  refuses("<book version=\"1\"/>");
  refuses("<album version=\"1\" colour=\"red\"/>");
  refuses("<album version=\"1\"><sheets id=\"a\"/></album>");
  refuses("<album version=\"1\"><sheet/></album>");
  refuses("<album version=\"1\"><box/></album>");
  refuses("<album version=\"1\" if=\"1\"/>");
  refuses("<album version=\"1\"><sweep id=\"s\"><list columns=\"1\"/></sweep></album>");
  refuses("<album version=\"1\"><sweep id=\"s\"><zip><list values=\"1\"/></zip></sweep></album>");
  refuses("<album version=\"1\"><list values=\"1\"/></album>");
  refuses("<album version=\"1\"><sweep id=\"s\"><sheet id=\"a\"/></sweep></album>");
  refuses("<album version=\"1\"><group name=\"x\"/></album>");
  refuses("<album version=\"1\"><group><box/></group></album>");
  refuses("<album version=\"1\"><sheet id=\"a\"><brush/></sheet></album>");
  refuses("<album version=\"1\"><sheet id=\"a\"><group><brush/></group></sheet></album>");
  refuses("<album version=\"1\"><sheet id=\"a\">text</sheet></album>");
  refuses("<album version=\"1\"><sheet id=\"a\"><pen softness=\"1\"/></sheet></album>");
  refuses("<album version=\"1\"><sheet id=\"a\"><pen><pencil softness=\"1\"/></pen></sheet></album>");
}

TEST_F(Schema, TypesAreThoseOfTheContext) {
  accepts("<album version=\"1\"><sheet id=\"a\"><box width=\"1\"/></sheet></album>");             // the shape
  refuses("<album version=\"1\"><sheet id=\"a\"><pen><box width=\"1\"/></pen></sheet></album>");  // the pen
}

TEST_F(Schema, AcceptsEveryLiteralThatReadingAccepts) {
  for (const char* value : {"0", "-3", "+.5", "1e-3", " 20 deg ", "20deg", "0.1 turn", "3 rad", "2 mrad*m/m",
                            "${2 * a}", "$(arg a)"}) {
    accepts(shape("angle=\"" + std::string(value) + "\""));
  }
  for (const char* value : {"1", "0.5", "50 %", "1e-9"})
    accepts(shape("share=\"" + std::string(value) + "\""));
  for (const char* value : {"inf", "3 km", "0"}) accepts(shape("limit=\"" + std::string(value) + "\""));
  for (const char* value : {"2", "1e5", "10000", "1.5e3", "3.0"})
    accepts(shape("count=\"" + std::string(value) + "\""));
  accepts(shape(
      R"(size="auto" flag="0" note="any &lt; thing" mode=" fast " steps="1, 2 cm,3e-2 m" words="a b, c")"));
  accepts(shape(R"(steps="" data="x/y.csv" from="" others="a, b")"));
}

TEST_F(Schema, RefusesLiteralsThatReadingRefuses) {
  for (const char* attribute :
       {"angle=\"5\"",     "angle=\"3 m\"",  "angle=\"x\"",   "angle=\"\"",         "angle=\"nan\"",
        "angle=\"NaN\"",   "angle=\"INF\"",  "angle=\"inf\"", "angle=\"1,5\"",      "angle=\"auto\"",
        "angle=\"0x1\"",   "share=\"0\"",    "share=\"1.5\"", "share=\"1 m\"",      "limit=\"-1\"",
        "count=\"1\"",     "count=\"2.5\"",  "size=\"1\"",    "size=\"automatic\"", "flag=\"yes\"",
        "mode=\"slower\"", "steps=\"1,,2\"", "steps=\"1 s\"", "from=\"a, b\""}) {
    refuses(shape(attribute));
  }
}

TEST_F(Schema, DocumentsWhatEditorsShow) {
  const std::string text = xml_schema(drawings(), test::drawing_language());
  EXPECT_NE(text.find("Doc of &lt;count&gt;.&#10;[integer &gt;= 2, default 4]"), std::string::npos);
  EXPECT_NE(text.find("A sheet.&#10;Source: Doe, 2001"), std::string::npos);
  EXPECT_NE(text.find("What draws it. (a test_pen, default pencil)"), std::string::npos);
}

TEST_F(Schema, RefusesClashingNames) {
  Language language = test::drawing_language();
  language.common.push_back({"framed", "Clashes with the sheet's.", false});
  EXPECT_THROW(xml_schema(drawings(), language), std::logic_error);
  language = test::drawing_language();
  language.elements.front().name = "sheet";
  EXPECT_THROW(xml_schema(drawings(), language), std::logic_error);
}

}  // namespace
}  // namespace coppice
