#include "registry/source.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/registry/helpers.h"
#include "tests/support/temporary_folder.h"

namespace coppice {
namespace {

using test::mistakes_of;
using test::parse;

std::string mistake_of_file(const std::filesystem::path& path, std::size_t largest = std::size_t{64} << 20u) {
  try {
    read_source(path.string(), largest);
    return "";
  } catch (const ConfigError& error) {
    return error.what();
  }
}

TEST(ReadSource, KeepsTheTextAndThePath) {
  const TemporaryFolder folder;
  const std::string path = folder.write("a.xml", "<a>\n</a>\n").string();
  const auto source = read_source(path);
  EXPECT_EQ(source->path, path);
  EXPECT_EQ(source->text, "<a>\n</a>\n");
}

TEST(ReadSource, NormalizesLineEndsAndDropsTheByteOrderMark) {
  const TemporaryFolder folder;
  const std::string path = folder.write("a.xml", "\xEF\xBB\xBF<a>\r\n\r</a>\r\n").string();
  EXPECT_EQ(read_source(path)->text, "<a>\n\n</a>\n");
}

TEST(ReadSource, RefusesWhatIsNoTextFile) {
  const TemporaryFolder folder;
  folder.write("scale.xml", "<a/>");
  EXPECT_NE(mistake_of_file((folder.path() / "scales.xml").string()).find("No such file"), std::string::npos);
  EXPECT_NE(mistake_of_file((folder.path() / "scales.xml").string()).find("scale.xml'?"), std::string::npos);
  EXPECT_NE(mistake_of_file(folder.path().string()).find("is a folder"), std::string::npos);
  EXPECT_NE(mistake_of_file(folder.write("e.xml", "")).find("is empty"), std::string::npos);
  EXPECT_NE(mistake_of_file(folder.write("b.xml", " \n\t\n")).find("is empty"), std::string::npos);
  EXPECT_NE(mistake_of_file(folder.write("n.xml", std::string("<a\0/>", 5))).find("binary"),
            std::string::npos);
  EXPECT_NE(mistake_of_file(folder.write("u.xml", std::string("\xFF\xFE<\0", 4))).find("UTF-16"),
            std::string::npos);
  EXPECT_NE(mistake_of_file("").find("cannot read"), std::string::npos);
  EXPECT_NE(mistake_of_file("/dev/null").find("is empty"), std::string::npos);
}

TEST(ReadSource, RefusesHugeFilesWithoutReadingThemWhole) {
  EXPECT_NE(mistake_of_file("/dev/zero", std::size_t{1} << 20u).find("larger than 1 MiB"), std::string::npos);
}

TEST(ReadSource, TellsTheSystemsReason) {
  const TemporaryFolder folder;
  const std::string path = folder.write("a.xml", "<a/>").string();
  std::filesystem::permissions(path, std::filesystem::perms::none);
  if (std::ifstream(path).good()) return;  // the superuser reads everything
  EXPECT_NE(mistake_of_file(path).find("Permission denied"), std::string::npos);
}

TEST(ParseXml, GivesTheTreeWithPlaces) {
  const Element root =
      parse("<?xml version=\"1.0\"?>\n<!-- <b> -->\n<a x='1'\n   y = \"two\">\n  <b/><c z=\"\"></c>\n</a>\n");
  EXPECT_EQ(root.name, "a");
  EXPECT_EQ(root.place.line, 3);
  EXPECT_EQ(root.place.column, 2);
  ASSERT_EQ(root.attributes.size(), 2u);
  EXPECT_EQ(root.attributes[0].name_place.column, 4);
  EXPECT_EQ(root.attributes[0].value_place.column, 7);
  EXPECT_EQ(root.attributes[1].value, "two");
  EXPECT_EQ(root.attributes[1].name_place.line, 4);
  EXPECT_EQ(root.attributes[1].name_place.column, 4);
  EXPECT_EQ(root.attributes[1].value_place.column, 9);
  EXPECT_EQ(root.attributes[1].value_place.length, 3);
  ASSERT_EQ(root.children.size(), 2u);
  EXPECT_EQ(root.children[1].place.line, 5);
  EXPECT_EQ(root.children[1].place.column, 8);
}

TEST(ParseXml, CountsCharactersInColumns) {
  const Element root = parse("\xEF\xBB\xBF<a h\xC3\xA9=\"\xE4\xB8\xAD\" b=\"1\"/>");
  EXPECT_EQ(root.place.column, 2);
  EXPECT_EQ(root.attributes[1].name_place.column, 11);
  EXPECT_EQ(root.attributes[0].value_place.length, 1);
}

TEST(ParseXml, DecodesEntitiesAndNormalizesWhiteSpace) {
  const Element root =
      parse("<a x=\"&lt;&gt;&amp;&quot;&apos;&#65;&#x42;\" y='a\n\tb' z=\"a&#10;b&#9;&#13;\"/>");
  EXPECT_EQ(root.get("x"), "<>&\"'AB");
  EXPECT_EQ(root.get("y"), "a  b");      // as XML 1.0, 3.3.3 demands
  EXPECT_EQ(root.get("z"), "a\nb\t\r");  // written by reference they stay
}

TEST(ParseXml, IgnoresCommentsAndInstructionsEverywhere) {
  const Element root = parse("<!--a--><?model \"x\"?>\n<a><!--<b>&x;--><?p <c/>?><d/></a><!--end--><?q?>\n");
  ASSERT_EQ(root.children.size(), 1u);
  EXPECT_EQ(root.children[0].name, "d");
}

TEST(ParseXml, DropsTheSchemaLocationOfTheRoot) {
  const Element root = parse(
      "<a xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" xsi:noNamespaceSchemaLocation=\"c.xsd\" "
      "b=\"1\"/>");
  ASSERT_EQ(root.attributes.size(), 1u);
  EXPECT_EQ(root.attributes[0].name, "b");
}

TEST(ToXml, WritesWhatParsesBackToTheSameTree) {
  Element root;
  root.name = "a";
  root.set("x", "<\"'&>\n\t\r \xC3\xA9");
  root.set("empty", "");
  root.children.push_back({"b", {}, {}, {}});
  root.children.back().children.push_back({"c", {}, {{"y", "1", {}, {}}}, {}});
  const std::string text = to_xml(root);
  EXPECT_EQ(text,
            "<a x=\"&lt;&quot;'&amp;&gt;&#10;&#9;&#13; \xC3\xA9\" empty=\"\">\n  <b>\n    <c y=\"1\"/>\n  "
            "</b>\n</a>\n");
  const Element again = parse(text);
  EXPECT_EQ(again.get("x"), root.get("x"));
  EXPECT_EQ(to_xml(again), text);
  EXPECT_EQ(to_xml(again.children[0], 2), "  <b>\n    <c y=\"1\"/>\n  </b>\n");
}

TEST(Element, FindsAndSetsAttributes) {
  Element element = parse("<a x=\"1\"><b/><b y=\"2\"/></a>");
  EXPECT_EQ(element.get("x"), "1");
  EXPECT_EQ(element.get("z", "none"), "none");
  EXPECT_EQ(element.find("z"), nullptr);
  element.set("x", "3");
  element.set("z", "4");
  EXPECT_EQ(to_xml(element), "<a x=\"3\" z=\"4\">\n  <b/>\n  <b y=\"2\"/>\n</a>\n");
  EXPECT_EQ(element.child("b"), &element.children[0]);
  EXPECT_EQ(element.child("c"), nullptr);
}

}  // namespace
}  // namespace coppice
