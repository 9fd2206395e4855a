#pragma once

#include <fmt/format.h>

#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "engine/vocabulary/random.h"
#include "problems/objectives/noisy_function.h"

namespace coppice {

/// Where a test function's optimum lies and how its axes are turned: z = R (x - optimum).
class Frame {
 public:
  enum class Axes { straight, turned };
  /// The optimum is drawn uniformly in [-spread, spread]^n, R uniformly among the orthogonal matrices.
  Frame(std::size_t n, double spread, Axes axes, const Draws& draws);

  std::size_t size() const { return optimum_.size(); }
  double z(std::span<const double> x, std::size_t i) const;
  std::span<const double> optimum() const { return optimum_; }
  std::span<const double> row(std::size_t i) const { return {&rotation_[i * size()], size()}; }

 private:
  std::vector<double> optimum_;
  std::vector<double> rotation_;  ///< by rows; empty: none
};

/// condition^(i / (n - 1)): the weights of the squares of an ellipsoid.
std::vector<double> ellipsoid_weights(std::size_t n, double condition);

/// Minus a loss that is least, 0, at z = 0. `loss` takes something with size() and [i]; the box is all of
/// R^n.
template <class Loss>
class PlacedFunction : public NoisyFunction {
 public:
  PlacedFunction(Frame frame, double noise, Loss loss)
      : NoisyFunction(noise), frame_(std::move(frame)), loss_(std::move(loss)) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < frame_.size(); ++i) {
      box_.push_back({fmt::format("x{}", i), "", -kInfinity, kInfinity});
    }
  }
  const Space& box() const override { return box_; }
  std::optional<double> optimum() const override { return 0.0; }

 protected:
  double value(std::span<const double> x) const override { return -loss_(Turned{frame_, x}); }

 private:
  struct Turned {
    const Frame& frame;
    std::span<const double> x;
    std::size_t size() const { return x.size(); }
    double operator[](std::size_t i) const { return frame.z(x, i); }
  };

  Frame frame_;
  Loss loss_;
  Space box_;
};

/// Test functions of any dimension. T derives from it.
struct PlacedFamily : Objective {
  int n = 10;
  double spread = 2;
  double noise = 0;

 protected:
  template <class Loss>
  std::unique_ptr<const ObjectiveFunction> placed(Frame::Axes axes, const Draws& draws, Loss loss) const {
    return std::make_unique<PlacedFunction<Loss>>(Frame(size(), spread, axes, draws), noise, std::move(loss));
  }
  std::size_t size() const { return static_cast<std::size_t>(n); }

  template <class T>
  static Parameters<T> placed_parameters(int least = 1) {
    return NoisyFunction::with_noise(
        Parameters<T>()
            .add("n", static_cast<int T::*>(&T::n), "", "Number of inputs.", between(least, 1000))
            .add("spread", static_cast<double T::*>(&T::spread), "",
                 "The optimum is drawn uniformly in [-spread, spread]^n.", at_least(0)));
  }
};

}  // namespace coppice
