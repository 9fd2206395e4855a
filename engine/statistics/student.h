#pragma once

namespace coppice {

/// The p-quantile of Student's t distribution; p in (0, 1), degrees of freedom at least 1 (need not be
/// whole). Relative error below 1e-12 for up to 10^5 degrees, 1e-10 for up to 10^7.
double student_t_quantile(double p, double degrees);

/// P(|T| > |t|): the two-sided p-value. NaN for NaN.
double student_t_two_sided(double t, double degrees);

}  // namespace coppice
