#include <algorithm>

#include "tests/engine/config/config_testing.h"

namespace coppice {
namespace {

using config_testing::document;
using config_testing::expand_document;
using config_testing::Outcome;

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

const std::string kGains =
    "<macro name=\"gains\" params=\"v, id:=S\"><sweep id=\"${id}\"><grid>"
    "<param name=\"g\" values=\"${v}\"/></grid></sweep></macro>\n";

TEST(MetAgain, ASweepOfAMacroThatIsCalledTwiceIsASecondOne) {
  for (const std::string second : {"0.9", "0.5"}) {
    const Outcome outcome = expand_document(
        document(kGains + "<call macro=\"gains\" v=\"0.5\"/><call macro=\"gains\" v=\"" + second + "\"/>"));
    EXPECT_EQ(outcome.errors.size(), 1U) << outcome.text();
    EXPECT_NE(outcome.text().find("the sweep 'S' is defined a second time"), std::string::npos);
  }
  const Outcome two = expand_document(
      document(kGains + "<call macro=\"gains\" v=\"0.5\"/><call macro=\"gains\" v=\"0.9\" id=\"T\"/>"));
  EXPECT_EQ(two.text(), "");
  EXPECT_EQ(two.config.sweeps.size(), 2U);
}

TEST(MetAgain, ASweepOnTheSameLineIsASecondOne) {
  const std::string one = "<sweep id=\"S\"><grid><param name=\"g\" values=\"1\"/></grid></sweep>";
  EXPECT_EQ(count(expand_document(document(one + one)).text(), "defined a second time"), 1U);
}

TEST(MetAgain, ABlockPutInTwiceGivesASecondSweep) {
  const Outcome outcome = expand_document(
      document("<macro name=\"twice\" params=\"*b\"><insert block=\"b\"/><insert block=\"b\"/></macro>"
               "<call macro=\"twice\"><sweep id=\"S\"><grid><param name=\"g\" values=\"1\"/></grid></sweep>"
               "</call>"));
  EXPECT_EQ(count(outcome.text(), "defined a second time"), 1U) << outcome.text();
}

const std::string kShared = document(kGains +
                                     "<let name=\"n\" value=\"3\"/><call macro=\"gains\" v=\"0.5, 0.9\"/>"
                                     "<problem id=\"p\" size=\"${n}\"><part/></problem>"
                                     "<policy id=\"q\" over=\"S\" gain=\"${g}\"/>");

TEST(MetAgain, AFileThatIsIncludedTwiceGivesItsNodesAndSweepsOnce) {
  const config_testing::Folder folder(
      {{"shared.xml", kShared},
       {"a.xml", document("<include file=\"shared.xml\"/><policy id=\"a\"/>")},
       {"b.xml", document("<include file=\"shared.xml\"/><policy id=\"b\"/>")},
       {"main.xml", document("<include file=\"a.xml\"/><include file=\"b.xml\"/>")}});
  const Outcome outcome = folder.expand_file("main.xml");
  EXPECT_EQ(outcome.text(), "");
  std::vector<std::string> ids;
  for (const NodeElement& node : outcome.config.nodes) ids.emplace_back(node.element.get("id"));
  EXPECT_EQ(ids, (std::vector<std::string>{"p", "q", "q", "a", "b"}));
  ASSERT_EQ(outcome.config.sweeps.size(), 1U);
  EXPECT_EQ(outcome.config.sweeps.front().points.size(), 2U);
}

TEST(MetAgain, NodesThatOnlyLookAlikeAreTwo) {
  const Outcome outcome =
      expand_document(document("<macro name=\"m\" params=\"\"><policy id=\"p\"/></macro>"
                               "<call macro=\"m\"/><call macro=\"m\"/>"));
  EXPECT_EQ(outcome.config.nodes.size(), 2U);  // of which planning says that the id is already used
}

}  // namespace
}  // namespace coppice
