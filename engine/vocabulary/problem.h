#pragma once

#include <concepts>
#include <memory>
#include <span>
#include <vector>

#include "engine/vocabulary/rollout.h"
#include "engine/vocabulary/space.h"
#include "registry/component.h"

namespace coppice {

/// What one step gives. `next` of a terminal transition is the state where it ended.
template <class State>
struct Transition {
  State next;
  double reward = 0;
  bool terminal = false;
};

/// The action as a model sees it.
struct ActionRef {
  int id;
  std::span<const double> values;
  double operator[](std::size_t i) const { return values[i]; }
};

/// A model that can be set to any state and stepped. Thread-safe; all randomness comes in by draws.
class Simulator {
 public:
  virtual ~Simulator() = default;
  /// The start state of the draws' scenario.
  virtual void start(const Draws& draws, std::span<double> state) const = 0;
  /// One step; `next` may not alias `state`. `draws` are those of a scenario and a step.
  virtual void step(std::span<const double> state, const Action& action, const Draws& draws,
                    std::span<double> next, double& reward, bool& terminal) const = 0;
  /// The one place that knows what a rollout and a discounted return are. Whole batches; no allocation and no
  /// virtual call of the model per step. Result i depends on the simulation and the draws' family, not on the
  /// threads.
  virtual Returns simulate(const Simulation& simulation, const Draws& draws, Parallel& parallel) const = 0;
};

/// A Markov decision process, as solvers and evaluations see it. Immutable.
class Problem {
 public:
  static constexpr const char* kInterface = "problem";
  virtual ~Problem() = default;

  virtual const Spaces& spaces() const = 0;
  /// Used where a node gives none.
  virtual double discount() const = 0;
  virtual int horizon() const = 0;
  /// Episodes from the problem's own starts: all that a live system offers. starts and first_actions are not
  /// allowed.
  virtual Returns episodes(const Simulation& simulation, const Draws& draws, Parallel& parallel) const = 0;
  /// Null for problems that only offer episodes (a live robot, a remote simulator).
  virtual const Simulator* simulator() const { return nullptr; }
};

/// A plain struct that is a problem. Besides these it may have `double discount` and `int horizon` members,
/// or functions of these names (defaults: 1 and 100).
template <class M>
concept Model = requires(const M& model, const typename M::State& state, ActionRef action,
                         const Draws& draws) {
  { model.states() } -> std::convertible_to<Space>;
  { model.actions() } -> std::convertible_to<std::vector<ActionBox>>;
  { model.start(draws) } -> std::convertible_to<typename M::State>;
  { model.step(state, action, draws) } -> std::convertible_to<Transition<typename M::State>>;
};

/// Makes a Problem of a plain struct.
template <Model M>
class ModelProblem;

template <>
struct Adapter<Problem> {
  template <Model M>
  static std::shared_ptr<Problem> make(M model, std::string name) {
    return std::make_shared<ModelProblem<M>>(std::move(model), std::move(name));
  }
};

}  // namespace coppice

#include "engine/vocabulary/model_problem.h"  // IWYU pragma: export
