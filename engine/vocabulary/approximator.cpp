#include "engine/vocabulary/approximator.h"

#include <stdexcept>

namespace coppice {

void Function::predict_batch(const Matrix& x, Matrix& y) const {
  if (x.columns() != inputs() || y.columns() != outputs() || x.rows() != y.rows()) {
    throw std::logic_error("predict_batch: the tables do not fit the function");
  }
  std::vector<double> in(inputs());
  std::vector<double> out(outputs());
  for (std::size_t i = 0; i < x.rows(); ++i) {
    x.row(i, in);
    predict(in, out);
    y.set_row(i, out);
  }
}

}  // namespace coppice
