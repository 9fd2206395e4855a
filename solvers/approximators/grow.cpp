#include "solvers/approximators/grow.h"

#include <memory>
#include <mutex>
#include <vector>

#include "solvers/approximators/grower.h"

namespace coppice {
namespace {

/// Growers that wait for their next tree: as many as trees grow at once.
class Growers {
 public:
  template <class... Arguments>
  std::unique_ptr<Grower> take(const Arguments&... arguments) {
    {
      const std::lock_guard<std::mutex> lock(guard_);
      if (!idle_.empty()) {
        std::unique_ptr<Grower> grower = std::move(idle_.back());
        idle_.pop_back();
        return grower;
      }
    }
    return std::make_unique<Grower>(arguments...);
  }
  void give_back(std::unique_ptr<Grower> grower) {
    const std::lock_guard<std::mutex> lock(guard_);
    idle_.push_back(std::move(grower));
  }

 private:
  std::mutex guard_;
  std::vector<std::unique_ptr<Grower>> idle_;
};

/// Puts trees into a forest in their order, in whichever order they come. Those that come in order, as all do
/// with one thread, are copied once.
class InOrder {
 public:
  InOrder(Forest& forest, std::size_t trees) : forest_(forest), early_(trees) {}

  void add(std::size_t i, const PackedTree& tree) {
    const std::lock_guard<std::mutex> lock(guard_);
    if (i != next_) {
      early_[i] = tree;
      return;
    }
    if (i == 0) forest_.reserve(early_.size(), room(tree.nodes.size()), room(tree.models.size()));
    forest_.add(tree);
    for (++next_; next_ < early_.size() && !early_[next_].nodes.empty(); ++next_) {
      forest_.add(early_[next_]);
      early_[next_] = {};
    }
  }

 private:
  // For all trees, by the first.
  std::size_t room(std::size_t first) const { return (first + first / 16) * early_.size(); }

  std::mutex guard_;
  Forest& forest_;
  std::size_t next_ = 0;
  std::vector<PackedTree> early_;
};

}  // namespace

Forest grow_forest(const TrainingSet& set, const Growth& growth, std::size_t trees, const Draws& draws,
                   Parallel& parallel, const TreeKernels& kernels) {
  Directions directions;
  if (growth.directions > 0) directions = draw_directions(set, growth.directions, draws);
  const TrainingColumns samples(set, directions);
  Forest forest(set.x.columns(), samples.scales(), growth.leaf, std::move(directions));
  const std::size_t count = trees * set.y.columns();
  Growers growers;
  InOrder grown(forest, count);
  parallel.for_each(count, [&](std::size_t i) {
    std::unique_ptr<Grower> grower = growers.take(samples, growth, kernels);
    const std::size_t output = i / trees;
    grown.add(i, grower->grow(output, draws.fork("output", output).stream("tree", i % trees)));
    growers.give_back(std::move(grower));
  });
  return forest;
}

}  // namespace coppice
