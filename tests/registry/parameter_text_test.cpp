#include "registry/parameter_text.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>

namespace coppice {
namespace {

ParameterInfo number(Bounds bounds, std::string unit = {}) {
  ParameterInfo info;
  info.unit = std::move(unit);
  info.bounds = bounds;
  info.default_text = std::string("4");
  return info;
}

TEST(ParameterText, ShowsBoundsWithUnit) {
  EXPECT_EQ(bounds_text(number(any())), "");
  EXPECT_EQ(bounds_text(number(above(0), "s")), "> 0 s");
  EXPECT_EQ(bounds_text(number(at_least(2))), ">= 2");
  EXPECT_EQ(bounds_text(number(at_most(1), "m")), "<= 1 m");
  EXPECT_EQ(bounds_text(number(between(0, 1), "rad")), "in [0, 1] rad");
  EXPECT_EQ(bounds_text(number({0, 1, true, true})), "in (0, 1)");
}

TEST(ParameterText, IsOneSentence) {
  ParameterInfo info = number(at_least(2));
  info.type = ValueType::integer;
  EXPECT_EQ(parameter_text(info), "integer >= 2, default 4");
  info.automatic = true;
  info.default_text = std::string("auto");
  EXPECT_EQ(parameter_text(info), "integer >= 2, default auto");
  info = number(any(), "m/s");
  EXPECT_EQ(parameter_text(info), "number in m/s, default 4 m/s");
  info.required = true;
  EXPECT_EQ(parameter_text(info), "number in m/s, required");
}

TEST(ParameterText, NamesEveryType) {
  ParameterInfo info = number(any());
  info.default_text.clear();
  info.type = ValueType::choice;
  info.choices = {"merge", "exact"};
  EXPECT_EQ(parameter_text(info), "one of merge, exact");
  info.type = ValueType::reference;
  info.artifact = std::string("evaluation");
  EXPECT_EQ(parameter_text(info), "id of an evaluation");
  info.type = ValueType::references;
  info.artifact = std::string("policy");
  EXPECT_EQ(parameter_text(info), "ids, each of a policy");
  info.type = ValueType::boolean;
  EXPECT_EQ(parameter_text(info), "true or false");
}

TEST(ParameterText, TellsWhatASlotTakes) {
  EXPECT_EQ(slot_text({"q_value", "approximator", false, false, false, "extra_trees", "Learns."}),
            "Learns. (an approximator, default extra_trees)");
  EXPECT_EQ(slot_text({"parts", "shape", false, true, true, "", "Parts."}),
            "Parts. (any number of: a shape, required)");
}

}  // namespace
}  // namespace coppice
