#pragma once

namespace coppice {

/// Elementary functions whose results depend neither on the C library nor on the machine's instruction set,
/// nor on whether they are computed one at a time or in packs: SLEEF's deterministic variants (error below 1
/// ulp). Models use these, never <cmath>'s; + - * / sqrt fabs are exact everywhere and may be used as they
/// are.
namespace elementary {
double sin(double x);
double cos(double x);
double tan(double x);
double atan2(double y, double x);
double exp(double x);
double log(double x);
double log1p(double x);
double pow(double x, double y);
double erfc(double x);  ///< error below 1.5 ulp
}  // namespace elementary

/// The angle in [-pi, pi) that differs from `angle` by whole turns.
double normalize_angle(double angle);

/// The standard normal quantile of p in (0, 1) (Wichura 1988, algorithm AS 241, PPND16).
double normal_quantile(double p);

}  // namespace coppice
