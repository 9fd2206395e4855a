#pragma once

#include <optional>
#include <vector>

#include "engine/vocabulary/solver.h"
#include "solvers/policies/greedy_policy.h"

namespace coppice {

/// Parameters of fitted Q iteration; base of the solvers that begin with it.
struct FittedQParameters {
  int iterations = 10;
  std::optional<double> discount;
  std::optional<double> target_min;
  int model_samples = 0;
  Sub<Approximator> model{"extra_trees",
                          {{"leaves", "pwl", {}, {}}, {"n_min", "5", {}, {}}, {"margin", "0.5", {}, {}}}};
  Sub<Approximator> q_value{"extra_trees"};
  Maximization::Method maximization = Maximization::Method::merge;
  int max_leaves = 50;

  Maximization how() const { return {maximization, max_leaves}; }
  /// As Solver::check, where Q is learned.
  void check_q_value(const Spaces& spaces) const {
    q_value->check_maximization(how(), spaces.actions.front().axes.size());
  }

  template <class T>
  static Parameters<T> declare() {
    Parameters<T> parameters;
    parameters
        .add("iterations", static_cast<int T::*>(&T::iterations), "", "Iterations of Q (the thesis's N).",
             between(1, 1000000))
        .automatic("discount", static_cast<std::optional<double> T::*>(&T::discount), "",
                   "Discount of a step; auto: the problem's.", between(0, 1))
        .automatic("target_min", static_cast<std::optional<double> T::*>(&T::target_min), "",
                   "Targets below are raised to it, so that a rare large penalty does not spread over its "
                   "neighbours; auto: no limit, as in the thesis.")
        .add("model_samples", static_cast<int T::*>(&T::model_samples), "",
             "Iterate on this many transitions of a model of the problem that is fitted to the samples, from "
             "states and actions drawn uniformly; 0: on the samples themselves, as in the thesis. For few "
             "samples of a problem with little noise, as the model holds the mean only.",
             between(0, 100000000))
        .component(
            "model", static_cast<Sub<Approximator> T::*>(&T::model),
            "Approximator of that model: of the change of state and the reward by state and action, and "
            "of the end of an episode by the next state.")
        .component(
            "q_value", static_cast<Sub<Approximator> T::*>(&T::q_value),
            "Approximator of the value of states and actions; constant leaves, as linear ones may diverge.");
    return declare_maximization(parameters);
  }
};

/// Fitted Q iteration (Ernst, Geurts and Wehenkel 2005; thesis, Algorithm 13), one iteration at a time.
class FittedQ {
 public:
  /// Throws std::invalid_argument when the samples cannot be used.
  FittedQ(const FittedQParameters& parameters, const TrainingInputs& inputs);

  bool done() const { return iteration_ >= parameters_.iterations; }
  void iterate(Parallel& parallel);

  int iteration() const { return iteration_; }
  const MadeFunction& function() const { return function_; }
  std::vector<std::pair<std::string, double>> measures() const;
  static std::vector<std::string> measure_names() { return {"mean_target", "target_change"}; }
  void save(Archive& archive) const;
  void load(Archive& archive);

 private:
  void prepare(Parallel& parallel);
  std::vector<double> best_values(Parallel& parallel) const;

  const FittedQParameters parameters_;
  const Dataset& given_;
  Dataset modelled_;
  const Dataset* samples_ = nullptr;  ///< one of the two; null before the first iteration
  const Space box_;                   ///< of the action
  const double discount_;
  const Draws draws_;
  Matrix x_;  ///< states, then actions
  Matrix y_;  ///< targets of the last iteration
  int iteration_ = 0;
  double change_ = 0;  ///< root mean square of the targets' last change
  MadeFunction function_;
};

/// The action in `box` of the largest value in each state (rows x action axes; Algorithm 14).
Matrix best_actions(const Function& q_value, const Matrix& states, const Space& box, const Maximization& how,
                    Parallel& parallel);

}  // namespace coppice
