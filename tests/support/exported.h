#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "engine/graph/export.h"
#include "engine/vocabulary/policy.h"
#include "solvers/policies/fitted_policy.h"
#include "tests/support/make.h"

namespace coppice {

/// A policy to export, as its file holds it.
struct TestPolicy {
  std::string name;
  PolicyFile file;
  std::size_t inputs() const { return file.spaces.states.size(); }
  std::size_t outputs() const { return file.spaces.actions[0].axes.size(); }
};

/// Three inputs; one action with a bounded, a circular and an unbounded parameter.
inline Spaces test_spaces() {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const double pi = std::numbers::pi;
  return {
      {{"position", "m", -1, 1}, {"double", "", -kInfinity, kInfinity}, {"tilt angle", "rad", -pi, pi, true}},
      {{"walk",
        {{"forward", "m/s", -0.5, 0.75},
         {"turn", "rad", -pi, pi, true},
         {"position", "", -kInfinity, 1000.5}}}}};
}

inline double test_target(std::size_t output, const std::array<double, 3>& x) {
  const double bend = x[0] * x[1] + (x[2] > 0.3 ? 0.5 : -0.25) * x[0];
  return output == 0 ? bend : output == 1 ? 4 * x[2] + bend : 1000.0 + bend - 0.1 * x[1];
}

/// A fitted policy: what the approximator learns from `samples` points of test_target.
inline TestPolicy fitted(const std::string& name, const std::string& approximator,
                         std::size_t samples = 2000) {
  TestPolicy policy{name, {}};
  policy.file.writer = "coppice test";
  policy.file.provenance = "0123456789abcdef";
  policy.file.spaces = test_spaces();
  Matrix x(samples, 3), y(samples, 3);
  Stream stream = Draws(2017, "exports", 0).stream("samples", samples);
  for (std::size_t i = 0; i < samples; ++i) {
    std::array<double, 3> point;
    for (std::size_t c = 0; c < 3; ++c) x(i, c) = point[c] = stream.uniform(-1, 1);
    for (std::size_t o = 0; o < 3; ++o) y(i, o) = test_target(o, point);
  }
  Serial serial;
  FittedPolicy fitted;
  const auto learner = make_from_xml<Approximator>(approximator);
  fitted.function = learner->fit({x, y, {}}, Draws(2017, "fit", 0), serial);
  fitted.save(policy.file.arrays);
  policy.file.component = FittedPolicy::parameters().print(fitted, FittedPolicy::kName);
  return policy;
}

/// A policy without arrays.
inline TestPolicy configured(const std::string& name, const std::string& xml) {
  TestPolicy policy{name, {}};
  policy.file.writer = "coppice test";
  policy.file.spaces = test_spaces();
  policy.file.component = make_from_xml<Policy>(xml).resolved;
  return policy;
}

/// One of each kind that can be exported.
inline std::vector<TestPolicy> test_policies() {
  return {
      fitted("pwc", "<extra_trees trees=\"25\"/>"),
      fitted("pwl", "<extra_trees trees=\"10\" leaves=\"pwl\"/>"),
      fitted("trimmed_pwc", "<extra_trees trees=\"12\" aggregation=\"trimmed_mean\"/>", 500),
      fitted("trimmed_many", "<extra_trees trees=\"70\" aggregation=\"trimmed_mean\"/>", 100),
      fitted("trimmed_pwl", "<extra_trees trees=\"12\" leaves=\"pwl\" aggregation=\"trimmed_mean\"/>", 500),
      fitted("oblique_pwc", "<extra_trees trees=\"25\" splits=\"oblique\"/>"),
      fitted("oblique_pwl", "<extra_trees trees=\"10\" leaves=\"pwl\" splits=\"oblique\"/>", 500),
      fitted("tree", "<regression_tree/>"),
      fitted("leaf", "<regression_tree/>", 1),
      fitted("linear", "<linear/>"),
      fitted("constant", "<constant/>"),
      configured("feedback", "<linear_feedback gains=\"0.7,0,-0.1, 1,2,3, 5,6,7\" offset=\"0,0.5,-0\"/>"),
      configured("still", "<constant values=\"9, 9, -9\"/>")};
}

/// States in and around the box, on thresholds and beside them, and those that nobody expects.
inline std::vector<double> test_states(const TestPolicy& policy, std::size_t rows) {
  std::vector<double> special = {0.0,
                                 -0.0,
                                 1e-320,
                                 -1e-320,
                                 1e-40,
                                 1e300,
                                 -1e300,
                                 1.0 + 1e-12,
                                 std::numeric_limits<double>::infinity(),
                                 -std::numeric_limits<double>::infinity(),
                                 std::numeric_limits<double>::quiet_NaN()};
  const MadePolicy made = make_policy(policy.file);
  made.object->prepare(policy.file.spaces, nullptr);
  const PolicyModel model = made->exported();
  if (const auto* forest = std::get_if<ForestModel>(&model.function)) {
    for (const ForestModel::Node& node : forest->outputs[0].trees[0].nodes) {
      if (node.is_leaf() || special.size() > 60) continue;
      special.insert(special.end(), {node.value, std::nextafter(double{node.value}, 10.0),
                                     std::nextafter(double{node.value}, -10.0)});
    }
  }
  Stream stream = Draws(2017, "exports", 0).stream("states", 0);
  std::vector<double> states(rows * policy.inputs());
  for (double& value : states) {
    const auto pick = static_cast<std::size_t>(stream.uniform(0, 20.0 * static_cast<double>(special.size())));
    value = pick < special.size() ? special[pick] : stream.uniform(-1.3, 1.3);
  }
  return states;
}

/// What the policy itself does in the states, row after row.
inline std::vector<double> actions_of(const TestPolicy& policy, const std::vector<double>& states) {
  const MadePolicy made = make_policy(policy.file);
  made.object->prepare(policy.file.spaces, nullptr);
  std::vector<double> actions;
  Action action;
  for (std::size_t i = 0; i < states.size(); i += policy.inputs()) {
    made->act({&states[i], policy.inputs()}, {}, Draws(1, "", 0), action);
    actions.insert(actions.end(), action.values.begin(), action.values.end());
  }
  return actions;
}

inline std::string exported(const TestPolicy& policy, const std::string& format) {
  const MadePolicy made = make_policy(policy.file);
  made.object->prepare(policy.file.spaces, nullptr);
  return make_exporter(format)->write(exported_policy(policy.name, made, policy.file, policy.file.spaces));
}

inline std::string bytes_of(const std::vector<double>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double)};
}

}  // namespace coppice
