#include "reports/cells.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/engine/graph/nodes/fake_context.h"

namespace coppice::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using Keys = std::vector<std::string>;

Entry entry(std::vector<PointValue> names, std::optional<int> replicate = {}) {
  names.emplace_back("node", "scores");
  return {std::move(names), replicate};
}

Keys keys_of(const std::vector<TableCell>& cells) {
  Keys texts;
  for (const TableCell& cell : cells) {
    std::string text;
    for (const std::string& key : cell.keys) text += key + ".";
    texts.push_back(text);
  }
  return texts;
}

TEST(Entries, TellASweepColumnFromANameOfTheNode) {
  InputNode node;
  node.id = "scores";
  node.point = {{"policy", "a"}, {"problem", "car"}, {"node", "7"}};
  node.labels = {{"policy", "a"}, {"problem", "car"}, {"node", "7"}, {"problem", "car"}, {"policy", "b"}};
  const std::vector<PointValue> expected = {{"sweep_policy", "a"}, {"problem", "car"}, {"sweep_node", "7"},
                                            {"problem", "car"},    {"policy", "b"},    {"node", "scores"}};
  EXPECT_EQ(entries_of({node}).front().names, expected);
}

TEST(Arrange, SortsByFirstAppearanceOfRowsThenOfColumns) {
  const std::vector<Entry> entries = {
      entry({{"policy", "random"}, {"size", "50"}}), entry({{"policy", "fpf"}, {"size", "300"}}),
      entry({{"policy", "fpf"}, {"size", "50"}}), entry({{"policy", "random"}, {"size", "300"}})};
  const std::vector<TableCell> cells = arrange(entries, {{"policy"}, {"size"}});
  EXPECT_EQ(keys_of(cells), (Keys{"random.50.", "random.300.", "fpf.50.", "fpf.300."}));
}

TEST(Arrange, PutsReplicatesIntoOneCell) {
  const std::vector<Entry> entries = {entry({{"policy", "fpf"}}, 0), entry({{"policy", "fpf"}}, 1),
                                      entry({{"policy", "lqr"}})};
  const std::vector<TableCell> cells = arrange(entries, {{"policy"}, {}});
  ASSERT_EQ(cells.size(), 2u);
  EXPECT_EQ(cells[0].entries, (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(cells[1].entries, (std::vector<std::size_t>{2}));
}

TEST(Arrange, WithoutKeysMakesOneCell) {
  EXPECT_EQ(arrange({entry({{"policy", "fpf"}}, 0), entry({{"policy", "fpf"}}, 1)}, {}).size(), 1u);
}

TEST(Arrange, LeavesTheKeyOfAnEntryWithoutItEmpty) {
  const std::vector<Entry> entries = {entry({{"policy", "random"}}),
                                      entry({{"size", "50"}, {"policy", "fpf"}})};
  EXPECT_EQ(keys_of(arrange(entries, {{"policy"}, {"size"}})), (Keys{"random..", "fpf.50."}));
}

TEST(Arrange, RefusesToAverageOverAnythingButReplicates) {
  const std::vector<Entry> entries = {entry({{"policy", "fpf"}, {"size", "50"}}, 0),
                                      entry({{"policy", "fpf"}, {"size", "300"}}, 0)};
  EXPECT_THAT(error_of([&] {
                arrange(entries, {{"policy"}, {}});
              }),
              AllOf(HasSubstr("size=\"50\""), HasSubstr("add 'size'")));
  const std::vector<Entry> twice = {entry({{"policy", "fpf"}}, 0), entry({{"policy", "fpf"}}, 0)};
  EXPECT_THAT(error_of([&] { arrange(twice, {{"policy"}, {}}); }), HasSubstr("more than once"));
}

TEST(Arrange, NamesTheNearestOfTheKnownKeys) {
  EXPECT_THAT(error_of([] {
                arrange({entry({{"policy", "fpf"}})}, {{"polcy"}, {}});
              }),
              AllOf(HasSubstr("'polcy'"), HasSubstr("did you mean 'policy'")));
  EXPECT_THAT(error_of([] {
                arrange({entry({{"policy", "fpf"}})}, {{"policy"}, {"policy"}});
              }),
              HasSubstr("twice"));
}

TEST(KeyColumns, AreNumbersWhereEveryKeyIsOne) {
  const std::vector<TableCell> cells = {{{"50", "0.5", "1.50", "HA"}, {}}, {{"300", "2", "2", ""}, {}}};
  Table table;
  add_key_columns(table, {{"a", "b", "c"}, {"d"}}, cells);
  EXPECT_EQ(table.columns[0].type, ColumnInfo::Type::integer);
  EXPECT_EQ(table.columns[1].type, ColumnInfo::Type::number);
  EXPECT_EQ(table.columns[2].type, ColumnInfo::Type::number);
  EXPECT_EQ(table.columns[3].type, ColumnInfo::Type::text);
  EXPECT_EQ(cell_text(table.rows[0][2]), "1.5") << "the shortest text";
  EXPECT_EQ(cell_text(table.rows[1][0]), "300");
  EXPECT_EQ(cell_text(table.rows[1][3]), "");
}

TEST(KeyColumns, AreTextsWhereNumbersWouldLoseSomething) {
  const std::vector<TableCell> cells = {{{"007", "1", "12345678901234567890", "1.0", "1e3"}, {}},
                                        {{"8", "1.0", "2", "2.0", "2"}, {}}};
  Table table;
  add_key_columns(table, {{"name", "same", "digits", "whole", "exponent"}, {}}, cells);
  EXPECT_EQ(table.columns[0].type, ColumnInfo::Type::text);
  EXPECT_EQ(table.columns[1].type, ColumnInfo::Type::text) << "two keys must not become one";
  EXPECT_EQ(table.columns[2].type, ColumnInfo::Type::text);
  EXPECT_EQ(table.columns[3].type, ColumnInfo::Type::integer);
  EXPECT_EQ(table.columns[4].type, ColumnInfo::Type::integer);
  EXPECT_EQ(cell_text(table.rows[0][4]), "1000");
}

TEST(SameKey, ComparesNumbersByTheirValue) {
  EXPECT_TRUE(same_key("HA", "HA"));
  EXPECT_TRUE(same_key("0.90", "0.9"));
  EXPECT_FALSE(same_key("0.9", "0.91"));
  EXPECT_FALSE(same_key("", "0"));
}

}  // namespace
}  // namespace coppice::testing
