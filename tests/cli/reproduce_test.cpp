#include <gtest/gtest.h>

#include "tests/cli/runs.h"

namespace coppice {
namespace {

class Reproduce : public RunsInAFolder {
 protected:
  Reproduce() {
    folder_.write("small.xml", R"(<experiment coppice="1" seed="3">
  <problem id="car"><double_integrator start="uniform"/></problem>
  <policy id="random"><random/></policy>
  <collect id="samples" problem="car" policy="random" episodes="20" replicates="2"/>
  <train id="fqi" problem="car" samples="samples" replicates="2"><fqi iterations="2"/></train>
  <evaluate id="scores" problem="car" policies="random, fqi" episodes="10"/>
  <table id="costs" of="scores" rows="policy" metric="cost"/>
</experiment>
)");
  }
};

TEST_F(Reproduce, FindsTheSameResultsAgainAlthoughTheConfigHasChanged) {
  ASSERT_EQ(run("small.xml").status, 0);
  folder_.write("small.xml", "<experiment coppice=\"1\"/>");
  const Ended ended = run("reproduce out/small --progress none");
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_TRUE(contains(ended.out, " result files, all equal\n")) << ended.out;
  EXPECT_TRUE(std::filesystem::exists(folder_ / "reproduced/small/tables/costs.csv"));
}

TEST_F(Reproduce, SaysWhichRowsAndCircumstancesDiffer) {
  ASSERT_EQ(run("small.xml").status, 0);
  const auto change = [&](const std::string& file, const std::string& from, const std::string& to) {
    std::string text = TemporaryFolder::read(folder_ / ("out/small/" + file));
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << file;
    std::filesystem::remove(folder_ / ("out/small/" + file));
    folder_.write("out/small/" + file, text.replace(at, from.size(), to));
  };
  change("provenance.json", "\"compiler\": \"", "\"compiler\": \"other ");
  change("tables/costs.csv", "\nrandom,", "\nerratic,");
  const Ended ended = run("reproduce out --out again --progress none");
  EXPECT_EQ(ended.status, 1) << ended.err;
  EXPECT_TRUE(contains(ended.out, "compiler: other ")) << ended.out;
  EXPECT_TRUE(contains(ended.out, "tables/costs.csv: 2 of 3 rows differ\n")) << ended.out;
}

TEST_F(Reproduce, RefusesTheFolderOfTheResultsAndFoldersWithoutAny) {
  ASSERT_EQ(run("small.xml").status, 0);
  for (const std::string command : {"reproduce out --out out", "reproduce out/small --out ./out/"}) {
    const Ended ended = run(command);
    EXPECT_EQ(ended.status, 2) << command;
    EXPECT_TRUE(contains(ended.err, "holds the results that are to be reproduced")) << ended.err;
  }
  EXPECT_EQ(run("reproduce nowhere").status, 2);
}

class Init : public RunsInAFolder {};

TEST_F(Init, StartsAProjectThatIsValidAndFitsItsSchema) {
  const Ended ended = run("init robot");
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(ended.out, "robot/experiment.xml\nrobot/coppice.xsd\nrobot/.gitignore\n");
  EXPECT_EQ(run("validate robot/experiment.xml").status, 0);
  EXPECT_EQ(script("xmllint --noout --schema robot/coppice.xsd robot/experiment.xml").status, 0);
  EXPECT_EQ(run("robot/experiment.xml replicates:=1 --progress none").status, 0);
}

TEST_F(Init, OverwritesNothing) {
  folder_.write("experiment.xml", "mine");
  const Ended ended = run("init");
  EXPECT_EQ(ended.status, 2);
  EXPECT_TRUE(contains(ended.err, "has a file experiment.xml already")) << ended.err;
  EXPECT_EQ(TemporaryFolder::read(folder_ / "experiment.xml"), "mine");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "coppice.xsd"));
}

}  // namespace
}  // namespace coppice
