// Costs of what learning and robots do most: draws, simulated steps, fitting, the best action, a policy's
// action.
#include <benchmark/benchmark.h>

#include "engine/vocabulary/approximator.h"
#include "engine/vocabulary/problem.h"
#include "registry/component.h"

namespace coppice {
namespace {

template <class Interface>
Sub<Interface> component(const std::string& name,
                         const std::vector<std::pair<std::string, std::string>>& values = {}) {
  Element element;
  element.name = name;
  for (const auto& [attribute, value] : values) element.set(attribute, value);
  Diagnostics diagnostics;
  Sub<Interface> made = make<Interface>(element, diagnostics);
  diagnostics.throw_if_any();
  return made;
}

/// Samples of a smooth function of three inputs, like a value function of two states and an action.
struct Samples {
  explicit Samples(std::size_t rows) : x(rows, 3), y(rows, 1) {
    Stream stream = Draws(1, "benchmark", 0).stream("samples");
    for (std::size_t i = 0; i < rows; ++i) {
      for (std::size_t d = 0; d < 3; ++d) x(i, d) = stream.uniform(-1, 1);
      y(i, 0) = -x(i, 0) * x(i, 0) - x(i, 1) * x(i, 2) + 0.1 * stream.normal();
    }
  }
  Matrix x, y;
};

MadeFunction forest(const Samples& samples) {
  Serial serial;
  return component<Approximator>("extra_trees")
      ->fit({samples.x, samples.y, {}}, Draws(1, "benchmark", 0), serial);
}

void draw_uniform(benchmark::State& state) {
  const Draws draws(1, "benchmark", 0);
  std::uint32_t step = 0;
  for (auto _ : state) benchmark::DoNotOptimize(draws.step(step++).uniform("noise", -1, 1));
}
BENCHMARK(draw_uniform);

void simulated_steps(benchmark::State& state) {
  const auto problem = component<Problem>("double_integrator");
  auto policy = component<Policy>("linear_feedback", {{"gains", "0.687, 1.177"}});
  policy.object->prepare(problem->spaces(), problem->simulator());
  Serial serial;
  Simulation simulation;
  simulation.policy = policy.object.get();
  simulation.rollouts = 100;
  simulation.horizon = 200;
  std::int64_t steps = 0;
  for (auto _ : state) {
    for (const int n : problem->episodes(simulation, Draws(1, "benchmark", 0), serial).steps) steps += n;
  }
  state.SetItemsProcessed(steps);
}
BENCHMARK(simulated_steps)->Unit(benchmark::kMillisecond);

void fit_forest(benchmark::State& state) {
  const Samples samples(static_cast<std::size_t>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(forest(samples).object);
}
BENCHMARK(fit_forest)->Arg(1000)->Arg(10000)->Unit(benchmark::kMillisecond);

void predict_forest(benchmark::State& state) {
  const Samples samples(10000);
  const MadeFunction function = forest(samples);
  std::vector<double> x(3), y(1);
  std::size_t row = 0;
  for (auto _ : state) {
    samples.x.row(row++ % samples.x.rows(), x);
    function->predict(x, y);
    benchmark::DoNotOptimize(y[0]);
  }
}
BENCHMARK(predict_forest);

void best_action(benchmark::State& state) {
  const Samples samples(10000);
  const MadeFunction function = forest(samples);
  const Space box{{"action", "", -1, 1}};
  const Maximization how{static_cast<Maximization::Method>(state.range(0)), 40};
  std::vector<double> x(3);
  std::size_t row = 0;
  for (auto _ : state) {
    samples.x.row(row++ % samples.x.rows(), x);
    benchmark::DoNotOptimize(function->maximize(std::span(x).first(2), box, how).value);
  }
}
BENCHMARK(best_action)->ArgName("exact")->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace coppice

BENCHMARK_MAIN();
