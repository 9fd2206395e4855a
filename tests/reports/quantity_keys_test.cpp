#include <gtest/gtest.h>

#include "reports/cells.h"

namespace coppice {
namespace {

TEST(QuantityKeys, AreEqualHoweverTheyAreWritten) {
  EXPECT_TRUE(same_key("10 deg", "0.17453292519943295"));
  EXPECT_TRUE(same_key("1 h", "60 min"));
  EXPECT_TRUE(same_key("2.0", "2"));
  EXPECT_FALSE(same_key("1 m", "1 s"));
  EXPECT_FALSE(same_key("10 deg", "10"));
  EXPECT_FALSE(same_key("ten", "10"));
}

TEST(QuantityKeys, AreOfTheDimensionOfTheirUnit) {
  EXPECT_TRUE(same_key("1000 g", "1", "kg"));
  EXPECT_TRUE(same_key("1.0", "1", "kg"));
  EXPECT_FALSE(same_key("1 m", "1", "kg"));
}

TEST(QuantityKeys, HaveTheirUnitInTheTable) {
  const std::vector<Entry> entries = {{{{"ang", "0.5"}, {"node", "e"}}, {}, {{"ang", "rad"}}},
                                      {{{"ang", "1"}, {"node", "e"}}, {}, {{"ang", "rad"}}}};
  const TableKeys keys{{"ang", "node"}, {}};
  Table table;
  add_key_columns(table, keys, arrange(entries, keys));
  EXPECT_EQ(table.columns[0].unit, "rad");
  EXPECT_EQ(table.columns[0].type, ColumnInfo::Type::number);
  EXPECT_EQ(table.columns[1].unit, "");
}

}  // namespace
}  // namespace coppice
