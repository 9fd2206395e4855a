#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "engine/graph/plan.h"

namespace coppice::testing {

/// An experiment written as a flat text, for tests of the graph alone: over="..." names sweeps, and in
/// attributes
/// "${column}" stands for a column's value. The node kinds are those of fake_nodes_test.cpp.
ExperimentConfig experiment(const std::string& xml, std::vector<SweepPoints> sweeps = {});

/// A sweep over one column.
SweepPoints sweep(std::string id, std::string column, std::vector<std::string> values);

/// The planned node with this name; fails the test when there is none.
const PlannedNode& named(const Plan& plan, const std::string& name);
/// Names of the nodes that a node reads, all parameters together.
std::vector<std::string> inputs_of(const Plan& plan, const std::string& name);
std::vector<std::string> names(const Plan& plan);
::testing::AssertionResult contains(const std::string& text, const std::string& part);
/// All messages of the ConfigError that planning throws, one a line; "" when it does not.
std::string plan_errors(const std::string& xml, std::vector<SweepPoints> sweeps = {});

}  // namespace coppice::testing
