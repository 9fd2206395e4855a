// Costs of the machine around experiments: planning ten thousand nodes, and a run of them that finds all up
// to date.
#include <benchmark/benchmark.h>

#include <stdexcept>

#include "engine/graph/run.h"
#include "tests/support/temporary_folder.h"

namespace coppice {
namespace {

/// Sweeps over 3333 points, as config text.
constexpr const char* kExperiment = R"(
<experiment coppice="1" name="scale" doc="Ten thousand nodes.">
  <problem id="plant"><double_integrator/></problem>
  <policy id="any"><random/></policy>
  <sweep id="s"><grid><param name="i" values="${range(1, 3334, 1)}"/></grid></sweep>
  <collect id="samples" over="s" problem="plant" policy="any" episodes="1" horizon="2"/>
  <fit id="model" over="s" samples="samples" inputs="s_position, a_acceleration" output="reward"><constant/></fit>
  <evaluate id="scores" over="s" problem="plant" policies="any" episodes="1" horizon="2" seed_label="${i}"/>
</experiment>)";

std::vector<Plan> plans() {
  Diagnostics diagnostics;
  const auto source = std::make_shared<const SourceFile>(SourceFile{"scale.xml", kExperiment});
  std::vector<ExperimentConfig> experiments;
  experiments.push_back(expand(source, {}, diagnostics));
  diagnostics.throw_if_any();
  return make_plans(std::move(experiments));
}

/// Reading the config included.
void plan_10000_nodes(benchmark::State& state) {
  std::size_t nodes = 0;
  for (auto _ : state) nodes = plans().front().nodes.size();
  state.counters["nodes"] = static_cast<double>(nodes);
}
BENCHMARK(plan_10000_nodes)->Unit(benchmark::kMillisecond);

/// Without planning. (All nodes are computed before the clock starts.)
void up_to_date_run_of_10000_nodes(benchmark::State& state) {
  const TemporaryFolder folder;
  const std::vector<Plan> planned = plans();
  RunOptions options;
  options.out = folder.path();
  if (run(planned, options).exit_status() != 0) throw std::runtime_error("the experiment fails");
  std::size_t up_to_date = 0;
  for (auto _ : state) up_to_date = run(planned, options).totals.up_to_date;
  state.counters["nodes"] = static_cast<double>(up_to_date);
}
BENCHMARK(up_to_date_run_of_10000_nodes)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace coppice
