#include "registry/manual.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "registry/units.h"
#include "tests/registry/drawing.h"

namespace coppice {
namespace {

std::vector<ManualPage> pages() {
  return manual_pages(Catalogue::instance(), test::drawing_language());
}

std::string page(const std::string& file) {
  for (const ManualPage& candidate : pages()) {
    if (candidate.file == file) return candidate.text;
  }
  return "";
}

TEST(Manual, HasAnIndexAndAPageForEachInterface) {
  std::set<std::string> files;
  for (const ManualPage& candidate : pages()) files.insert(candidate.file);
  EXPECT_EQ(files.size(), pages().size());
  EXPECT_TRUE(files.contains("README.md"));
  EXPECT_TRUE(files.contains("language.md"));
  EXPECT_TRUE(files.contains("units.md"));
  for (const std::string& interface : Catalogue::instance().interfaces()) {
    EXPECT_TRUE(files.contains(interface + ".md")) << interface;
  }
}

TEST(Manual, TellsEveryParameterWithBoundsDefaultAndDoc) {
  const std::string text = page("test_shape.md");
  EXPECT_NE(text.find("What can be drawn."), std::string::npos);
  EXPECT_NE(text.find("| `width` | number > 0 m | `2 m` | From left to right. |"), std::string::npos) << text;
  EXPECT_NE(text.find("| `radius` | number > 0 m | required | From the centre. |"), std::string::npos)
      << text;
  EXPECT_NE(text.find("| `<pen>` | [test_pen](test_pen.md) | `pencil` | What draws it. |"), std::string::npos)
      << text;
  EXPECT_NE(text.find("Stands in: [`heap`](test_shape.md#heap), [`sheet`](test_drawing.md#sheet)."),
            std::string::npos)
      << text;
}

TEST(Manual, TellsTheLanguage) {
  const std::string text = page("language.md");
  EXPECT_NE(text.find("## sweep\n\nExplains sweep.\n"), std::string::npos) << text;
  EXPECT_NE(text.find("## list in sweep\n\nExplains list.\n"), std::string::npos) << text;
  EXPECT_NE(text.find("| `columns` | required | Side by side. |"), std::string::npos) << text;
  EXPECT_NE(text.find("Inside: [`list`](#list-in-sweep), [`zip`](#zip-in-sweep)."), std::string::npos)
      << text;
}

TEST(Manual, ListsEveryUnit) {
  const std::string text = page("units.md");
  for (const NamedUnit& unit : named_units()) {
    EXPECT_NE(text.find("`" + std::string(unit.name) + "`"), std::string::npos) << unit.name;
  }
}

TEST(Manual, LinksLeadSomewhere) {
  const std::vector<ManualPage> all = pages();
  for (const ManualPage& from : all) {
    for (std::size_t at = from.text.find("]("); at != std::string::npos; at = from.text.find("](", at + 1)) {
      const std::string link = from.text.substr(at + 2, from.text.find(')', at) - at - 2);
      const std::size_t hash = link.find('#');
      const std::string file = hash == 0 ? from.file : link.substr(0, hash);
      const auto to =
          std::find_if(all.begin(), all.end(), [&](const ManualPage& p) { return p.file == file; });
      ASSERT_NE(to, all.end()) << link;
      if (hash == std::string::npos) continue;
      std::string title = link.substr(hash + 1);
      std::replace(title.begin(), title.end(), '-', ' ');
      EXPECT_NE(to->text.find("\n## " + title + "\n"), std::string::npos) << link;
    }
  }
}

}  // namespace
}  // namespace coppice
