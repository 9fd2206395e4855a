#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/vocabulary/archive.h"
#include "engine/vocabulary/matrix.h"
#include "engine/vocabulary/parallel.h"
#include "engine/vocabulary/policy_model.h"
#include "engine/vocabulary/random.h"
#include "engine/vocabulary/space.h"
#include "registry/component.h"

namespace coppice {

/// How to look for the largest value of a function over a box of its last inputs.
struct Maximization {
  enum class Method {
    merge,  ///< the thesis's: projection, merge with pruning to `leaves`, best leaf (Algorithm 14)
    exact,  ///< the true maximum of the function
    ascent  ///< of forests the best of several local maxima, over one axis exact
  };
  Method method = Method::merge;
  int leaves = 50;
};

/// A place in the box and the function's (for `merge`: the merged tree's) value there.
struct Maximum {
  Vec<kMaxActionSize> at;
  double value = 0;
};

/// A trained approximator: a function from R^inputs to R^outputs. Immutable once built; safe to share.
class Function {
 public:
  static constexpr const char* kInterface = "function";
  virtual ~Function() = default;

  virtual std::size_t inputs() const = 0;
  virtual std::size_t outputs() const = 0;
  /// y has outputs() items. Does not allocate.
  virtual void predict(std::span<const double> x, std::span<double> y) const = 0;
  /// Rows of x to rows of y (x.rows() x outputs()). The default calls predict for each row.
  virtual void predict_batch(const Matrix& x, Matrix& y) const;
  /// The largest value of output 0 over `box` for the last inputs, the first ones fixed to `prefix`
  /// (prefix.size() + box.size() == inputs()).
  virtual Maximum maximize(std::span<const double> prefix, const Space& box,
                           const Maximization& how) const = 0;

  virtual void save(Archive&) const = 0;
  virtual void load(Archive&) = 0;  ///< throws std::runtime_error for arrays that make no valid function

  /// What people want to know of it: names and numbers ("leaves", 812; "depth", 14).
  virtual std::vector<std::pair<std::string, double>> facts() const { return {}; }

  /// What predict() computes, for exports. Throws as Policy::exported.
  virtual FunctionModel exported() const;

 protected:
  /// Throws std::logic_error when predict_batch is given tables of other sizes than the function's.
  void check_batch(const Matrix& x, const Matrix& y) const;
};
using MadeFunction = Sub<Function>;

/// A function together with its component, below the archive's current names.
void save_function(const MadeFunction& function, Archive& archive);
/// Throws std::runtime_error for what save_function did not write.
MadeFunction load_function(Archive& archive);

/// Supervised samples: row i of x belongs to row i of y.
struct TrainingSet {
  const Matrix& x;                  ///< samples x inputs
  const Matrix& y;                  ///< samples x outputs
  std::span<const double> weights;  ///< empty: all 1
};

/// Fits functions to samples. Immutable.
class Approximator {
 public:
  static constexpr const char* kInterface = "approximator";
  virtual ~Approximator() = default;
  /// Same set and draws give the same function for any width of `parallel`. The set has at least one row, and
  /// is finite; the caller checks.
  virtual MadeFunction fit(const TrainingSet& set, const Draws& draws, Parallel& parallel) const = 0;
  /// Throws std::invalid_argument when the functions that it fits cannot be maximized so over that many of
  /// their inputs, of which they have more; to be known before anything is fitted.
  virtual void check_maximization(const Maximization&, std::size_t /*free_inputs*/) const {}
};

}  // namespace coppice
