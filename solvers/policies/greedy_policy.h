#pragma once

#include "engine/vocabulary/approximator.h"
#include "engine/vocabulary/policy.h"

namespace coppice {

/// Takes the action of the largest value: argmax over a of Q(s, a) (thesis, Eq. 2.10 and Algorithm 14).
class GreedyPolicy : public Policy {
 public:
  static constexpr const char* kName = "greedy_policy";
  Sub<Function> function;  ///< Q: state axes, then action axes
  Maximization::Method maximization = Maximization::Method::merge;
  int max_leaves = 50;

  void prepare(const Spaces& spaces, const Simulator* model) override;
  void act(std::span<const double> state, std::span<double> memory, const Draws& draws,
           Action& action) const override;
  void save(Archive& archive) const override { function->save(archive); }
  void load(Archive& archive) override { function.object->load(archive); }
  std::vector<std::pair<std::string, double>> facts() const override { return function->facts(); }
  PolicyModel exported() const override;

  static Parameters<GreedyPolicy> parameters();

 private:
  std::vector<ActionBox> actions_;
};

/// Declares how the best action is looked for; T has members maximization and max_leaves.
template <class T>
Parameters<T>& declare_maximization(Parameters<T>& parameters) {
  return parameters
      .choice(
          "maximization", static_cast<Maximization::Method T::*>(&T::maximization),
          {"merge", "exact", "ascent"},
          "How the best action is found: in the forest merged into one pruned tree (Algorithm 14), exactly, "
          "or by ascent along one axis of the action after the other from several places: with several axes "
          "nearly exact and much faster than the others, with a single one exact.")
      .add("max_leaves", static_cast<int T::*>(&T::max_leaves), "",
           "Leaves of the merged tree at most (the thesis's n_max).", between(1, 100000));
}

}  // namespace coppice
