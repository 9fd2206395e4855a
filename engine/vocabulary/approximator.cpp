#include "engine/vocabulary/approximator.h"

#include <stdexcept>

namespace coppice {

void Function::check_batch(const Matrix& x, const Matrix& y) const {
  if (x.columns() != inputs() || y.columns() != outputs() || x.rows() != y.rows()) {
    throw std::logic_error("predict_batch: the tables do not fit the function");
  }
}

void Function::predict_batch(const Matrix& x, Matrix& y) const {
  check_batch(x, y);
  std::vector<double> in(inputs());
  std::vector<double> out(outputs());
  for (std::size_t i = 0; i < x.rows(); ++i) {
    x.row(i, in);
    predict(in, out);
    y.set_row(i, out);
  }
}

FunctionModel Function::exported() const {
  throw std::invalid_argument("is made of a function that is no constant, linear function or forest");
}

void save_function(const MadeFunction& function, Archive& archive) {
  archive.put("component", to_xml(function.resolved));
  const Archive::Scope scope(archive, "arrays");
  function->save(archive);
}

MadeFunction load_function(Archive& archive) {
  const auto source =
      std::make_shared<const SourceFile>(SourceFile{"", archive.get<std::string>("component")});
  MadeFunction function;
  try {
    Diagnostics diagnostics;
    function = make<Function>(parse_xml(source), diagnostics);
    diagnostics.throw_if_any();
  } catch (const ConfigError& error) {
    throw std::runtime_error(std::string("no function can be made of this archive: ") + error.what());
  }
  const Archive::Scope scope(archive, "arrays");
  function.object->load(archive);
  return function;
}

}  // namespace coppice
