#pragma once

namespace coppice {

/// What a place promises, given that the process there has `mean` and `deviation` (above 0): its value, and
/// the derivatives by both.
struct Promise {
  double value = 0;
  double by_mean = 0;
  double by_deviation = 0;
};

/// Logarithm of the expected improvement on `best` (Jones, Schonlau and Welch 1998, eq. 15); the logarithm
/// keeps its slope where the improvement is far below rounding (Ament et al. 2023).
Promise log_expected_improvement(double mean, double deviation, double best);

/// Logarithm of the probability of an improvement on `best` (Kushner 1964).
Promise log_improvement_probability(double mean, double deviation, double best);

/// mean + width deviation.
Promise upper_bound(double mean, double deviation, double width);

/// Width of the bound after `evaluations` in d dimensions: the square root of
/// 2 log(t^(d/2 + 2) pi^2 / (3 delta)) (Srinivas et al. 2010; Brochu, Cora and de Freitas 2010, 2.3.3), times
/// a factor that is below 1 in practice.
double bound_width(double evaluations, double dimensions, double delta, double factor);

}  // namespace coppice
