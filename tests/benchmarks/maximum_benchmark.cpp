// The best action under a forest of 25 trees: its cost by each method, and what its value misses of the
// forest's true maximum, which branch and bound finds.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>

#include "engine/vocabulary/approximator.h"
#include "tests/support/make.h"

namespace coppice {
namespace {

const Draws kDraws(1, "maximum", 0);
constexpr std::size_t kStates = 512;

enum class Value { smooth, friedman };

/// Of states and actions in the unit cube, with noise. Smooth: 10 less the squared distance of the action
/// from what is best in the state. Friedman: his first function, of which the actions are the first inputs.
double value_of(Value kind, std::span<const double> x, std::size_t states) {
  const auto z = [&](std::size_t i) { return i < x.size() ? x[x.size() - 1 - i] : 0.0; };
  if (kind == Value::friedman) {
    return 10 * std::sin(3.141592653589793 * z(0) * z(1)) + 20 * (z(2) - 0.5) * (z(2) - 0.5) + 10 * z(3) +
           5 * z(4);
  }
  double value = 10;
  for (std::size_t a = states; a < x.size(); ++a) {
    const double error = x[a] - 0.5 * (x[a % states] + std::sin(3 * x[(a + 1) % states]));
    value -= 10 * error * error;
  }
  return value;
}

struct QSamples {
  QSamples(Value kind, std::size_t rows, std::size_t states, std::size_t actions)
      : x(rows, states + actions), y(rows, 1) {
    Stream stream = kDraws.stream("samples");
    std::vector<double> row(states + actions);
    for (std::size_t i = 0; i < rows; ++i) {
      for (double& value : row) value = stream.uniform(0, 1);
      x.set_row(i, row);
      y(i, 0) = value_of(kind, row, states) + stream.normal();
    }
  }
  Matrix x, y;
};

void best_action(benchmark::State& state, Value kind, std::size_t states, std::size_t actions,
                 const std::string& attributes, const Maximization& how) {
  const QSamples samples(kind, 10000, states, actions);
  Serial serial;
  const MadeFunction q_value = make_from_xml<Approximator>("<extra_trees " + attributes + "/>")
                                   ->fit({samples.x, samples.y, {}}, kDraws, serial);
  const Space box(actions, {"action", "", 0, 1});
  Stream stream = kDraws.stream("states");
  std::vector<double> at(kStates * states);
  for (double& value : at) value = stream.uniform(0, 1);
  const auto prefix = [&](std::size_t i) {
    return std::span<const double>(at).subspan(i % kStates * states, states);
  };
  std::size_t next = 0;
  for (auto _ : state) benchmark::DoNotOptimize(q_value->maximize(prefix(next++), box, how).value);
  double missed = 0, most = 0, value = 0;
  for (std::size_t i = 0; i < 64; ++i) {
    std::vector<double> x(prefix(i).begin(), prefix(i).end());
    const Maximum chosen = q_value->maximize(x, box, how);
    const double best = q_value->maximize(x, box, {Maximization::Method::exact, 1}).value;
    x.insert(x.end(), chosen.at.begin(), chosen.at.end());
    double taken = 0;
    q_value->predict(x, {&taken, 1});
    missed += (best - taken) / std::fabs(best) / 64;
    most = std::max(most, (best - taken) / std::fabs(best));
    value += taken / 64;
  }
  state.counters["lost_percent"] = 100 * missed;
  state.counters["lost_most_percent"] = 100 * most;
  state.counters["value"] = value;
}

constexpr Maximization kExact{Maximization::Method::exact, 1};
constexpr Maximization kAscent{Maximization::Method::ascent, 1};
constexpr Maximization kMerge{Maximization::Method::merge, 50};
#define BEST_ACTION(name, kind, states, actions, attributes)                                \
  BENCHMARK_CAPTURE(best_action, name##_merge, kind, states, actions, attributes, kMerge)   \
      ->Unit(benchmark::kMicrosecond);                                                      \
  BENCHMARK_CAPTURE(best_action, name##_exact, kind, states, actions, attributes, kExact)   \
      ->Unit(benchmark::kMicrosecond);                                                      \
  BENCHMARK_CAPTURE(best_action, name##_ascent, kind, states, actions, attributes, kAscent) \
      ->Unit(benchmark::kMicrosecond)

BEST_ACTION(smooth_2x1_pwc_10, Value::smooth, 2, 1, "n_min=\"10\"");
BEST_ACTION(friedman_2x1_pwc_10, Value::friedman, 2, 1, "n_min=\"10\"");
BEST_ACTION(smooth_2x1_pwc_2, Value::smooth, 2, 1, "n_min=\"2\"");
BEST_ACTION(smooth_2x1_pwl_50, Value::smooth, 2, 1, "leaves=\"pwl\" n_min=\"50\"");
BEST_ACTION(friedman_2x1_pwl_50, Value::friedman, 2, 1, "leaves=\"pwl\" n_min=\"50\"");
BEST_ACTION(smooth_6x3_pwc_10, Value::smooth, 6, 3, "n_min=\"10\"");
BEST_ACTION(friedman_6x3_pwc_10, Value::friedman, 6, 3, "n_min=\"10\"");
BEST_ACTION(smooth_6x3_pwl_99, Value::smooth, 6, 3, "leaves=\"pwl\" n_min=\"99\"");
BEST_ACTION(friedman_6x3_pwl_99, Value::friedman, 6, 3, "leaves=\"pwl\" n_min=\"99\"");

}  // namespace
}  // namespace coppice
