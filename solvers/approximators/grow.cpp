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

}  // namespace

Forest grow_forest(const TrainingSet& set, const Growth& growth, std::size_t trees, const Draws& draws,
                   Parallel& parallel, const TreeKernels& kernels) {
  Directions directions;
  if (growth.directions > 0) directions = draw_directions(set, growth.directions, draws);
  const TrainingColumns samples(set, directions);
  Forest forest(set.x.columns(), samples.scales(), growth.leaf, std::move(directions));
  std::vector<PackedTree> grown(trees * set.y.columns());
  {
    Growers growers;
    parallel.for_each(grown.size(), [&](std::size_t i) {
      std::unique_ptr<Grower> grower = growers.take(samples, growth, kernels);
      const std::size_t output = i / trees;
      grown[i] = grower->grow(output, draws.fork("output", output).stream("tree", i % trees));
      growers.give_back(std::move(grower));
    });
  }
  std::size_t nodes = 0;
  std::size_t models = 0;
  for (const PackedTree& tree : grown) {
    nodes += tree.nodes.size();
    models += tree.models.size();
  }
  forest.reserve(grown.size(), nodes, models);
  for (PackedTree& tree : grown) {
    forest.add(tree);
    tree = {};
  }
  return forest;
}

}  // namespace coppice
