#include "solvers/approximators/forest_function.h"

#include "solvers/approximators/maximize.h"

namespace coppice {

Maximum ForestFunction::maximize(std::span<const double> prefix, const Space& box,
                                 const Maximization& how) const {
  return coppice::maximize(forest_, prefix, box, how);
}

void ForestFunction::predict_batch(const Matrix& x, Matrix& y) const {
  check_batch(x, y);
  forest_.predict_batch(x, y);
}

std::vector<std::pair<std::string, double>> ForestFunction::facts() const {
  return {{"trees", static_cast<double>(forest_.trees() * forest_.outputs())},
          {"leaves", static_cast<double>(forest_.leaves())}};
}

namespace {
const Component<Function, ForestFunction> kComponent(ForestFunction::kName, "The mean of regression trees.",
                                                     "L. Hofer's thesis (2017), 2.1.4", 2);
}  // namespace

}  // namespace coppice
