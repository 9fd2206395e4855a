#include "solvers/fitted_q.h"

namespace coppice {
namespace {

class Fqi : public Solver, public FittedQParameters {
 public:
  Needs needs() const override { return {.samples = true, .simulator = false, .single_action = true}; }
  std::vector<std::string> measures(bool) const override { return FittedQ::measure_names(); }
  void check(const Spaces& spaces, bool) const override { check_q_value(spaces); }
  std::unique_ptr<Training> start(const TrainingInputs& inputs) const override;
  static Parameters<Fqi> parameters() { return declare<Fqi>(); }
};

class FqiTraining : public Training {
 public:
  FqiTraining(const Fqi& solver, const TrainingInputs& inputs) : solver_(solver), q_(solver, inputs) {}

  bool advance(Parallel& parallel) override {
    if (!q_.done()) q_.iterate(parallel);
    return !q_.done();
  }
  TrainingProgress progress() const override { return {q_.iteration(), solver_.iterations, q_.measures()}; }
  void save(Archive& archive) const override { q_.save(archive); }
  void load(Archive& archive) override { q_.load(archive); }
  TrainingResult result() const override {
    GreedyPolicy policy;
    policy.function = q_.function();
    policy.maximization = solver_.maximization;
    policy.max_leaves = solver_.max_leaves;
    return {.policy = made<Policy>(std::move(policy), GreedyPolicy::kName), .value = q_.function()};
  }

 private:
  const Fqi& solver_;
  FittedQ q_;
};

std::unique_ptr<Training> Fqi::start(const TrainingInputs& inputs) const {
  return std::make_unique<FqiTraining>(*this, inputs);
}

const Component<Solver, Fqi> kFqi(
    "fqi", "Fitted Q iteration; its policy looks for the best action in each state.",
    "Ernst, Geurts and Wehenkel, JMLR 6 (2005); L. Hofer's thesis (2017), Algorithms 13 and 14", 2);

}  // namespace
}  // namespace coppice
