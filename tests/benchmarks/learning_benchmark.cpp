// Costs of what learning and robots do most: draws, simulated steps, fitting, the best action, a policy's
// action.
#include <benchmark/benchmark.h>

#include <cmath>

#include "engine/vocabulary/approximator.h"
#include "engine/vocabulary/problem.h"
#include "solvers/policies/fitted_policy.h"
#include "tests/support/make.h"

namespace coppice {
namespace {

const Draws kDraws(1, "benchmark", 0);
constexpr std::size_t kPoints = 4096;

/// Samples of a smooth function with a little noise, like the value of a state of two axes and an action, or
/// like the best action in a state.
struct Samples {
  Samples(std::size_t rows, std::size_t inputs) : x(rows, inputs), y(rows, 1) {
    Stream stream = kDraws.stream("samples");
    for (std::size_t i = 0; i < rows; ++i) {
      for (std::size_t d = 0; d < inputs; ++d) x(i, d) = stream.uniform(-1, 1);
      y(i, 0) = -x(i, 0) * x(i, 0) - x(i, 1) * x(i, inputs - 1) + 0.1 * stream.normal();
    }
  }
  Matrix x, y;
};

MadeFunction forest(const Samples& samples, const std::string& attributes = "") {
  Serial serial;
  return make_from_xml<Approximator>("<extra_trees " + attributes + "/>")
      ->fit({samples.x, samples.y, {}}, kDraws, serial);
}

/// States one after the other, so that no branch is learned by heart.
class States {
 public:
  explicit States(std::size_t axes) : axes_(axes) {
    Stream stream = kDraws.stream("states");
    for (std::size_t i = 0; i < kPoints * axes; ++i) values_.push_back(stream.uniform(-1, 1));
  }
  std::span<const double> next() {
    at_ = (at_ + 1) % kPoints;
    return std::span<const double>(values_).subspan(at_ * axes_, axes_);
  }

 private:
  std::size_t axes_, at_ = 0;
  std::vector<double> values_;
};

void draw_uniform(benchmark::State& state) {
  std::uint32_t step = 0;
  for (auto _ : state) benchmark::DoNotOptimize(kDraws.step(step++).uniform("noise", -1, 1));
}
BENCHMARK(draw_uniform);

/// One step of the double integrator under linear feedback, in rollouts through simulate().
void rollout_step(benchmark::State& state) {
  const auto problem = make_from_xml<Problem>("<double_integrator/>");
  const auto policy = make_from_xml<Policy>("<linear_feedback gains=\"0.687, 1.177\"/>");
  policy.object->prepare(problem->spaces(), problem->simulator());
  Serial serial;
  Simulation simulation;
  simulation.policy = policy.object.get();
  simulation.rollouts = 100;
  simulation.horizon = 200;
  double steps = 0;
  for (auto _ : state) {
    for (const int n : problem->simulator()->simulate(simulation, kDraws, serial).steps) steps += n;
  }
  using benchmark::Counter;
  state.counters["time_per_step"] = Counter(steps, Counter::kIsRate | Counter::kInvert);
}
BENCHMARK(rollout_step)->Unit(benchmark::kMillisecond);

void fit_forest(benchmark::State& state, const std::string& attributes) {
  const Samples samples(10000, 3);
  for (auto _ : state) benchmark::DoNotOptimize(forest(samples, attributes).object);
}
BENCHMARK_CAPTURE(fit_forest, 10000x3_pwc, "leaves=\"pwc\"")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(fit_forest, 10000x3_pwl, "leaves=\"pwl\"")->Unit(benchmark::kMillisecond);

/// What a robot does: an action of fitted policy forests of 25 trees, fitted to 10 000 states.
void fpf_action(benchmark::State& state, const std::string& attributes) {
  FittedPolicy policy;
  policy.function = forest(Samples(10000, 2), attributes);
  policy.prepare({{{"p", "", -1, 1}, {"v", "", -1, 1}}, {{"push", {{"a", "", -1, 1}}}}}, nullptr);
  States states(2);
  Action action;
  for (auto _ : state) {
    policy.act(states.next(), {}, kDraws, action);
    benchmark::DoNotOptimize(action);
  }
  state.counters["leaves"] = policy.facts().back().second;
}
BENCHMARK_CAPTURE(fpf_action, pwc, "leaves=\"pwc\"");
BENCHMARK_CAPTURE(fpf_action, pwl, "leaves=\"pwl\"");
BENCHMARK_CAPTURE(fpf_action, pwl_thesis, "leaves=\"pwl\" k=\"2\" n_min=\"1500\" v_min=\"1e-4\"");

/// What FQI does online, and while it learns for each sample: the best action under a forest of 25 trees.
void fqi_action(benchmark::State& state, const Maximization& how) {
  const MadeFunction q_value = forest(Samples(10000, 3));
  const Space box{{"action", "", -1, 1}};
  States states(2);
  for (auto _ : state) benchmark::DoNotOptimize(q_value->maximize(states.next(), box, how).value);
}
BENCHMARK_CAPTURE(fqi_action, merge_40_leaves, Maximization{Maximization::Method::merge, 40})
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(fqi_action, exact, Maximization{Maximization::Method::exact, 1})
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace coppice
