#include "engine/data/table_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "registry/error.h"
#include "tests/support/temporary_folder.h"

namespace coppice {
namespace {

using Type = ColumnInfo::Type;

Table sample_table() {
  Table table;
  table.columns = {{"policy", Type::text, "", "Who acts."},
                   {"time_s", Type::number, "s", "How long."},
                   {"steps", Type::integer, "", "How many."},
                   {"good", Type::boolean, "", "Whether."}};
  table.rows = {{std::string("a, \"b\""), 0.1, std::int64_t{3}, std::int64_t{1}},
                {Cell(), Cell(), Cell(), std::int64_t{0}}};
  return table;
}

template <class Call>
std::string table_error(const Call& call) {
  try {
    call();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(TableFile, IsRfc4180WithLineFeeds) {
  const TemporaryFolder folder;
  write_table(folder / "t.csv", sample_table());
  EXPECT_EQ(TemporaryFolder::read(folder / "t.csv"),
            "policy,time_s,steps,good\n\"a, \"\"b\"\"\",0.1,3,1\n,,,0\n");
}

TEST(TableFile, SchemaStandsBeside) {
  const TemporaryFolder folder;
  write_table(folder / "t.csv", sample_table());
  const std::string schema = TemporaryFolder::read(folder / "t.schema.json");
  EXPECT_NE(schema.find("\"name\": \"time_s\""), std::string::npos);
  EXPECT_NE(schema.find("\"type\": \"boolean\""), std::string::npos);
  EXPECT_NE(schema.find("\"unit\": \"s\""), std::string::npos);
  EXPECT_NE(schema.find("\"doc\": \"How many.\""), std::string::npos);
}

TEST(TableFile, TheSchemaTellsWhatIsNotReproducible) {
  const TemporaryFolder folder;
  Table table = sample_table();
  write_table(folder / "t.csv", table);
  EXPECT_TRUE(is_reproducible(folder / "t.csv"));
  EXPECT_EQ(TemporaryFolder::read(folder / "t.schema.json").find("reproducible"), std::string::npos);
  table.reproducible = false;
  write_table(folder / "t.csv", table);
  EXPECT_FALSE(is_reproducible(folder / "t.csv"));
  EXPECT_FALSE(read_table(folder / "t.csv").reproducible);
  EXPECT_TRUE(is_reproducible(folder / "no_schema.csv"));
  folder.write("broken.schema.json", "{");
  EXPECT_TRUE(is_reproducible(folder / "broken.csv"));
}

TEST(TableFile, ReadsBackWhatWasWritten) {
  const TemporaryFolder folder;
  write_table(folder / "t.csv", sample_table());
  const Table back = read_table(folder / "t.csv");
  EXPECT_EQ(back.rows, sample_table().rows);
  EXPECT_EQ(back.columns[1].unit, "s");
  EXPECT_EQ(back.columns[3].type, Type::boolean);
}

TEST(TableFile, AMissingCellOfASingleColumnIsARow) {
  const TemporaryFolder folder;
  Table table;
  table.columns = {{"x", Type::number, "", ""}};
  table.rows = {{1.5}, {Cell()}, {std::numeric_limits<double>::infinity()}};
  write_table(folder / "t.csv", table);
  const Table back = read_table(folder / "t.csv");
  EXPECT_EQ(back.rows, (std::vector<std::vector<Cell>>{{1.5}, {Cell()}, {Cell()}}));
}

TEST(TableFile, WithoutSchemaTypesComeFromTheCells) {
  const TemporaryFolder folder;
  const Table table = read_table(folder.write("t.csv", "i,n,t,e\r\n1,1,1,\r\n-2,2.5,x,\r\n"));
  EXPECT_EQ(table.columns[0].type, Type::integer);
  EXPECT_EQ(table.columns[1].type, Type::number);
  EXPECT_EQ(table.columns[2].type, Type::text);
  EXPECT_EQ(table.columns[3].type, Type::number);
  EXPECT_EQ(table.rows[1], (std::vector<Cell>{std::int64_t{-2}, 2.5, std::string("x"), Cell()}));
}

TEST(TableFile, ReadsWhatOtherProgramsWrite) {
  const TemporaryFolder folder;
  const Table table = read_table(folder.write("t.csv", "\xEF\xBB\xBF\"a\" , b\r\n 1 ,\"x\r\ny\"\r\n"));
  EXPECT_EQ(table.columns[0].name, "a");
  EXPECT_EQ(table.rows[0], (std::vector<Cell>{std::int64_t{1}, std::string("x\ny")}));
}

TEST(TableFile, BadFilesGiveLocatedErrors) {
  const TemporaryFolder folder;
  const auto error = [&](const std::string& content) {
    return table_error([&] { read_table(folder.write("bad.csv", content)); });
  };
  EXPECT_NE(error("").find("empty"), std::string::npos);
  EXPECT_NE(error(std::string("a\0b", 3)).find("binary"), std::string::npos);
  EXPECT_NE(error("a,b\n1\n").find("bad.csv:2:1: error: the row has 1 cells"), std::string::npos);
  EXPECT_NE(table_error([&] { read_table(folder / "none.csv"); }).find("none.csv"), std::string::npos);
  EXPECT_NE(table_error([&] { read_table(folder.path()); }).find("folder"), std::string::npos);
}

TEST(TableFile, CellsMustBeOfTheirColumnsType) {
  const TemporaryFolder folder;
  write_table(folder / "t.csv", sample_table());
  folder.write("t.csv", "policy,time_s,steps,good\na,fast,1.5,2\n");
  const std::string error = table_error([&] { read_table(folder / "t.csv"); });
  EXPECT_NE(error.find("t.csv:2:3: error: 'time_s': 'fast' is not a finite number"), std::string::npos)
      << error;
  EXPECT_NE(error.find("t.csv:2:8: error: 'steps': '1.5' is not an integer"), std::string::npos) << error;
  EXPECT_NE(error.find("t.csv:2:12: error: 'good': '2' is not 0 or 1"), std::string::npos) << error;
}

TEST(TableFile, TheSchemaMustDescribeEveryColumn) {
  const TemporaryFolder folder;
  write_table(folder / "t.csv", sample_table());
  folder.write("t.csv", "policy,time\n");
  const std::string error = table_error([&] { read_table(folder / "t.csv"); });
  EXPECT_NE(error.find("t.csv:1:8: error: the column 'time' is not in"), std::string::npos) << error;
  EXPECT_NE(error.find("time_s"), std::string::npos) << error;
  for (const char* schema :
       {"", "{", "[]", "{\"columns\": [{\"name\": \"policy\"}]}",
        "{\"columns\": [{\"name\": \"policy\", \"type\": \"x\", \"unit\": \"\", \"doc\": \"\"}]}"}) {
    folder.write("t.schema.json", schema);
    EXPECT_NE(table_error([&] { read_table(folder / "t.csv"); }).find("t.schema.json"), std::string::npos)
        << schema;
  }
}

TEST(TableFile, SaysWhyItCannotBeWritten) {
  const TemporaryFolder folder;
  try {
    write_table(folder / "none" / "t.csv", sample_table());
    FAIL() << "written into a folder that does not exist";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("No such file"), std::string::npos) << error.what();
  }
}

TEST(TableFile, RowsMustHaveACellForEachColumn) {
  const TemporaryFolder folder;
  Table table = sample_table();
  table.rows[0].pop_back();
  EXPECT_THROW(write_table(folder / "t.csv", table), std::logic_error);
}

TEST(Table, FindsColumnsByName) {
  const Table table = sample_table();
  EXPECT_EQ(table.column("steps"), 2u);
  EXPECT_FALSE(table.has("step"));
  try {
    table.column("step");
    FAIL();
  } catch (const std::out_of_range& error) {
    EXPECT_STREQ(error.what(), "there is no column 'step'; there are policy, time_s, steps, good");
  }
}

TEST(Cell, AsNumberAndAsText) {
  EXPECT_EQ(number(Cell(2.5)), 2.5);
  EXPECT_EQ(number(Cell(std::int64_t{-7})), -7);
  EXPECT_TRUE(std::isnan(number(Cell())));
  EXPECT_TRUE(std::isnan(number(Cell(std::string("1")))));
  EXPECT_EQ(cell_text(Cell(0.1)), "0.1");
  EXPECT_EQ(cell_text(Cell(std::int64_t{9007199254740993})), "9007199254740993");
  EXPECT_EQ(cell_text(Cell()), "");
  EXPECT_EQ(cell_text(Cell(std::numeric_limits<double>::quiet_NaN())), "");
  EXPECT_EQ(cell_text(Cell(std::string("a,b"))), "a,b");
}

}  // namespace
}  // namespace coppice
