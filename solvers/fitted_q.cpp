#include "solvers/fitted_q.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace coppice {
namespace {

constexpr std::size_t kChunk = 64;  // samples that a thread takes at once; changes no result

/// work(row) for all rows, in chunks over threads.
template <class Work>
void for_rows(std::size_t rows, Parallel& parallel, const Work& work) {
  parallel.for_each((rows + kChunk - 1) / kChunk, [&](std::size_t chunk) {
    const std::size_t end = std::min(rows, (chunk + 1) * kChunk);
    for (std::size_t row = chunk * kChunk; row < end; ++row) work(row);
  });
}

const Dataset& usable(const TrainingInputs& inputs) {
  if (inputs.samples == nullptr || inputs.samples->rows() == 0) {
    throw std::invalid_argument("fitted Q iteration needs at least one sample");
  }
  return *inputs.samples;
}

}  // namespace

FittedQ::FittedQ(const FittedQParameters& parameters, const TrainingInputs& inputs)
    : parameters_(parameters),
      samples_(usable(inputs)),
      box_(inputs.problem->spaces().actions.front().axes),
      discount_(parameters.discount.value_or(inputs.problem->discount())),
      draws_(inputs.draws),
      x_(samples_.rows(), samples_.states.columns() + box_.size()),
      y_(samples_.rows(), 1) {
  const std::size_t states = samples_.states.columns();
  for (std::size_t c = 0; c < x_.columns(); ++c) {
    const auto from = c < states ? samples_.states.column(c) : samples_.actions.column(c - states);
    std::copy(from.begin(), from.end(), x_.column(c).begin());
  }
  for (const double x : x_.values()) {
    if (!std::isfinite(x)) throw std::invalid_argument("fitted Q iteration: a state or action is not finite");
  }
}

/// max over a of Q_{n-1}(s', a) for each sample (Algorithm 13, line 8).
std::vector<double> FittedQ::best_values(Parallel& parallel) const {
  std::vector<double> values(samples_.rows());
  for_rows(values.size(), parallel, [&](std::size_t row) {
    if (samples_.terminal[row] != 0) return;  // nothing follows
    Vec<kMaxStateSize> state;
    state.resize(samples_.next.columns());
    samples_.next.row(row, state);
    values[row] = function_->maximize(state, box_, parameters_.how()).value;
  });
  return values;
}

void FittedQ::iterate(Parallel& parallel) {
  // The first iteration's Q_0 is 0 (line 3): rewards only.
  const std::vector<double> best =
      iteration_ == 0 ? std::vector<double>(samples_.rows()) : best_values(parallel);
  double squares = 0;
  for (std::size_t i = 0; i < samples_.rows(); ++i) {
    double target = samples_.reward[i] + discount_ * best[i];
    if (parameters_.target_min) target = std::max(target, *parameters_.target_min);
    squares += (target - y_(i, 0)) * (target - y_(i, 0));
    y_(i, 0) = target;
  }
  change_ = std::sqrt(squares / static_cast<double>(samples_.rows()));
  const Draws draws = draws_.fork("iteration", static_cast<std::uint64_t>(iteration_));
  function_ = parameters_.q_value->fit({x_, y_, {}}, draws, parallel);
  ++iteration_;
}

std::vector<std::pair<std::string, double>> FittedQ::measures() const {
  double sum = 0;
  for (const double y : y_.values()) sum += y;
  return {{"mean_target", sum / static_cast<double>(y_.rows())}, {"target_change", change_}};
}

void FittedQ::save(Archive& archive) const {
  archive.put("iteration", std::vector<std::int64_t>{iteration_});
  archive.put("targets", std::vector<double>(y_.values().begin(), y_.values().end()));
  archive.put("change", std::vector<double>{change_});
  if (iteration_ == 0) return;
  const Archive::Scope scope(archive, "q_value");
  save_function(function_, archive);
}

void FittedQ::load(Archive& archive) {
  const auto& iteration = archive.get<std::vector<std::int64_t>>("iteration");
  const auto& targets = archive.get<std::vector<double>>("targets");
  const auto& change = archive.get<std::vector<double>>("change");
  if (iteration.size() != 1 || iteration[0] < 0 || iteration[0] > parameters_.iterations ||
      change.size() != 1 || targets.size() != y_.rows()) {
    throw std::runtime_error("not a checkpoint of this fitted Q iteration");
  }
  iteration_ = static_cast<int>(iteration[0]);
  std::copy(targets.begin(), targets.end(), y_.column(0).begin());
  change_ = change[0];
  if (iteration_ == 0) return;
  const Archive::Scope scope(archive, "q_value");
  function_ = load_function(archive);
}

Matrix best_actions(const Function& q_value, const Matrix& states, const Space& box, const Maximization& how,
                    Parallel& parallel) {
  Matrix actions(states.rows(), box.size());
  for_rows(states.rows(), parallel, [&](std::size_t row) {
    Vec<kMaxStateSize> state;
    state.resize(states.columns());
    states.row(row, state);
    actions.set_row(row, q_value.maximize(state, box, how).at);
  });
  return actions;
}

}  // namespace coppice
