#include <fmt/format.h>

#include <array>

#include "engine/vocabulary/elementary.h"
#include "problems/objectives/noisy_function.h"

namespace coppice {
namespace {

constexpr std::array<double, 4> kHeights{1, 1.2, 3, 3.2};

template <std::size_t N>
struct Bumps {
  std::array<std::array<double, N>, 4> steepness;
  std::array<std::array<double, N>, 4> centres;  ///< in 1e-4
  double optimum;  ///< largest value, by Newton's method from the published place
};

constexpr Bumps<3> kHartmann3{
    {{{3, 10, 30}, {0.1, 10, 35}, {3, 10, 30}, {0.1, 10, 35}}},
    {{{3689, 1170, 2673}, {4699, 4387, 7470}, {1091, 8732, 5547}, {381, 5743, 8828}}},
    3.862779787332663};
constexpr Bumps<6> kHartmann6{{{{10, 3, 17, 3.5, 1.7, 8},
                                {0.05, 10, 17, 0.1, 8, 14},
                                {3, 3.5, 1.7, 10, 17, 8},
                                {17, 8, 0.05, 10, 0.1, 14}}},
                              {{{1312, 1696, 5569, 124, 8283, 5886},
                                {2329, 4135, 8307, 3736, 1004, 9991},
                                {2348, 1451, 3522, 2883, 3047, 6650},
                                {4047, 8828, 8732, 5743, 1091, 381}}},
                              3.322368011415515};

/// Minus Hartmann's function: a sum of four bumps in the unit cube, and noise.
template <std::size_t N>
class HartmannFunction : public NoisyFunction {
 public:
  HartmannFunction(const Bumps<N>& bumps, double noise) : NoisyFunction(noise), bumps_(bumps) {
    for (std::size_t i = 0; i < N; ++i) box_.push_back({fmt::format("x{}", i), "", 0, 1});
  }
  const Space& box() const override { return box_; }
  std::optional<double> optimum() const override { return bumps_.optimum; }

 protected:
  double value(std::span<const double> x) const override {
    double sum = 0;
    for (std::size_t b = 0; b < 4; ++b) {
      double square = 0;
      for (std::size_t i = 0; i < N; ++i) {
        const double t = x[i] - 1e-4 * bumps_.centres[b][i];
        square += bumps_.steepness[b][i] * t * t;
      }
      sum += kHeights[b] * elementary::exp(-square);
    }
    return sum;
  }

 private:
  const Bumps<N>& bumps_;
  Space box_;
};

template <std::size_t N>
struct Hartmann : Objective {
  double noise = 0;
  std::unique_ptr<const ObjectiveFunction> draw(const Draws&) const override {
    if constexpr (N == 3) return std::make_unique<HartmannFunction<3>>(kHartmann3, noise);
    if constexpr (N == 6) return std::make_unique<HartmannFunction<6>>(kHartmann6, noise);
  }
  static Parameters<Hartmann> parameters() { return NoisyFunction::with_noise(Parameters<Hartmann>()); }
};

const char* const kSource = "Dixon and Szego, Towards Global Optimization 2 (1978)";
const Component<Objective, Hartmann<3>> kThree("hartmann3",
                                               "Minus Hartmann's function of three inputs: four bumps.",
                                               kSource);
const Component<Objective, Hartmann<6>> kSix("hartmann6",
                                             "Minus Hartmann's function of six inputs: four bumps.", kSource);

}  // namespace
}  // namespace coppice
