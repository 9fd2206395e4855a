#include "solvers/approximators/directions.h"

#include <cmath>

namespace coppice {
namespace {

struct Spread {
  double mean = 0;
  double deviation = 0;
};

// In two passes over the samples, in their order.
Spread spread_of(const TrainingSet& set, std::size_t column) {
  const auto x = set.x.column(column);
  const auto weight = [&](std::size_t i) { return set.weights.empty() ? 1.0 : set.weights[i]; };
  double sum = 0;
  double weights = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    sum += weight(i) * x[i];
    weights += weight(i);
  }
  Spread spread{sum / weights};
  double squares = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double difference = x[i] - spread.mean;
    squares += weight(i) * difference * difference;
  }
  spread.deviation = std::sqrt(squares / weights);
  return spread;
}

}  // namespace

Directions draw_directions(const TrainingSet& set, std::size_t size, const Draws& draws) {
  const std::size_t inputs = set.x.columns();
  std::vector<Spread> spreads(inputs);
  for (std::size_t i = 0; i < inputs; ++i) spreads[i] = spread_of(set, i);
  Directions directions(inputs);
  directions.reserve(size);
  for (std::size_t j = 0; j < size; ++j) {
    Stream stream = draws.stream("direction", j);
    double* row = directions.add();
    double squares = 0;
    for (std::size_t i = 0; i < inputs; ++i) {
      const double part = stream.normal();
      if (!(spreads[i].deviation > 0)) continue;
      row[1 + i] = part;
      squares += part * part;
    }
    const double length = std::sqrt(squares);
    for (std::size_t i = 0; i < inputs; ++i) {
      if (row[1 + i] == 0) continue;
      row[1 + i] /= length * spreads[i].deviation;
      if (!std::isfinite(row[1 + i])) row[1 + i] = 0;  // of an input that hardly varies
      row[0] -= row[1 + i] * spreads[i].mean;
    }
  }
  return directions;
}

}  // namespace coppice
