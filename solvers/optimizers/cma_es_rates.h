#pragma once

#include <cstddef>
#include <vector>

namespace coppice {

/// Recombination weights and learning rates of CMA-ES for a dimension and a population: the defaults of
/// Hansen's tutorial (arXiv 1604.00772v2, Table 1; equation numbers below are the tutorial's).
struct CmaRates {
  std::size_t population = 0;   ///< lambda
  std::vector<double> weights;  ///< one a rank, best first; the positive ones sum to 1, the rest are negative
  double mu_eff = 0;            ///< variance effective selection mass of the positive weights (Eq. 8)
  double c_sigma = 0;           ///< of the path of the step size (Eq. 55)
  double d_sigma = 0;           ///< damping of the step size
  double c_c = 0;               ///< of the path of the covariance (Eq. 56)
  double c_1 = 0;               ///< rank-one update (Eq. 57)
  double c_mu = 0;              ///< rank-mu update (Eq. 58)
  double weight_sum = 0;
  double expected_length = 0;  ///< of a standard normal vector
};

/// 4 + floor(3 ln n) (Eq. 48).
std::size_t default_population(std::size_t dimension);

/// `active`: with negative weights; `separable`: the covariance is diagonal and learnt (n + 2)/3 times as
/// fast (Ros and Hansen, PPSN 2008).
CmaRates cma_rates(std::size_t dimension, std::size_t population, bool active, bool separable);

}  // namespace coppice
