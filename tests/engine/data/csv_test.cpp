#include "engine/data/csv.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "engine/vocabulary/random.h"

namespace coppice {
namespace {

std::shared_ptr<const SourceFile> text(std::string content) {
  return std::make_shared<SourceFile>(SourceFile{"t.csv", std::move(content)});
}

std::vector<std::vector<std::string>> records(std::string content) {
  CsvReader reader(text(std::move(content)));
  std::vector<std::vector<std::string>> all;
  while (reader.next()) {
    std::vector<std::string>& record = all.emplace_back();
    for (std::size_t i = 0; i < reader.header().size(); ++i) record.emplace_back(reader[i]);
  }
  return all;
}

/// "line:column: message" of the first mistake.
std::string error_of(std::string content) {
  try {
    records(std::move(content));
  } catch (const ConfigError& error) {
    const Diagnostic& first = error.diagnostics().front();
    return std::to_string(first.place.line) + ":" + std::to_string(first.place.column) + ": " + first.message;
  }
  return "";
}

using Records = std::vector<std::vector<std::string>>;

TEST(CsvReader, ReadsPlainAndQuotedFields) {
  EXPECT_EQ(records("a,b\n1,2\nx,\"y, z\"\n"), (Records{{"1", "2"}, {"x", "y, z"}}));
  EXPECT_EQ(records("a,b\n\"say \"\"hi\"\"\",\"two\nlines\"\n"), (Records{{"say \"hi\"", "two\nlines"}}));
  EXPECT_EQ(records("a,b\n\"\",\"\"\"\"\n"), (Records{{"", "\""}}));
}

TEST(CsvReader, LastLineEndIsOptional) {
  EXPECT_EQ(records("a,b\n1,2"), (Records{{"1", "2"}}));
  EXPECT_EQ(records("a,b\n1,"), (Records{{"1", ""}}));
  EXPECT_EQ(records("a\n\"q\""), (Records{{"q"}}));
}

TEST(CsvReader, BlanksAroundFieldsDoNotCount) {
  EXPECT_EQ(records(" a ,\tb\n 1 , \"  kept \" \n"), (Records{{"1", "  kept "}}));
}

TEST(CsvReader, SkipsBlankLines) {
  EXPECT_EQ(records("\na,b\n\n1,2\n\n\n3,4\n\n"), (Records{{"1", "2"}, {"3", "4"}}));
}

TEST(CsvReader, SaysWhereWhatIsWrong) {
  EXPECT_EQ(error_of(""), "1:1: the file has no header row");
  EXPECT_EQ(error_of("a,,c\n"), "1:3: a column has no name");
  EXPECT_EQ(error_of("a,b,a\n"), "1:5: the column 'a' stands twice");
  EXPECT_EQ(error_of("a,b\n1,2\n1,2,3\n"), "3:5: the row has 3 cells, the header has 2");
  EXPECT_EQ(error_of("a,b\n1\n"), "2:1: the row has 1 cells, the header has 2");
  EXPECT_EQ(error_of("a,b\n1,\"open\n2,3\n"), "2:3: the quote is not closed");
  EXPECT_EQ(error_of("a,b\nx\"y,1\n"), "2:2: a quote stands inside a cell");
  EXPECT_EQ(error_of("a,b\n\"x\"y,1\n"), "2:4: a comma or a line end must follow the closing quote");
}

TEST(CsvReader, ColumnsOfPlacesCountCharactersNotBytes) {
  EXPECT_EQ(error_of("a,b\n\xC3\xA4\xC3\xA4\",1\n"), "2:3: a quote stands inside a cell");
}

TEST(CsvReader, RefusesWhatIsNotUtf8) {
  EXPECT_EQ(error_of("a,b\n\xC3\xA4,\xFF\n"), "2:3: this is not UTF-8 text");
}

TEST(ParseNumber, TakesNumbersAndNothingElse) {
  EXPECT_EQ(parse_number("-2.5e-3"), -2.5e-3);
  EXPECT_EQ(parse_number("+4"), 4.0);
  for (const char* wrong :
       {"", "x", "1x", "nan", "inf", "-inf", "1e999", "1,5", "0x10", "+-1", "--1", " 1", "1 2"}) {
    EXPECT_EQ(parse_number(wrong), std::nullopt) << wrong;
  }
}

TEST(AppendCsv, QuotesWhatNeedsIt) {
  const auto written = [](std::string_view field) {
    std::string line;
    append_csv(line, field);
    return line;
  };
  EXPECT_EQ(written("plain text"), "plain text");
  EXPECT_EQ(written("a,b"), "\"a,b\"");
  EXPECT_EQ(written("say \"hi\""), "\"say \"\"hi\"\"\"");
  EXPECT_EQ(written("two\nlines"), "\"two\nlines\"");
  EXPECT_EQ(written(" blank"), "\" blank\"");
}

TEST(AppendCsv, WritesTheShortestTextThatReadsBack) {
  const auto written = [](double number) {
    std::string line;
    append_csv(line, number);
    return line;
  };
  EXPECT_EQ(written(0.1), "0.1");
  EXPECT_EQ(written(-3), "-3");
  EXPECT_EQ(written(std::numeric_limits<double>::quiet_NaN()), "");
  EXPECT_EQ(written(-std::numeric_limits<double>::infinity()), "");
  Stream stream = Draws(1, "csv", 0).stream("numbers");
  for (int i = 0; i < 10000; ++i) {
    const double number = std::ldexp(stream.uniform(-1, 1), static_cast<int>(stream.below(600)) - 300);
    EXPECT_EQ(parse_number(written(number)), number);
  }
}

}  // namespace
}  // namespace coppice
