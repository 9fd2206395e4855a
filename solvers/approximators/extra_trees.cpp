#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "engine/vocabulary/elementary.h"
#include "solvers/approximators/forest_function.h"
#include "solvers/approximators/grow.h"
#include "solvers/approximators/maximize.h"

namespace coppice {
namespace {

/// What one tree and a forest of them have in common: how each tree is grown (thesis, Algorithm 6).
struct TreeParameters {
  enum class Leaves { pwc, pwl };
  Leaves leaves = Leaves::pwc;
  enum class Splits { axis, oblique };
  Splits splits = Splits::axis;
  std::optional<int> directions;
  std::optional<int> k;
  std::optional<int> n_min;
  Growth::Short too_few = Growth::Short::redraw;
  double v_min = 0;
  double margin = 0;

  /// The rules for what is left automatic are those of the thesis's own code, which its text does not give.
  Growth growth(std::size_t samples, std::size_t inputs) const {
    Growth growth;
    const bool enough = samples > inputs;  // fewer do not determine a linear model
    growth.leaf = leaves == Leaves::pwl && enough ? LeafModel::linear : LeafModel::constant;
    growth.directions = direction_count(inputs);
    growth.candidates = inputs + growth.directions;
    if (k) growth.candidates = std::min(growth.candidates, static_cast<std::size_t>(*k));
    const auto logarithm = static_cast<std::size_t>(elementary::log(static_cast<double>(samples)));
    const std::size_t few = growth.leaf == LeafModel::linear ? std::max(inputs + 1, logarithm * inputs)
                                                             : std::max<std::size_t>(1, logarithm);
    growth.min_samples = n_min ? static_cast<std::size_t>(*n_min) : few;
    growth.too_few = too_few;
    growth.min_variance = v_min;
    growth.leaf_margin = margin;
    return growth;
  }

  /// One input has no directions but itself.
  std::size_t direction_count(std::size_t inputs) const {
    if (splits == Splits::axis || inputs < 2) return 0;
    if (inputs >= kMaxTreeInputs) {
      throw std::invalid_argument(
          fmt::format("oblique splits take at most {} inputs, not {}", kMaxTreeInputs - 1, inputs));
    }
    const std::size_t most = kMaxTreeInputs - inputs;
    if (!directions) return std::min(kDirectionsPerInput * inputs, most);
    const auto count = static_cast<std::size_t>(*directions);
    if (count > most) {
      throw std::invalid_argument(
          fmt::format("directions={} are too many for {} inputs: inputs and directions "
                      "are at most {}; at most {} are valid here",
                      count, inputs, kMaxTreeInputs, most));
    }
    return count;
  }
  static constexpr std::size_t kDirectionsPerInput = 16;

  ForestKind kind(Aggregation aggregation) const {
    return {leaves == Leaves::pwl ? LeafModel::linear : LeafModel::constant, aggregation,
            splits == Splits::oblique};
  }

  void check() const {
    if (directions && splits == Splits::axis) {
      throw std::invalid_argument(
          "directions are given, but splits=\"axis\" has none; valid is splits=\"oblique\"");
    }
  }

  template <class T>
  static Parameters<T> declare() {
    return Parameters<T>()
        .choice("leaves", static_cast<Leaves T::*>(&T::leaves), {"pwc", "pwl"},
                "Models in the leaves: constant, or linear (constant when there are too few samples).")
        .automatic("k", static_cast<std::optional<int> T::*>(&T::k), "",
                   "Input dimensions (and directions) tried at each node; auto: all of them.", at_least(1))
        .automatic(
            "n_min", static_cast<std::optional<int> T::*>(&T::n_min), "",
            "Samples in a leaf at least; auto, for N samples of D inputs: max(1, floor(ln N)) for constant "
            "leaves, max(D + 1, D floor(ln N)) for linear ones.",
            at_least(1))
        .choice(
            "too_few", static_cast<Growth::Short T::*>(&T::too_few), {"redraw", "reject"},
            "What becomes of a threshold that leaves fewer than n_min samples on a side: it is drawn again "
            "(so that all allowed ones are equally likely, the thesis's rule), or its input is not split at "
            "this node (scikit-learn's).")
        .add("v_min", static_cast<double T::*>(&T::v_min), "",
             "Nodes whose outputs have no more variance are not split.", at_least(0))
        .add("margin", static_cast<double T::*>(&T::margin), "",
             "A linear leaf's prediction may leave the range of its samples' outputs by this part of it.",
             at_least(0))
        .choice("splits", static_cast<Splits T::*>(&T::splits), {"axis", "oblique"},
                "What nodes split by: an input, or also a weighted sum of inputs, from a table of random "
                "directions of the standardized inputs that all trees share.")
        .automatic(
            "directions", static_cast<std::optional<int> T::*>(&T::directions), "",
            "Directions of oblique splits; with the inputs at most 255. Auto: 16 for each input, as far "
            "as that allows.",
            between(1, kMaxTreeInputs - 1));
  }
};

MadeFunction fit_forest(const TrainingSet& set, const TreeParameters& parameters, std::size_t trees,
                        Aggregation aggregation, const Draws& draws, Parallel& parallel) {
  const auto absent = std::count(set.weights.begin(), set.weights.end(), 0.0);
  const Growth growth = parameters.growth(set.x.rows() - static_cast<std::size_t>(absent), set.x.columns());
  Forest forest = grow_forest(set, growth, trees, draws, parallel);
  forest.aggregate_by(aggregation);
  return made<Function>(ForestFunction(std::move(forest)), ForestFunction::kName);
}

/// Extremely randomized trees (thesis, Algorithms 4 to 7).
class ExtraTrees : public Approximator, public TreeParameters {
 public:
  int trees = 25;
  Aggregation aggregation = Aggregation::mean;

  MadeFunction fit(const TrainingSet& set, const Draws& draws, Parallel& parallel) const override {
    return fit_forest(set, *this, static_cast<std::size_t>(trees), aggregation, draws, parallel);
  }
  void check_maximization(const Maximization& how, std::size_t free_inputs) const override {
    coppice::check_maximization(kind(aggregation), free_inputs, how);
  }
  static Parameters<ExtraTrees> parameters() {
    return declare<ExtraTrees>()
        .add("trees", &ExtraTrees::trees, "", "Trees in the forest (the thesis's M, and m).",
             between(1, 100000))
        .choice(
            "aggregation", &ExtraTrees::aggregation, {"mean", "trimmed_mean"},
            "What the forest makes of its trees' predictions: their mean, or the mean without the lowest "
            "and the highest tenth (rounded up: 3 of 25 on each side). A trimmed mean cannot be merged into "
            "a tree; its maximum must be exact and needs constant leaves.");
  }
};

/// A single tree of the same kind.
class RegressionTree : public Approximator, public TreeParameters {
 public:
  MadeFunction fit(const TrainingSet& set, const Draws& draws, Parallel& parallel) const override {
    return fit_forest(set, *this, 1, Aggregation::mean, draws, parallel);
  }
  void check_maximization(const Maximization& how, std::size_t free_inputs) const override {
    coppice::check_maximization(kind(Aggregation::mean), free_inputs, how);
  }
  static Parameters<RegressionTree> parameters() { return declare<RegressionTree>(); }
};

const Component<Approximator, ExtraTrees> kForest(
    "extra_trees", "Forest of extremely randomized trees, with constant or linear leaves.",
    "Geurts, Ernst and Wehenkel, Machine Learning 63 (2006); L. Hofer's thesis (2017), 2.1.5", 4);
const Component<Approximator, RegressionTree> kTree("regression_tree", "A single extremely randomized tree.",
                                                    "L. Hofer's thesis (2017), Algorithm 6", 4);

}  // namespace
}  // namespace coppice
