// A short learning run of each solver, and a few predictions or actions of each approximator, function and
// policy.

#include <gtest/gtest.h>

#include "tests/support/golden.h"
#include "tests/support/make.h"
#include "tests/support/random_samples.h"

namespace coppice {
namespace {

const Draws kGoldenDraws(2017, "golden", 0);

/// Fits `approximator` to 150 samples of two smooth functions of three inputs.
MadeFunction fitted(const Approximator& approximator) {
  Matrix x(150, 3), y(150, 2);
  Stream stream = kGoldenDraws.stream("samples");
  for (std::size_t i = 0; i < x.rows(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) x(i, c) = stream.uniform(-1, 1);
    y(i, 0) = x(i, 0) * x(i, 1) - (x(i, 2) - 0.5) * (x(i, 2) - 0.5);
    y(i, 1) = x(i, 2) + stream.uniform(0, 0.1);
  }
  Serial serial;
  return approximator.fit({x, y, {}}, kGoldenDraws, serial);
}

void add_predictions(const Function& function, NamedValues& values) {
  Stream stream = kGoldenDraws.stream("points");
  std::vector<double> x(3), y(2);
  for (int i = 0; i < 8; ++i) {
    for (double& value : x) value = stream.uniform(-1.2, 1.2);
    function.predict(x, y);
    for (std::size_t o = 0; o < 2; ++o) values.add(fmt::format("prediction {} of output {}", i, o), y[o]);
  }
}

using Method = std::pair<const char*, Maximization::Method>;
const Method kMerge{"merge", Maximization::Method::merge}, kExact{"exact", Maximization::Method::exact},
    kAscent{"ascent", Maximization::Method::ascent};

void add_maxima(const Function& function, const std::vector<Method>& methods, NamedValues& values) {
  const Space box = {{"a", "", -1, 1}, {"b", "", -1, 1}};
  for (const auto& [name, method] : methods) {
    for (const double prefix : {-0.7, 0.1, 0.9}) {
      const Maximum best = function.maximize({&prefix, 1}, box, {method, 20});
      const std::string what = fmt::format("{} maximum at {}: ", name, prefix);
      values.add(what + "value", best.value);
      for (std::size_t i = 0; i < best.at.size(); ++i) values.add(what + box[i].name, best.at[i]);
    }
  }
}

void add_actions(const Policy& policy, const Spaces& spaces, NamedValues& values) {
  std::vector<double> state(spaces.state_size()), memory(policy.memory_size());
  policy.reset(memory);
  Action action;
  for (std::uint32_t i = 0; i < 10; ++i) {
    const Draws draws = kGoldenDraws.fork("actions").step(i);
    for (std::uint32_t c = 0; c < state.size(); ++c) {
      state[c] = draws.uniform("state", spaces.states[c].low, spaces.states[c].high, c);
    }
    policy.act(state, memory, draws, action);
    values.add(fmt::format("action {}: id", i), action.id);
    for (std::size_t a = 0; a < action.values.size(); ++a) {
      const Space& axes = spaces.actions[static_cast<std::size_t>(action.id)].axes;
      values.add(fmt::format("action {}: {}", i, axes[a].name), action.values[a]);
    }
  }
}

/// Learns with `solver` from random actions; keeps the measures of each unit of work.
TrainingResult learned(const Solver& solver, const RandomSamples& samples, NamedValues* measures = nullptr) {
  const std::unique_ptr<Training> training = solver.start(samples.inputs());
  Serial serial;
  for (bool more = true; more;) {
    more = training->advance(serial);
    const TrainingProgress progress = training->progress();
    if (measures == nullptr) continue;
    for (const auto& [name, value] : progress.measures) {
      measures->add(fmt::format("after {} of {}: {}", progress.done, progress.total, name), value);
    }
  }
  TrainingResult result = training->result();
  result.policy.object->prepare(samples.problem->spaces(), samples.problem->simulator());
  return result;
}

/// What samples are made of.
std::string versions_of(const RandomSamples& samples) {
  return "double_integrator " + versions_of(samples.problem) + "; random " + versions_of(samples.policy);
}

class ApproximatorGoldens : public testing::TestWithParam<std::string> {};

TEST_P(ApproximatorGoldens, PredictionsAreTheRecordedOnes) {
  const Sub<Approximator> approximator = make_for_golden<Approximator>(GetParam());
  NamedValues values;
  const MadeFunction function = fitted(*approximator);
  for (const auto& [fact, value] : function->facts()) values.add(fact, value);
  add_predictions(*function, values);
  expect_golden("approximator", GetParam(), values.table(), versions_of(approximator));
}

INSTANTIATE_TEST_SUITE_P(All, ApproximatorGoldens,
                         testing::ValuesIn(Catalogue::instance().names("approximator")), component_name);

TEST(ForestGoldens, ObliqueForestsAreTheRecordedOnes) {
  const Sub<Approximator> approximator =
      make_from_xml<Approximator>("<extra_trees splits=\"oblique\" trees=\"3\" leaves=\"pwl\"/>");
  NamedValues values;
  const MadeFunction function = fitted(*approximator);
  for (const auto& [fact, value] : function->facts()) values.add(fact, value);
  add_predictions(*function, values);
  expect_golden("approximator", "extra_trees.oblique", values.table(), versions_of(approximator));
}

TEST(ForestGoldens, MaximaByAscentAreTheRecordedOnes) {
  const Sub<Approximator> approximator = make_for_golden<Approximator>("extra_trees");
  NamedValues values;
  const MadeFunction function = fitted(*approximator);
  add_maxima(*function, {kAscent}, values);
  expect_golden("function", "forest.ascent", values.table(), versions_of(approximator));
}

class FunctionGoldens : public testing::TestWithParam<std::string> {};

// As the first approximator makes it that does.
TEST_P(FunctionGoldens, PredictionsAndMaximaAreTheRecordedOnes) {
  for (const std::string& name : Catalogue::instance().names("approximator")) {
    const Sub<Approximator> approximator = make_for_golden<Approximator>(name);
    const MadeFunction function = fitted(*approximator);
    if (function.resolved.name != GetParam()) continue;
    NamedValues values;
    add_predictions(*function, values);
    add_maxima(*function, {kMerge, kExact}, values);
    expect_golden("function", GetParam(), values.table(),
                  versions_of(function) + "; " + name + " " + versions_of(approximator));
    return;
  }
  FAIL() << "no approximator makes <" << GetParam() << ">";
}

INSTANTIATE_TEST_SUITE_P(All, FunctionGoldens, testing::ValuesIn(Catalogue::instance().names("function")),
                         component_name);

class SolverGoldens : public testing::TestWithParam<std::string> {};

TEST_P(SolverGoldens, LearningCurveIsTheRecordedOne) {
  const RandomSamples samples(kGoldenDraws);
  const Sub<Solver> solver = make_for_golden<Solver>(GetParam());
  NamedValues values;
  const TrainingResult result = learned(*solver, samples, &values);
  add_actions(*result.policy, samples.problem->spaces(), values);
  expect_golden("solver", GetParam(), values.table(), versions_of(solver) + "; " + versions_of(samples));
}

INSTANTIATE_TEST_SUITE_P(All, SolverGoldens, testing::ValuesIn(Catalogue::instance().names("solver")),
                         component_name);

class PolicyGoldens : public testing::TestWithParam<std::string> {};

bool is_learned(const std::string& policy) {
  const std::vector<SlotInfo>& slots = Catalogue::instance().find("policy", policy)->slots;
  return std::any_of(slots.begin(), slots.end(),
                     [](const SlotInfo& slot) { return slot.interface == "function"; });
}

// Configured policies as they stand; learned ones as the first solver makes them that does.
TEST_P(PolicyGoldens, ActionsAreTheRecordedOnes) {
  const RandomSamples samples(kGoldenDraws);
  const Spaces& spaces = samples.problem->spaces();
  NamedValues values;
  if (!is_learned(GetParam())) {
    const Sub<Policy> policy = make_for_golden<Policy>(GetParam());
    policy.object->prepare(spaces, samples.problem->simulator());
    add_actions(*policy, spaces, values);
    expect_golden("policy", GetParam(), values.table(), versions_of(policy));
    return;
  }
  for (const std::string& name : Catalogue::instance().names("solver")) {
    const Sub<Solver> solver = make_for_golden<Solver>(name);
    const MadePolicy policy = learned(*solver, samples).policy;
    if (policy.resolved.name != GetParam()) continue;
    add_actions(*policy, spaces, values);
    expect_golden(
        "policy", GetParam(), values.table(),
        versions_of(policy) + "; " + name + " " + versions_of(solver) + "; " + versions_of(samples));
    return;
  }
  FAIL() << "no solver makes <" << GetParam() << ">";
}

INSTANTIATE_TEST_SUITE_P(All, PolicyGoldens, testing::ValuesIn(Catalogue::instance().names("policy")),
                         component_name);

}  // namespace
}  // namespace coppice
