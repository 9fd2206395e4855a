#include "engine/graph/plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <ctime>
#include <fstream>
#include <set>

#include "tests/engine/graph/experiments.h"

namespace coppice::testing {
namespace {

using Names = std::vector<std::string>;

std::string key(const Plan& plan, const std::string& name) {
  return named(plan, name).key;
}

Plan planned(const std::string& nodes, std::vector<SweepPoints> sweeps = {}, const std::string& seed = "1") {
  return make_plan(
      experiment("<experiment seed='" + seed + "'>" + nodes + "</experiment>", std::move(sweeps)));
}

std::string errors(const std::string& nodes, std::vector<SweepPoints> sweeps = {}) {
  return plan_errors("<experiment>" + nodes + "</experiment>", std::move(sweeps));
}

const SweepPoints kAb = sweep("s", "p", {"a", "b"});
const SweepPoints k12 = sweep("t", "q", {"1", "2"});

TEST(Join, NodesOverTheSameSweepMeetPointByPoint) {
  const Plan plan = planned("<fake_source id='x' over='s'/><fake_step id='y' over='s' from='x'/>", {kAb});
  EXPECT_EQ(names(plan), (Names{"x p=a", "x p=b", "y p=a", "y p=b"}));
  EXPECT_EQ(inputs_of(plan, "y p=a"), (Names{"x p=a"}));
  EXPECT_EQ(inputs_of(plan, "y p=b"), (Names{"x p=b"}));
}

TEST(Join, ANodeOverFewerSweepsIsShared) {
  const Plan plan =
      planned("<fake_source id='x' over='s'/><fake_step id='y' over='s, t' from='x'/>", {kAb, k12});
  EXPECT_EQ(inputs_of(plan, "y p=a,q=1"), (Names{"x p=a"}));
  EXPECT_EQ(inputs_of(plan, "y p=a,q=2"), (Names{"x p=a"}));
  EXPECT_EQ(inputs_of(plan, "y p=b,q=2"), (Names{"x p=b"}));
}

TEST(Join, ANodeOverMoreSweepsIsGatheredOrRefused) {
  const std::string source = "<fake_source id='x' over='s, t'/>";
  const Plan plan = planned(source + "<fake_step id='y' over='s' many='x'/>", {kAb, k12});
  EXPECT_EQ(inputs_of(plan, "y p=b"), (Names{"x p=b,q=1", "x p=b,q=2"}));
  EXPECT_TRUE(contains(
      errors(source + "<fake_step id='y' over='s' from='x'/>", {kAb, k12}),
      "'from' takes one node, and 'x' stands for 2: it runs over the sweep 't', this node does not"));
}

TEST(Join, WhatGathersReplicatesTakesNoSweepPoints) {
  const std::string source =
      "<fake_source id='x' over='s, t' replicates='2'/><fake_source id='o' replicates='2'/>";
  const Plan plan = planned(source + "<fake_step id='y' over='s, t' runs='x, o'/>", {kAb, k12});
  EXPECT_EQ(inputs_of(plan, "y p=b,q=1"), (Names{"x p=b,q=1 r000", "x p=b,q=1 r001", "o r000", "o r001"}));
  EXPECT_TRUE(contains(errors(source + "<fake_step id='y' runs='x'/>", {kAb, k12}),
                       "'runs' takes a node at one sweep point, and 'x' stands for 8: it runs over the "
                       "sweeps 's', 't', this node does not | add over=\"s, t\" to this node"));
  EXPECT_TRUE(contains(errors(source + "<fake_step id='y' over='t' replicates='2' runs='x'/>", {kAb, k12}),
                       "it runs over the sweep 's', this node does not | write over=\"t, s\" for this node"));
}

TEST(Join, ReplicatesMeetOneToOneAreSharedOrGathered) {
  const Plan plan = planned(
      "<fake_source id='one'/><fake_source id='x' replicates='3'/><fake_step id='pair' replicates='3' "
      "from='x'/>"
      "<fake_step id='shared' replicates='2' from='one'/><fake_step id='all' many='x, one'/>");
  EXPECT_EQ(inputs_of(plan, "pair r002"), (Names{"x r002"}));
  EXPECT_EQ(inputs_of(plan, "shared r001"), (Names{"one"}));
  EXPECT_EQ(inputs_of(plan, "all"), (Names{"x r000", "x r001", "x r002", "one"}));
}

TEST(Join, ReplicatesThatDoNotFitAreRefused) {
  EXPECT_TRUE(contains(errors("<fake_source id='x' replicates='3'/><fake_step id='y' from='x'/>"),
                       "it has 3 replicates, this node has none | add replicates=\"3\" to this node"));
  EXPECT_TRUE(
      contains(errors("<fake_source id='x' replicates='3'/><fake_step id='y' replicates='2' from='x'/>"),
               "'x' has 3 replicates and cannot be joined one to one with the 2 of this node"));
}

TEST(Join, AFanOutTakesOverSweepsAndReplicates) {
  const Plan plan = planned(
      "<fake_source id='x' over='s' replicates='2'/><fake_source id='z'/><fake_score id='e' of='x, z'/>",
      {kAb});
  EXPECT_EQ(names(plan), (Names{"x p=a r000", "x p=a r001", "x p=b r000", "x p=b r001", "z", "e p=a x r000",
                                "e p=a x r001", "e p=b x r000", "e p=b x r001", "e z"}));
  EXPECT_EQ(inputs_of(plan, "e p=b x r001"), (Names{"x p=b r001"}));
  EXPECT_EQ(named(plan, "e p=b x r001").folder, "nodes/e/p=b/x/r001");
}

TEST(Join, SeveralSweepsMakeAProductAndPointsWithOddTextsGetFoldersOfTheirOwn) {
  const SweepPoints odd = sweep("s", "p", {"a/b", "a b", "..", "ä", "a,q=1"});
  const Plan plan = planned("<fake_source id='x' over='s, t'/>", {odd, k12});
  std::set<std::string> folders;
  for (const PlannedNode& node : plan.nodes) folders.insert(node.folder);
  EXPECT_EQ(folders.size(), 10u);
  EXPECT_TRUE(folders.contains("nodes/x/p=a%2Fb,q=1"));
  EXPECT_TRUE(folders.contains("nodes/x/p=a%2Cq%3D1,q=2"));
}

TEST(References, MistakesAreLocatedAndNameTheNearest) {
  EXPECT_TRUE(contains(errors("<fake_source id='samples'/><fake_step id='y' from='sample'/>"),
                       "1:64 'from' names 'sample', and no node has this id | did you mean 'samples'"));
  EXPECT_TRUE(
      contains(errors("<fake_constant id='c'/><fake_source id='d'/><fake_step id='y' from='c'/>"),
               "'from' needs a node that makes a data, and 'c' (<fake_constant>) makes none | valid: d"));
  const std::string twice = errors("<fake_source id='x'/><fake_step id='y' many='x, x'/>");
  EXPECT_TRUE(contains(twice, "'x' stands twice in 'many'"));
  EXPECT_EQ(std::count(twice.begin(), twice.end(), '\n'), 1) << twice;
  EXPECT_TRUE(contains(errors("<fake_source id='x'/><fake_source id='x'/>"), "the id 'x' is already used"));
  EXPECT_TRUE(
      contains(errors("<fake_sorce id='x'/>"), "no node kind <fake_sorce> | did you mean 'fake_source'"));
  EXPECT_TRUE(contains(errors("<fake_source id='a b'/>"), "id=\"a b\" is no name"));
}

TEST(References, ACircleIsShown) {
  EXPECT_TRUE(
      contains(errors("<fake_step id='a' from='c'/><fake_step id='b' from='a'/><fake_step id='c' from='b'/>"),
               "nodes need each other in a circle: 'a' needs 'c' needs 'b' needs 'a'"));
  EXPECT_TRUE(contains(errors("<fake_step id='a' from='a'/>"), "'a' needs 'a'"));
}

TEST(References, EveryMistakeIsReportedOnceInOnePass) {
  const std::string all = errors(
      "<fake_source id='x' over='s' amount='-1'/><fake_step id='y' from='nothing'/><fake_step id='z' "
      "factor='13'/>"
      "<fake_step id='w' over='s' from='x'/>",
      {kAb});
  EXPECT_TRUE(contains(all, "amount"));
  EXPECT_TRUE(contains(all, "'nothing'"));
  EXPECT_TRUE(contains(all, "factor must not be 13"));
  EXPECT_EQ(std::count(all.begin(), all.end(), '\n'), 3) << all;
}

TEST(Key, DoesNotDependOnNamesPlacesOrderOrLimits) {
  const Plan plan = planned("<fake_source id='x'/><fake_step id='y' from='x' factor='3'/>");
  const Plan other = planned(
      "<fake_step id='u' doc='d' from='v' factor='3.0' threads='4' time_limit='3 s'/><fake_source id='v' "
      "memory_limit='1 GB'/>");
  EXPECT_EQ(key(plan, "y"), key(other, "u"));
  const Plan swept =
      planned("<fake_source id='x' over='s'/><fake_step id='y' over='s' from='x' factor='3'/>", {kAb});
  EXPECT_EQ(key(plan, "y"), key(swept, "y p=a"));
  EXPECT_EQ(key(plan, "y"), key(swept, "y p=b"));
}

TEST(Key, DependsOnEverythingThatDecidesTheResult) {
  const auto key_of = [](const std::string& nodes, const std::string& seed = "1") {
    return key(planned(nodes, {}, seed), "y");
  };
  const std::string source = "<fake_source id='x' amount='5'/>";
  std::vector<std::string> keys = {
      key_of(source + "<fake_step id='y' from='x'/>"),
      key_of(source + "<fake_step id='y' from='x'/>", "2"),
      key_of(source + "<fake_step id='y' many='x'/>"),
      key_of(source + "<fake_step id='y' from='x' factor='4'/>"),
      key_of(source + "<fake_step id='y' from='x' seed_label='other'/>"),
      key_of("<fake_source id='x' amount='6'/><fake_step id='y' from='x'/>"),
      key_of("<fake_source id='x' amount='5' seed_label='other'/><fake_step id='y' from='x'/>"),
      key_of("<fake_constant id='c'/>" + source + "<fake_step id='y' from='x' constant='c'/>"),
      key_of("<fake_constant id='c' value='2'/>" + source + "<fake_step id='y' from='x' constant='c'/>"),
      key_of(source + "<fake_source id='z' amount='7'/><fake_step id='y' many='x, z'/>"),
      key_of(source + "<fake_source id='z' amount='7'/><fake_step id='y' many='z, x'/>"),
  };
  EXPECT_EQ(std::set<std::string>(keys.begin(), keys.end()).size(), keys.size());
}

TEST(Key, ReplicatesDifferAndTheFirstIsTheNodeWithoutReplicates) {
  const Plan plan = planned("<fake_source id='x' replicates='3'/><fake_source id='one'/>");
  EXPECT_NE(key(plan, "x r000"), key(plan, "x r001"));
  EXPECT_EQ(key(plan, "x r000"), key(plan, "one"));
}

TEST(Key, FollowsTheContentOfFilesNotTheirPath) {
  const auto key_with = [](const std::string& file, const std::string& content) {
    const std::string path = ::testing::TempDir() + file;
    std::ofstream(path) << content;
    return key(planned("<fake_source id='x' file='" + path + "'/>"), "x");
  };
  const std::string first = key_with("one.csv", "1,2");
  EXPECT_EQ(first, key_with("two.csv", "1,2"));
  EXPECT_NE(first, key_with("one.csv", "1,3"));
}

TEST(Key, OfWhatShowsLabelsDependsOnThem) {
  const auto key_of = [](const std::string& id) {
    return key(planned("<fake_source id='" + id + "'/><fake_score id='e' of='" + id +
                       "'/><fake_report id='t' of='e'/>"),
               "t");
  };
  EXPECT_EQ(key_of("x"), key_of("x"));
  const Plan plan = planned(
      "<fake_source id='x' over='s'/><fake_score id='e' over='s' of='x'/><fake_report id='t' of='e'/>",
      {kAb});
  const Plan renamed = planned(
      "<fake_source id='x' over='s'/><fake_score id='e' over='s' of='x'/><fake_report id='t' of='e'/>",
      {sweep("s", "p", {"a", "c"})});
  EXPECT_EQ(key(plan, "e p=b x"), key(renamed, "e p=c x"));
  EXPECT_NE(key(plan, "t"), key(renamed, "t"));
}

TEST(Key, TextSaysWhatItIsMadeOf) {
  const Plan plan = planned(
      "<fake_constant id='c' value='7'/><fake_source id='x'/><fake_step id='y' from='x' constant='c'/>");
  const std::string text = plan.key_text(plan.find("y").front());
  for (const char* line :
       {"seed = 1\n", "seed_label = fake_step\n", "replicate = 0\n", "node = fake_step/1\n",
        "node.factor = 2\n", "input.constant = fake_constant/1\n", "input.constant.value = 7\n"}) {
    EXPECT_TRUE(contains(text, line));
  }
  EXPECT_TRUE(contains(text, "input.from = " + key(plan, "x") + "\n"));
}

TEST(Streams, OfANodeAreItsOwnAndThoseOfItsAncestors) {
  const Plan plan = planned(
      "<fake_source id='x' replicates='2'/><fake_step id='y' replicates='2' from='x' seed_label='mine'/>");
  EXPECT_EQ(named(plan, "y r001").streams, (Names{"mine 1", "fake_source 1"}));
}

TEST(Plan, RefusesNamesThatAreNoFolders) {
  for (const char* name : {"a/b", "..", "store", ""}) {
    const std::string xml = "<experiment name='" + std::string(name) + "'><fake_source id='x'/></experiment>";
    EXPECT_TRUE(contains(plan_errors(xml), "cannot be the name of a folder"));
  }
}

TEST(Plan, TwoExperimentsOfOneNameAreAMistake) {
  const auto one = [] { return experiment("<experiment name='n'><fake_source id='x'/></experiment>"); };
  EXPECT_THROW(make_plans({one(), one()}), ConfigError);
}

// How long it takes is what tests/benchmarks tells. Here only time that grows with the square of the nodes is
// caught, by a wide limit on processor time, so that a busy machine fails nothing.
TEST(Plan, TenThousandNodesTakeNoQuadraticTime) {
  const auto measure = [](const std::string& nodes, std::vector<SweepPoints> sweeps, std::size_t count) {
    ExperimentConfig config = experiment("<experiment>" + nodes + "</experiment>", std::move(sweeps));
    const std::clock_t start = std::clock();
    const Plan plan = make_plan(std::move(config));
    EXPECT_LT(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC, 10.0);
    EXPECT_EQ(plan.nodes.size(), count);
  };
  measure(
      "<fake_source id='x' replicates='3333'/><fake_step id='y' replicates='3333' from='x'/>"
      "<fake_score id='e' of='y'/><fake_report id='t' of='e'/>",
      {}, 10000);
  std::vector<std::string> values;
  for (int i = 0; i < 3333; ++i) values.push_back(std::to_string(i));
  measure(
      "<fake_source id='x' over='s' amount='${p}'/><fake_step id='y' over='s' from='x'/>"
      "<fake_score id='e' over='s' of='y'/><fake_report id='t' of='e'/>",
      {sweep("s", "p", values)}, 10000);
}

}  // namespace
}  // namespace coppice::testing
