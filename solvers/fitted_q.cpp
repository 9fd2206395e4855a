#include "solvers/fitted_q.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "solvers/for_rows.h"
#include "solvers/transition_model.h"

namespace coppice {
namespace {

void refuse_non_finite(std::span<const double> values, const char* what) {
  for (const double value : values) {
    if (std::isfinite(value)) continue;
    throw std::invalid_argument(fmt::format("fitted Q iteration: {} of the samples is not finite", what));
  }
}

const Dataset& usable(const TrainingInputs& inputs) {
  if (inputs.samples == nullptr || inputs.samples->rows() == 0) {
    throw std::invalid_argument("fitted Q iteration needs at least one sample");
  }
  refuse_non_finite(inputs.samples->states.values(), "a state");
  refuse_non_finite(inputs.samples->actions.values(), "an action");
  refuse_non_finite(inputs.samples->reward, "a reward");
  refuse_non_finite(inputs.samples->next.values(), "a next state");
  return *inputs.samples;
}

/// A row for each sample: its state, then its action.
Matrix states_and_actions(const Dataset& samples) {
  const std::size_t states = samples.states.columns();
  Matrix x(samples.rows(), states + samples.actions.columns());
  for (std::size_t c = 0; c < x.columns(); ++c) {
    const auto from = c < states ? samples.states.column(c) : samples.actions.column(c - states);
    std::copy(from.begin(), from.end(), x.column(c).begin());
  }
  return x;
}

}  // namespace

FittedQ::FittedQ(const FittedQParameters& parameters, const TrainingInputs& inputs)
    : parameters_(parameters),
      given_(usable(inputs)),
      box_(inputs.problem->spaces().actions.front().axes),
      discount_(parameters.discount.value_or(inputs.problem->discount())),
      draws_(inputs.draws),
      y_(parameters.model_samples > 0 ? static_cast<std::size_t>(parameters.model_samples) : given_.rows(),
         1) {}

/// What is iterated on. Made when it is first needed, also after a restart, as a checkpoint does not hold it.
void FittedQ::prepare(Parallel& parallel) {
  if (samples_ != nullptr) return;
  if (parameters_.model_samples > 0) {
    modelled_ = model_transitions(given_, *parameters_.model, y_.rows(), draws_.fork("model"), parallel);
  }
  samples_ = parameters_.model_samples > 0 ? &modelled_ : &given_;
  x_ = states_and_actions(*samples_);
}

/// max over a of Q_{n-1}(s', a) for each sample (Algorithm 13, line 8).
std::vector<double> FittedQ::best_values(Parallel& parallel) const {
  std::vector<double> values(samples_->rows());
  for_rows(values.size(), parallel, [&](std::size_t row) {
    if (samples_->terminal[row] != 0) return;  // nothing follows
    Vec<kMaxStateSize> state;
    state.resize(samples_->next.columns());
    samples_->next.row(row, state);
    values[row] = function_->maximize(state, box_, parameters_.how()).value;
  });
  return values;
}

void FittedQ::iterate(Parallel& parallel) {
  prepare(parallel);
  // The first iteration's Q_0 is 0 (line 3): rewards only.
  const std::vector<double> best =
      iteration_ == 0 ? std::vector<double>(samples_->rows()) : best_values(parallel);
  double squares = 0;
  for (std::size_t i = 0; i < samples_->rows(); ++i) {
    double target = samples_->reward[i] + discount_ * best[i];
    if (parameters_.target_min) target = std::max(target, *parameters_.target_min);
    squares += (target - y_(i, 0)) * (target - y_(i, 0));
    y_(i, 0) = target;
  }
  change_ = std::sqrt(squares / static_cast<double>(samples_->rows()));
  const Draws draws = draws_.fork("iteration", static_cast<std::uint64_t>(iteration_));
  function_ = parameters_.q_value->fit({x_, y_, {}}, draws, parallel);
  ++iteration_;
}

std::vector<std::pair<std::string, double>> FittedQ::measures() const {
  double sum = 0;
  for (const double y : y_.values()) sum += y;
  const std::vector<std::string> names = measure_names();
  return {{names[0], sum / static_cast<double>(y_.rows())}, {names[1], change_}};
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
