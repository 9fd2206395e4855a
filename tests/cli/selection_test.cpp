#include <gtest/gtest.h>

#include "tests/cli/runs.h"

namespace coppice {
namespace {

class Selecting : public RunsInAFolder {
 protected:
  void SetUp() override {
    for (const std::string name : {"a", "b"}) {
      folder_.write(name + ".xml",
                    "<experiment coppice=\"1\"><problem id=\"car\"><double_integrator/></problem>"
                    "<policy id=\"any\"><random/></policy>"
                    "<collect id=\"shared\" problem=\"car\" policy=\"any\" episodes=\"2\"/>"
                    "<evaluate id=\"only_" +
                        name + "\" problem=\"car\" policies=\"any\" horizon=\"" +
                        std::string(name == "a" ? "2" : "3") +
                        "\" episodes=\"2\"/>"
                        "</experiment>");
    }
  }
  void refused(const std::string& arguments, const std::vector<std::string>& parts) const {
    for (const std::string command : {"plan ", "run "}) {
      const Ended ended = run(command + arguments);
      EXPECT_EQ(ended.status, 2) << command << arguments;
      EXPECT_EQ(ended.out, "");
      for (const std::string& part : parts)
        EXPECT_TRUE(contains(ended.err, part)) << part << "\n" << ended.err;
      EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
    }
  }
};

TEST_F(Selecting, EachConfigTakesTheNodesThatItHas) {
  const Ended plan = run("plan a.xml b.xml --only only_a");
  EXPECT_EQ(plan.status, 0) << plan.err;
  EXPECT_TRUE(contains(plan.out, "a: 1 of 2 nodes to run")) << plan.out;
  EXPECT_TRUE(contains(plan.out, "b: none of its nodes is selected")) << plan.out;
  const Ended ran = run("run a.xml b.xml --only only_a --progress plain");
  EXPECT_EQ(ran.status, 0) << ran.err;
  EXPECT_TRUE(contains(ran.err, "b: none of its nodes is selected")) << ran.err;
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out/a"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out/b"));
  EXPECT_EQ(executed("a.xml b.xml --only only_a,only_b").size(), 1U);
  EXPECT_EQ(executed("a.xml b.xml"), (Names{"shared"}));  // the same one in both
  EXPECT_EQ(executed("a.xml b.xml --force only_b").size(), 1U);
}

TEST_F(Selecting, ANodeThatNoConfigHasIsShownOnTheCommandLine) {
  refused("a.xml b.xml --only only_a,only_c",
          {"<command line>:1:", "'only_c' is no node of any", "| runner ", " ^~~~~~ did you mean 'only_a'?"});
  refused("a.xml --force=shard", {"<command line>:1:2", ": error: 'shard' is no node of the experiment 'a'",
                                  "did you mean 'shared'?"});
  refused("a.xml b.xml --only only_a --force only_b",
          {"<command line>:1:", "'only_b' is forced, and not among"});
}

}  // namespace
}  // namespace coppice
