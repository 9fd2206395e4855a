#include <gtest/gtest.h>

#include "tests/cli/runs.h"

namespace coppice {
namespace {

class Language : public RunsInAFolder {};

TEST_F(Language, QuantitiesOfSweepsAreNumbersInSiUnitsInTables) {
  folder_.write("pub.csv", "ang,value\n10 deg,3\n0.3490658503988659,4\n");
  folder_.write(
      "e.xml",
      "<experiment coppice=\"1\"><arg name=\"h\" unit=\"h\" default=\"2\"/>"
      "<problem id=\"car\"><double_integrator/></problem>"
      "<sweep id=\"S\"><grid><param name=\"ang\" values=\"10 deg, 20 deg\"/></grid></sweep>"
      "<sweep id=\"M\"><grid><param name=\"mixed\" values=\"1 m, 2 s\"/></grid></sweep>"
      "<policy id=\"lf\" over=\"S\"><linear_feedback gains=\"${ang / (1 rad)}, 1\"/></policy>"
      "<evaluate id=\"e\" over=\"S, M\" problem=\"car\" policies=\"lf\" episodes=\"1\" horizon=\"2\"/>"
      "<table id=\"t\" of=\"e\" rows=\"ang\" columns=\"mixed\" published=\"pub.csv\"/>"
      "<compare id=\"k\" of=\"e\" by=\"ang\" within=\"mixed\" baseline=\"10 deg\"/></experiment>");
  const Ended ended = run("run e.xml h:=1,2 --progress none");
  ASSERT_EQ(ended.status, 0) << ended.err;
  const std::string rows = TemporaryFolder::read(folder_ / "out/e/nodes/e.csv");
  EXPECT_TRUE(contains(rows, "h,ang,mixed,")) << rows;
  EXPECT_TRUE(contains(rows, "\n3600,0.17453292519943295,1 m,")) << rows;
  EXPECT_TRUE(contains(rows, "\n7200,0.3490658503988659,2 s,")) << rows;
  const nlohmann::json schema =
      nlohmann::json::parse(TemporaryFolder::read(folder_ / "out/e/nodes/e.schema.json"));
  EXPECT_TRUE(contains(schema.dump(), R"("unit":"rad")")) << schema.dump();
  const std::string table = TemporaryFolder::read(folder_ / "out/e/tables/t.h=1%20h.csv");
  EXPECT_TRUE(contains(table, "\n0.17453292519943295,1 m,")) << table;
  EXPECT_TRUE(contains(table, ",3,")) << "the published value of 10 deg\n" << table;
}

TEST_F(Language, ARangeWiderThanNumbersAreIsDrawnFromEvenly) {
  folder_.write("e.xml",
                "<experiment coppice=\"1\"><sweep id=\"S\"><random n=\"50\"><param name=\"a\" "
                "min=\"-1e308\" max=\"1e308\"/></random></sweep></experiment>");
  const Ended ended = run("expand e.xml");
  ASSERT_EQ(ended.status, 0) << ended.err;
  int points = 0, below = 0;
  for (const std::string& line : lines(ended.out)) {
    points += contains(line, "<point") ? 1 : 0;
    below += contains(line, "a=\"-") ? 1 : 0;
  }
  EXPECT_EQ(points, 50);
  EXPECT_GT(below, 10);
  EXPECT_LT(below, 40);
}

TEST_F(Language, CascadesAreCutOff) {
  folder_.write("y.xml", "<experiment coppice=\"1\"><problem");
  folder_.write("z.xml", "<experiment coppice=\"1\"><problem");
  folder_.write("r.xml",
                "<experiment coppice=\"1\"><problem id=\"car\"><double_integrator/></problem>"
                "<arg name=\"g\" default=\"1\"/><collect id=\"c\" problem=\"car\" samples=\"9\" "
                "replicates=\"2\"/>"
                "<train id=\"t\" problem=\"car\" samples=\"c\" replicates=\"${g}\"><fqi iterations=\"2\">"
                "<q_value><extra_trees/></q_value></fqi></train></experiment>");
  const auto errors = [&](const std::string& arguments) {
    return nlohmann::json::parse(run("validate --format json " + arguments).out).at("errors").size();
  };
  EXPECT_EQ(errors("y.xml z.xml"), 2U);
  EXPECT_EQ(errors("r.xml g:=3"), 1U);
  EXPECT_EQ(errors("r.xml g:=2,2"), 1U);
  EXPECT_EQ(errors("r.xml g:=2"), 0U);
}

TEST_F(Language, FoldersAndBrokenLinksAreNotSuggestedInPlaceOfThemselves) {
  std::filesystem::create_symlink("nowhere.xml", folder_ / "dangling");
  for (const std::string arguments : {".", "dangling", "run dangling"}) {
    const Ended ended = run(arguments);
    EXPECT_EQ(ended.status, 2);
    EXPECT_FALSE(contains(ended.err, "did you mean")) << ended.err;
  }
}

TEST_F(Language, TheSchemaAcceptsCallsAndGroupsInsideSweeps) {
  folder_.write("c.xsd", run("schema").out);
  folder_.write("e.xml",
                "<experiment coppice=\"1\"><macro name=\"col\"><param name=\"a\" values=\"1, 2\"/></macro>"
                "<macro name=\"pt\"><point a=\"7\"/></macro>"
                "<macro name=\"drawn\"><param name=\"a\" min=\"8\" max=\"9\"/></macro>"
                "<sweep id=\"S\"><group><grid><call macro=\"col\"/></grid></group>"
                "<zip><group if=\"true\"><call macro=\"col\"/></group></zip>"
                "<list><call macro=\"pt\"/></list><random n=\"1\"><call macro=\"drawn\"/></random></sweep>"
                "</experiment>");
  EXPECT_EQ(run("validate e.xml").status, 0);
  EXPECT_EQ(script("xmllint --noout --nonet --schema c.xsd e.xml").status, 0);
  folder_.write("w.xml",
                "<experiment coppice=\"1\"><sweep id=\"S\"><grid><point a=\"1\"/></grid></sweep>"
                "</experiment>");
  EXPECT_NE(script("xmllint --noout --nonet --schema c.xsd w.xml").status, 0);
}

}  // namespace
}  // namespace coppice
