// One call of a forest, in a chain of calls that depend on each other, beside the textbook layout; a batch.
// compare_trees.sh measures the same, and training, beside scikit-learn.
#include <benchmark/benchmark.h>

#include <array>

#include "engine/vocabulary/approximator.h"
#include "engine/vocabulary/elementary.h"
#include "solvers/approximators/forest_function.h"
#include "tests/benchmarks/textbook_forest.h"
#include "tests/support/make.h"

namespace coppice {
namespace {

const Draws kDraws(1, "trees", 0);
constexpr std::size_t kPoints = 20000;

/// The first terms of Friedman's function 1, with noise of deviation 1.
MadeFunction fitted(std::size_t rows, const std::string& xml) {
  Matrix x(rows, 3);
  Matrix y(rows, 1);
  Stream stream = kDraws.stream("samples");
  for (std::size_t i = 0; i < rows; ++i) {
    for (std::size_t c = 0; c < 3; ++c) x(i, c) = stream.uniform(0, 1);
    y(i, 0) = 10 * elementary::sin(3.14159265358979 * x(i, 0) * x(i, 1)) +
              20 * (x(i, 2) - 0.5) * (x(i, 2) - 0.5) + stream.normal();
  }
  Serial serial;
  return make_from_xml<Approximator>(xml)->fit({x, y, {}}, kDraws, serial);
}

const Forest& forest_of(const MadeFunction& function) {
  return static_cast<const ForestFunction&>(*function.object).forest();
}

template <class Predict>
void chain(benchmark::State& state, const Predict& predict) {
  std::vector<std::array<double, 3>> points(kPoints);
  Stream stream = kDraws.stream("points");
  for (auto& point : points) point = {stream.uniform(0, 1), stream.uniform(0, 1), stream.uniform(0, 1)};
  double last = 0;
  std::size_t i = 0;
  for (auto _ : state) {
    std::array<double, 3> point = points[i];
    i = i + 1 < kPoints ? i + 1 : 0;
    point[0] += 0 * last;
    benchmark::DoNotOptimize(last = predict(std::span<const double>(point)));
  }
}

void one_call(benchmark::State& state, std::size_t rows, const std::string& xml) {
  const MadeFunction function = fitted(rows, xml);
  chain(state, [&](std::span<const double> x) {
    double y = 0;
    function->predict(x, {&y, 1});
    return y;
  });
  state.counters["leaves"] = static_cast<double>(forest_of(function).leaves());
}

void textbook_call(benchmark::State& state, std::size_t rows, const std::string& xml) {
  const TextbookForest forest(forest_of(fitted(rows, xml)));
  chain(state, [&](std::span<const double> x) { return forest.predict(x); });
}

void batch(benchmark::State& state, std::size_t rows, const std::string& xml) {
  const MadeFunction function = fitted(rows, xml);
  Matrix x(kPoints, 3);
  Matrix y(kPoints, 1);
  Stream stream = kDraws.stream("points");
  for (double& value : x.values()) value = stream.uniform(0, 1);
  for (auto _ : state) function->predict_batch(x, y);
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * kPoints));
}

const std::string kLeavesOf50 = "<extra_trees n_min=\"50\" too_few=\"reject\"/>";
const std::string kLeavesOf10 = "<extra_trees n_min=\"10\" too_few=\"reject\"/>";
BENCHMARK_CAPTURE(one_call, 25x116, 10000, kLeavesOf50);
BENCHMARK_CAPTURE(textbook_call, 25x116, 10000, kLeavesOf50);
BENCHMARK_CAPTURE(one_call, 25x600, 10000, kLeavesOf10);
BENCHMARK_CAPTURE(textbook_call, 25x600, 10000, kLeavesOf10);
BENCHMARK_CAPTURE(one_call, 25x6000, 100000, kLeavesOf10);
BENCHMARK_CAPTURE(textbook_call, 25x6000, 100000, kLeavesOf10);
BENCHMARK_CAPTURE(one_call, 25x150_linear, 10000, "<extra_trees leaves=\"pwl\" n_min=\"50\"/>");
BENCHMARK_CAPTURE(one_call, one_tree, 10000, "<regression_tree n_min=\"2\"/>");
BENCHMARK_CAPTURE(batch, 25x600, 10000, kLeavesOf10);
BENCHMARK_CAPTURE(batch, 25x600_trimmed, 10000,
                  "<extra_trees n_min=\"10\" too_few=\"reject\" aggregation=\"trimmed_mean\"/>");
BENCHMARK_CAPTURE(one_call, 25x600_trimmed, 10000,
                  "<extra_trees n_min=\"10\" too_few=\"reject\" aggregation=\"trimmed_mean\"/>");

}  // namespace
}  // namespace coppice
