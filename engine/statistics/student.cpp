#include "engine/statistics/student.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "engine/vocabulary/elementary.h"

namespace coppice {
namespace {

/// Gamma(a + 1/2) / Gamma(a): the asymptotic series (DLMF 5.11.13) where it is exact to rounding, and from
/// there down by the recurrence of the gamma function.
double half_step_gamma_ratio(double a) {
  double factor = 1;
  for (; a < 100; a += 1) factor *= a / (a + 0.5);
  const double x = 1 / a;
  return factor * std::sqrt(a) *
         (1 - x / 8 * (1 - x / 16 * (1 + 5 * x / 8 * (1 - 21 * x / 160 * (1 + 19 * x / 8)))));
}

/// The continued fraction of the incomplete beta function (DLMF 8.17.22), by Lentz's method: I_x(a, b) is
/// this times x^a (1 - x)^b / (a B(a, b)).
double beta_fraction(double a, double b, double x) {
  constexpr double kTiny = 1e-300;
  const auto nonzero = [](double v) { return std::fabs(v) < kTiny ? kTiny : v; };
  double c = 1;
  double d = 1 / nonzero(1 - (a + b) * x / (a + 1));
  double fraction = d;
  for (int m = 1; m < 100000; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    double change = 1;
    for (const double term : {even, odd}) {
      d = 1 / nonzero(1 + term * d);
      c = nonzero(1 + term / c);
      change = c * d;
      fraction *= change;
    }
    if (std::fabs(change - 1) < std::numeric_limits<double>::epsilon()) break;
  }
  return fraction;
}

/// P(T > t) for t >= 0 and the density at t.
struct Tail {
  double probability;
  double density;
};

Tail student_tail(double t, double degrees) {
  const double a = degrees / 2;
  const double square = t * t / degrees;
  // (1 + t^2 / nu)^(-nu / 2), and 1 / B(nu / 2, 1 / 2)
  const double power = elementary::exp(-a * elementary::log1p(square));
  const double beta = half_step_gamma_ratio(a) / std::sqrt(std::numbers::pi);
  const double x = 1 / (1 + square);
  const double y = square / (1 + square);  // 1 - x
  Tail tail;
  tail.density = power * std::sqrt(x) * beta / std::sqrt(degrees);
  const double common = power * std::sqrt(y) * beta;  // x^a y^(1/2) / B
  if (x < (a + 1) / (a + 2.5)) {
    tail.probability = 0.5 * common / a * beta_fraction(a, 0.5, x);
  } else {
    tail.probability = 0.5 - common * beta_fraction(0.5, a, y);
  }
  return tail;
}

}  // namespace

double student_t_quantile(double p, double degrees) {
  if (!(p > 0 && p < 1) || !(degrees >= 1))
    throw std::logic_error("student_t_quantile: p or degrees out of range");
  if (p == 0.5) return 0;
  const double q = std::min(p, 1 - p);
  double low = 0;
  double high = 1;
  while (student_tail(high, degrees).probability > q) {
    low = high;
    high *= 2;
  }
  // Newton's steps on P(T > t) = q, replaced by bisection where they leave the bracket.
  double t = 0.5 * (low + high);
  for (int i = 0; i < 200; ++i) {
    const Tail tail = student_tail(t, degrees);
    (tail.probability > q ? low : high) = t;
    double next = t + (tail.probability - q) / tail.density;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    const double change = std::fabs(next - t);
    t = next;
    if (change <= 4 * std::numeric_limits<double>::epsilon() * t) break;
  }
  return p < 0.5 ? -t : t;
}

double student_t_two_sided(double t, double degrees) {
  if (std::isnan(t)) return t;
  if (std::isinf(t)) return 0;
  return 2 * student_tail(std::fabs(t), degrees).probability;
}

}  // namespace coppice
