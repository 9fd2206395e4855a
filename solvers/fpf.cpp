#include <fmt/format.h>

#include <stdexcept>

#include "solvers/fitted_q.h"
#include "solvers/policies/fitted_policy.h"

namespace coppice {
namespace {

/// Fitted policy forests (thesis, Algorithm 15): fitted Q iteration, then a regression of the best action on
/// the state.
class Fpf : public Solver, public FittedQParameters {
 public:
  enum class States { uniform, samples };
  int policy_samples = 10000;
  States policy_states = States::uniform;
  Sub<Approximator> policy{"extra_trees",
                           {{.name = "leaves", .value = "pwl", .name_place = {}, .value_place = {}}}};

  Needs needs() const override { return {.samples = true, .single_action = true, .uses_value = true}; }
  std::vector<std::string> measures(bool value_given) const override {
    return value_given ? std::vector<std::string>() : FittedQ::measure_names();
  }
  void check(const Spaces& spaces, bool value_given) const override {
    if (!value_given) check_q_value(spaces);
  }
  std::unique_ptr<Training> start(const TrainingInputs& inputs) const override;

  static Parameters<Fpf> parameters() {
    return declare<Fpf>()
        .add("policy_samples", &Fpf::policy_samples, "", "States to fit the policy to (the thesis's M).",
             between(1, 100000000))
        .choice("policy_states", &Fpf::policy_states, {"uniform", "samples"},
                "Where these states come from: uniform in the state space, or the states of the samples, "
                "drawn with "
                "replacement.")
        .component("policy", &Fpf::policy, "Approximator of the best action in each state.");
  }
};

class FpfTraining : public Training {
 public:
  FpfTraining(const Fpf& solver, const TrainingInputs& inputs)
      : solver_(solver), inputs_(inputs), q_(solver, inputs), value_(inputs.value) {
    if (!value_) return;
    const std::size_t expected = spaces().state_size() + spaces().actions.front().axes.size();
    if (value_->inputs() != expected) {
      throw std::invalid_argument(fmt::format(
          "<fpf> needs the value of states and actions, a function of {} numbers; the given value function "
          "has {}",
          expected, value_->inputs()));
    }
  }

  bool advance(Parallel& parallel) override {
    if (policy_) return false;
    if (!value_ && !q_.done()) {
      q_.iterate(parallel);
      return true;
    }
    fit_policy(parallel);
    return false;
  }
  TrainingProgress progress() const override {
    const std::int64_t iterations = inputs_.value ? 0 : solver_.iterations;
    TrainingProgress progress{q_.iteration() + (policy_ ? 1 : 0), iterations + 1, {}};
    if (!inputs_.value) progress.measures = q_.measures();
    return progress;
  }
  void save(Archive& archive) const override { q_.save(archive); }
  /// A checkpoint after the last unit of work would hold the policy; none is made there, as nothing is left
  /// to do.
  void load(Archive& archive) override { q_.load(archive); }
  TrainingResult result() const override {
    FittedPolicy policy;
    policy.function = policy_;
    return {.policy = made<Policy>(std::move(policy), FittedPolicy::kName), .value = q_value()};
  }

 private:
  const Spaces& spaces() const { return inputs_.problem->spaces(); }
  const MadeFunction& q_value() const { return value_ ? value_ : q_.function(); }

  Matrix policy_states() const {
    const Space& axes = spaces().states;
    Matrix states(static_cast<std::size_t>(solver_.policy_samples), axes.size());
    const Draws draws = inputs_.draws.fork("policy_states");
    for (std::size_t i = 0; i < states.rows(); ++i) {
      const Draws at = draws.scenario(i);
      const std::size_t row =
          solver_.policy_states == Fpf::States::samples ? at.below("sample", inputs_.samples->rows()) : 0;
      for (std::size_t c = 0; c < axes.size(); ++c) {
        states(i, c) = solver_.policy_states == Fpf::States::samples
                           ? inputs_.samples->states(row, c)
                           : at.uniform("state", axes[c].low, axes[c].high, static_cast<std::uint32_t>(c));
      }
    }
    return states;
  }
  void fit_policy(Parallel& parallel) {
    const Matrix states = policy_states();
    const Matrix actions =
        best_actions(*q_value(), states, spaces().actions.front().axes, solver_.how(), parallel);
    policy_ = solver_.policy->fit({states, actions, {}}, inputs_.draws.fork("policy"), parallel);
  }

  const Fpf& solver_;
  const TrainingInputs inputs_;
  FittedQ q_;
  const MadeFunction value_;  ///< given; then nothing is iterated
  MadeFunction policy_;
};

std::unique_ptr<Training> Fpf::start(const TrainingInputs& inputs) const {
  return std::make_unique<FpfTraining>(*this, inputs);
}

const Component<Solver, Fpf> kFpf("fpf",
                                  "Fitted policy forests: a forest that says the best action directly.",
                                  "L. Hofer's thesis (2017), Algorithm 15", 2);

}  // namespace
}  // namespace coppice
