// What every registered approximator, function, solver and policy promises; new ones are covered without an
// edit.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "engine/graph/artifacts.h"
#include "engine/vocabulary/solver.h"
#include "tests/support/example.h"
#include "tests/support/make.h"
#include "tests/support/random_samples.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/threads.h"

namespace coppice {
namespace {

const Draws kDraws(2017, "conformance", 0);

template <class Made>
std::string arrays_of(const Made& made) {
  Archive archive;
  made->save(archive);
  return archive.bytes();
}

/// Actions of a policy in many states; NaN stays comparable as text.
std::vector<double> actions_of(const Policy& policy, const Spaces& spaces) {
  std::vector<double> all, state(spaces.state_size()), memory(policy.memory_size());
  policy.reset(memory);
  Action action;
  for (std::uint64_t i = 0; i < 200; ++i) {
    const Draws draws = kDraws.scenario(i);
    for (std::size_t c = 0; c < state.size(); ++c) {
      const Axis& axis = spaces.states[c];
      state[c] = draws.uniform("state", axis.low, axis.high, static_cast<std::uint32_t>(c));
    }
    policy.act(state, memory, draws, action);
    EXPECT_EQ(clamp(action, spaces.actions), action) << "the action is not in its box";
    all.push_back(action.id);
    all.insert(all.end(), action.values.begin(), action.values.end());
  }
  return all;
}

/// A policy goes through a file: the same bytes when written again, and the same actions.
void expect_survives_a_file(const MadePolicy& policy, const Spaces& spaces) {
  const TemporaryFolder folder;
  PolicyFile content{"", "key", spaces, policy.resolved, {}};
  policy->save(content.arrays);
  write_policy_file(folder / "a.policy", content);

  PolicyFile back = read_policy_file(folder / "a.policy");
  const MadePolicy again = make_policy(back);
  PolicyFile rewritten{back.writer, back.provenance, back.spaces, again.resolved, {}};
  again->save(rewritten.arrays);
  write_policy_file(folder / "b.policy", rewritten);
  EXPECT_EQ(TemporaryFolder::read(folder / "a.policy"), TemporaryFolder::read(folder / "b.policy"));

  again.object->prepare(spaces, nullptr);
  EXPECT_EQ(actions_of(*again, spaces), actions_of(*policy, spaces));
}

/// Trains to the end; after `interruption` units of work goes on in a new training, as after a restart.
TrainingResult train(const Solver& solver, const TrainingInputs& inputs, Parallel& parallel,
                     int interruption = -1) {
  std::unique_ptr<Training> training = solver.start(inputs);
  for (int unit = 0; training->advance(parallel); ++unit) {
    if (unit != interruption) continue;
    Archive checkpoint;
    training->save(checkpoint);
    checkpoint = Archive::from_bytes(checkpoint.bytes());
    training = solver.start(inputs);
    training->load(checkpoint);
  }
  return training->result();
}

class Solvers : public testing::TestWithParam<std::string> {};

TEST_P(Solvers, TrainToTheSameBytesOnThreadsAndAfterARestart) {
  const RandomSamples samples(kDraws);
  const Sub<Solver> solver = make_example<Solver>(GetParam());
  TrainingInputs inputs = samples.inputs();
  Serial serial;
  Threads threads(3);
  const TrainingResult first = train(*solver, inputs, serial);
  const TrainingResult threaded = train(*solver, inputs, threads);
  const TrainingResult resumed = train(*solver, inputs, serial, 1);
  for (const TrainingResult* other : {&threaded, &resumed}) {
    EXPECT_EQ(to_xml(other->policy.resolved), to_xml(first.policy.resolved));
    EXPECT_EQ(arrays_of(other->policy), arrays_of(first.policy));
    ASSERT_EQ(static_cast<bool>(other->value), static_cast<bool>(first.value));
    if (first.value) {
      EXPECT_EQ(arrays_of(other->value), arrays_of(first.value));
    }
  }
  inputs.draws = Draws(2018, "conformance", 0);
  EXPECT_NE(arrays_of(train(*solver, inputs, serial).policy), arrays_of(first.policy))
      << "the seed changes nothing";

  const Spaces& spaces = samples.problem->spaces();
  first.policy.object->prepare(spaces, samples.problem->simulator());
  expect_survives_a_file(first.policy, spaces);
}

/// Names of the measures in the progress of a training, in order of appearance.
std::vector<std::string> measured(const Solver& solver, const TrainingInputs& inputs) {
  Serial serial;
  const std::unique_ptr<Training> training = solver.start(inputs);
  std::vector<std::string> names;
  for (bool more = true; more;) {
    more = training->advance(serial);
    for (const auto& [name, value] : training->progress().measures) {
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
  }
  return names;
}

TEST_P(Solvers, SayBeforeTheyStartWhatTheyMeasure) {
  const RandomSamples samples(kDraws);
  const Sub<Solver> solver = make_example<Solver>(GetParam());
  TrainingInputs inputs = samples.inputs();
  EXPECT_EQ(solver->measures(false), measured(*solver, inputs)) << "Solver::measures";
  if (!solver->needs().uses_value) return;
  Serial serial;
  inputs.value = train(*solver, inputs, serial).value;
  EXPECT_EQ(solver->measures(true), measured(*solver, inputs)) << "Solver::measures, with a value function";
}

INSTANTIATE_TEST_SUITE_P(All, Solvers, testing::ValuesIn(Catalogue::instance().names("solver")),
                         component_name);

// Configured policies as they stand; learned ones (whose arrays are missing) as some solver makes them,
// above.
TEST(Policies, SurviveAFile) {
  const RandomSamples samples(kDraws);
  const Spaces& spaces = samples.problem->spaces();
  std::set<std::string> learned, trained;
  for (const std::string& name : Catalogue::instance().names("policy")) {
    SCOPED_TRACE(name);
    const ComponentInfo& info = *Catalogue::instance().find("policy", name);
    const bool holds_functions = std::any_of(info.slots.begin(), info.slots.end(), [](const SlotInfo& slot) {
      return slot.interface == "function";
    });
    if (holds_functions) {
      learned.insert(name);
      continue;
    }
    const Sub<Policy> policy = make_example<Policy>(name);
    policy.object->prepare(spaces, samples.problem->simulator());
    expect_survives_a_file(policy, spaces);
  }
  TrainingInputs inputs = samples.inputs();
  Serial serial;
  for (const std::string& name : Catalogue::instance().names("solver")) {
    trained.insert(train(*make_example<Solver>(name), inputs, serial).policy.resolved.name);
  }
  for (const std::string& name : learned)
    EXPECT_TRUE(trained.contains(name)) << name << " is made by no solver";
}

class Approximators : public testing::TestWithParam<std::string> {};

TEST_P(Approximators, FitTheSameFunctionOnThreadsAndThroughAFile) {
  Matrix x(150, 3), y(150, 2);
  for (std::size_t i = 0; i < x.rows(); ++i) {
    const Draws draws = kDraws.scenario(i);
    for (std::size_t c = 0; c < 3; ++c) x(i, c) = draws.uniform("x", -1, 1, static_cast<std::uint32_t>(c));
    y(i, 0) = x(i, 0) * x(i, 1);
    y(i, 1) = x(i, 2) - draws.uniform("noise", 0, 0.1);
  }
  const Sub<Approximator> approximator = make_example<Approximator>(GetParam());
  Serial serial;
  Threads threads(3);
  const MadeFunction function = approximator->fit({x, y, {}}, kDraws, serial);
  const MadeFunction threaded = approximator->fit({x, y, {}}, kDraws, threads);
  EXPECT_EQ(arrays_of(threaded), arrays_of(function));
  EXPECT_EQ(function->inputs(), 3u);
  EXPECT_EQ(function->outputs(), 2u);

  const TemporaryFolder folder;
  FunctionFile content{"", "key", {"s_a", "s_b", "a_c"}, "value", function.resolved, {}};
  function->save(content.arrays);
  write_function_file(folder / "a.function", content);
  const MadeFunction again = make_function(read_function_file(folder / "a.function"));
  EXPECT_EQ(arrays_of(again), arrays_of(function));

  Matrix batch(x.rows(), 2);
  function->predict_batch(x, batch);
  std::vector<double> in(3), out(2), out_again(2);
  for (std::size_t i = 0; i < x.rows(); ++i) {
    x.row(i, in);
    function->predict(in, out);
    again->predict(in, out_again);
    EXPECT_EQ(out, out_again);
    for (std::size_t c = 0; c < 2; ++c) {
      EXPECT_TRUE(std::isfinite(out[c]));
      EXPECT_EQ(out[c], batch(i, c));
    }
  }
}

// No value in the box is larger than the exact maximum, and it is taken at the place that is told.
TEST_P(Approximators, ExactMaximumIsOne) {
  Matrix x(150, 2), y(150, 1);
  for (std::size_t i = 0; i < x.rows(); ++i) {
    for (std::size_t c = 0; c < 2; ++c) {
      x(i, c) = kDraws.scenario(i).uniform("x", -1, 1, static_cast<std::uint32_t>(c));
    }
    y(i, 0) = -(x(i, 1) - 0.5 * x(i, 0)) * (x(i, 1) - 0.5 * x(i, 0));
  }
  Serial serial;
  const MadeFunction function = make_example<Approximator>(GetParam())->fit({x, y, {}}, kDraws, serial);
  const Space box = {{"a", "", -1, 1}};
  for (double state : {-0.9, 0.0, 0.3}) {
    const Maximum best = function->maximize({&state, 1}, box, {.method = Maximization::Method::exact});
    ASSERT_EQ(best.at.size(), 1u);
    EXPECT_TRUE(best.at[0] >= -1 && best.at[0] <= 1);
    double value = 0;
    for (int i = 0; i <= 1000; ++i) {
      const std::array<double, 2> point = {state, -1 + i * 0.002};
      function->predict(point, {&value, 1});
      EXPECT_LE(value, best.value + 1e-12);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, Approximators, testing::ValuesIn(Catalogue::instance().names("approximator")),
                         component_name);

}  // namespace
}  // namespace coppice
