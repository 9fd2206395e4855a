// How often 95 % intervals cover the true value: 93 to 97 % is promised for normal values from ten units on
// and for lognormal ones from fifty on; docs/statistics.md has the figures that this prints. Seeds are fixed;
// with 4000 trials a share of 95 % has a standard error of 0.34 %, with 20000 of 0.15 %.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <vector>

#include "engine/statistics/bootstrap.h"
#include "engine/statistics/cautions.h"
#include "engine/statistics/comparisons.h"
#include "engine/statistics/mean_estimate.h"
#include "engine/statistics/profiles.h"
#include "engine/statistics/shares.h"
#include "engine/vocabulary/elementary.h"
#include "engine/vocabulary/random.h"

namespace coppice {
namespace {

using Values = std::vector<double>;
using Sampler = std::function<double(Stream&)>;

double normal(Stream& stream) {
  return stream.normal();
}
double lognormal(Stream& stream) {
  return std::exp(stream.normal());
}
const double kLognormalMean = std::exp(0.5);

Values sample(std::size_t n, Stream& stream, const Sampler& value) {
  Values values(n);
  for (double& v : values) v = value(stream);
  return values;
}

using Trial = std::function<std::optional<Interval>(Stream& stream, const Draws& resampling)>;

/// The share of trials whose interval covers `truth`.
double coverage(const char* what, int trials, double truth, const Trial& trial) {
  int covered = 0;
  for (int i = 0; i < trials; ++i) {
    const auto index = static_cast<std::uint64_t>(i);
    Stream stream = Draws(2017, "coverage", 0).stream("trial", index);
    const std::optional<Interval> interval = trial(stream, Draws(2017, "resampling", index));
    covered += interval && interval->low <= truth && truth <= interval->high;
  }
  const double share = static_cast<double>(covered) / trials;
  std::printf("%-66s %.1f %%\n", what, 100 * share);
  return share;
}

void expect_promised(const char* what, int trials, double truth, const Trial& trial) {
  const double share = coverage(what, trials, truth, trial);
  EXPECT_GE(share, 0.93) << what;
  EXPECT_LE(share, 0.97) << what;
}

Trial mean_of(std::size_t n, Sampler value) {
  return [=](Stream& stream, const Draws&) {
    return confidence_interval(mean_estimate(sample(n, stream, value)));
  };
}

TEST(MeanCoverage, OfNormalValues) {
  expect_promised("mean, normal, n = 3", 20000, 0, mean_of(3, normal));
  expect_promised("mean, normal, n = 10", 20000, 0, mean_of(10, normal));
  expect_promised("mean, normal, n = 20", 20000, 0, mean_of(20, normal));
  expect_promised("mean, normal, n = 50", 20000, 0, mean_of(50, normal));
}

TEST(MeanCoverage, OfLognormalValues) {
  expect_promised("mean, lognormal, n = 50", 20000, kLognormalMean, mean_of(50, lognormal));
  expect_promised("mean, lognormal, n = 100", 20000, kLognormalMean, mean_of(100, lognormal));
  expect_promised("mean, lognormal, n = 1000", 4000, kLognormalMean, mean_of(1000, lognormal));
  const double student =
      coverage("  Student's interval instead, n = 50", 20000, kLognormalMean,
               [](Stream& stream, const Draws&) { return t_interval(sample(50, stream, lognormal)); });
  EXPECT_LT(student, 0.92) << "if Student's were good enough, nothing else would be needed";
  coverage("mean, lognormal, n = 20 (warned of)", 20000, kLognormalMean, mean_of(20, lognormal));
}

/// n runs of 20 episodes; runs differ (deviation 1), and episodes in a run (deviation 3).
std::vector<Values> nested(std::size_t n, Stream& stream) {
  std::vector<Values> runs(n, Values(20));
  for (Values& run : runs) {
    const double level = stream.normal();
    for (double& episode : run) episode = level + 3 * stream.normal();
  }
  return runs;
}

TEST(MeanCoverage, OfNestedValues) {
  expect_promised("mean, 10 runs of 20 episodes", 20000, 0, [](Stream& stream, const Draws&) {
    return estimate(nested(10, stream), Unit::training_run, Better::higher).ci95;
  });
}

TEST(DifferenceCoverage, OfIndependentSamples) {
  const auto normals = [](std::size_t n, std::size_t m, double deviation) {
    return [=](Stream& stream, const Draws&) {
      const Values wide = sample(m, stream, [&](Stream& s) { return deviation * s.normal(); });
      return confidence_interval(difference(mean_estimate(sample(n, stream, normal)), mean_estimate(wide)));
    };
  };
  expect_promised("difference, normal, n = 10 and 10", 20000, 0, normals(10, 10, 1));
  expect_promised("difference, normal, n = 10 and 10, deviations 1 and 3", 20000, 0, normals(10, 10, 3));
  expect_promised("difference, normal, n = 10 and 30, deviations 1 and 1/3", 20000, 0,
                  normals(10, 30, 1.0 / 3));
  const auto lognormals = [](double scale) {
    return [=](Stream& stream, const Draws&) {
      const Values other = sample(50, stream, [&](Stream& s) { return scale * lognormal(s); });
      return confidence_interval(
          difference(mean_estimate(sample(50, stream, lognormal)), mean_estimate(other)));
    };
  };
  expect_promised("difference, lognormal, n = 50 and 50", 20000, 0, lognormals(1));
  expect_promised("difference, lognormal, n = 50 and 50, one three times the other", 20000,
                  -2 * kLognormalMean, lognormals(3));
}

TEST(DifferenceCoverage, OfPairs) {
  expect_promised("paired difference, normal, n = 10", 20000, 1, [](Stream& stream, const Draws&) {
    Values first(10), second(10);
    for (std::size_t i = 0; i < 10; ++i) {
      const double common = 5 * stream.normal();
      first[i] = common + 1 + stream.normal();
      second[i] = common + stream.normal();
    }
    return confidence_interval(mean_estimate(paired_differences(first, second)));
  });
}

/// Shares of runs of 50 episodes, whose true shares are spread evenly between two limits.
Values rates(std::size_t n, double low, double high, Stream& stream) {
  return sample(n, stream, [&](Stream& s) {
    const double truth = low + (high - low) * s.uniform();
    int count = 0;
    for (int i = 0; i < 50; ++i) count += s.uniform() < truth;
    return count / 50.0;
  });
}

TEST(ShareCoverage, OfRuns) {
  const auto of_runs = [](std::size_t n, double low, double high) {
    return [=](Stream& stream, const Draws&) {
      return score_interval(mean_share(rates(n, low, high, stream), 50));
    };
  };
  expect_promised("rate, 10 runs, equal true shares of 30 %", 20000, 0.3, of_runs(10, 0.3, 0.3));
  expect_promised("rate, 10 runs, true shares 20 to 40 %", 20000, 0.3, of_runs(10, 0.2, 0.4));
  expect_promised("rate, 10 runs, true shares 0 to 100 %", 20000, 0.5, of_runs(10, 0, 1));
  expect_promised("rate, 10 runs, true shares 10 to 50 %", 20000, 0.3, of_runs(10, 0.1, 0.5));
  expect_promised("rate, 20 runs, true shares 80 to 100 %", 20000, 0.9, of_runs(20, 0.8, 1));
  expect_promised("rate, 50 runs, true shares 90 to 100 %", 20000, 0.95, of_runs(50, 0.9, 1));
}

TEST(ShareCoverage, OfDifferences) {
  const auto of_shares = [](double n, double p, double q) {
    return [=](Stream& stream, const Draws&) {
      const auto count = [&](double truth) {
        return mean(sample(static_cast<std::size_t>(n), stream,
                           [&](Stream& s) { return s.uniform() < truth ? 1.0 : 0.0; }));
      };
      const double first = count(p);
      return ShareDifference{{first, n}, {count(q), n}}.interval();
    };
  };
  expect_promised("difference of shares, 30 and 50 %, n = 20", 20000, -0.2, of_shares(20, 0.3, 0.5));
  expect_promised("difference of shares, 5 and 10 %, n = 100", 20000, -0.05, of_shares(100, 0.05, 0.1));
  expect_promised("difference of paired shares, 40 and 50 %, n = 50", 20000, -0.1,
                  [](Stream& stream, const Draws&) {
                    Values first(50), second(50);
                    for (std::size_t i = 0; i < 50; ++i) {
                      const double common = stream.uniform();  // in half of the pairs it decides both
                      const bool shared = stream.uniform() < 0.5;
                      first[i] = (shared ? common : stream.uniform()) < 0.4 ? 1 : 0;
                      second[i] = (shared ? common : stream.uniform()) < 0.5 ? 1 : 0;
                    }
                    ShareDifference difference{{mean(first), 50}, {mean(second), 50}};
                    difference.correlation = case_correlation(first, second);
                    return difference.interval();
                  });
  expect_promised("difference of rates, 10 runs each, true shares 10 to 50 %", 20000, 0,
                  [](Stream& stream, const Draws&) {
                    const ShareEstimate first = mean_share(rates(10, 0.1, 0.5, stream), 50);
                    return ShareDifference{first, mean_share(rates(10, 0.1, 0.5, stream), 50)}.interval();
                  });
}

TEST(ImprovementCoverage, OfNormalValues) {
  const auto improvement = [](std::size_t n, double shift, double deviation) {
    return [=](Stream& stream, const Draws&) {
      const Values second = sample(n, stream, [&](Stream& s) { return deviation * s.normal() - shift; });
      return probability_of_improvement(sample(n, stream, normal), second, Better::higher).ci95;
    };
  };
  const auto truth = [](double shift, double deviation) {  // P(N(shift, 1 + deviation^2) > 0)
    return 0.5 * std::erfc(-shift / std::sqrt(2 * (1 + deviation * deviation)));
  };
  expect_promised("improvement, n = 10, equal", 20000, truth(0, 1), improvement(10, 0, 1));
  expect_promised("improvement, n = 10, 76 %", 20000, truth(1, 1), improvement(10, 1, 1));
  expect_promised("improvement, n = 10, 92 %", 20000, truth(2, 1), improvement(10, 2, 1));
  expect_promised("improvement, n = 10, deviations 1 and 2, 67 %", 20000, truth(1, 2), improvement(10, 1, 2));
  expect_promised("improvement, n = 50, 76 %", 20000, truth(1, 1), improvement(50, 1, 1));
}

Trial bootstrap_of(std::size_t n, Sampler value, Statistic statistic) {
  return [=](Stream& stream, const Draws& resampling) {
    return bootstrap_interval(sample(n, stream, value), statistic, resampling, 0.95, 999);
  };
}

TEST(BootstrapCoverage, OfTheMean) {
  expect_promised("studentized bootstrap, mean, normal, n = 10", 4000, 0,
                  bootstrap_of(10, normal, studentized_mean));
  expect_promised("studentized bootstrap, mean, lognormal, n = 50", 4000, kLognormalMean,
                  bootstrap_of(50, lognormal, studentized_mean));
  expect_promised("studentized bootstrap, mean, 10 runs of 20 episodes", 4000, 0,
                  [](Stream& stream, const Draws& resampling) {
                    return bootstrap_interval(nested(10, stream), Unit::training_run, studentized_mean,
                                              resampling, 0.95, 999);
                  });
}

// The mean of the middle half of a standard lognormal distribution: 2 e^(1/2) (Phi(q - 1) - Phi(-q - 1)).
const double kQuartile = 0.6744897501960817, kRoot2 = std::sqrt(2.0);
const double kLognormalIqm =
    std::exp(0.5) * (std::erf((kQuartile - 1) / kRoot2) - std::erf((-kQuartile - 1) / kRoot2));

TEST(IqmCoverage, OfSamples) {
  const auto iqm_of = [](std::size_t n, Sampler value) {
    return [=](Stream& stream, const Draws&) { return iqm_interval(sample(n, stream, value)); };
  };
  for (const std::size_t n : {5u, 8u, 10u, 12u, 20u, 50u}) {
    expect_promised(fmt::format("IQM, normal, n = {}", n).c_str(), 20000, 0, iqm_of(n, normal));
  }
  for (const std::size_t n : {50u, 100u}) {
    expect_promised(fmt::format("IQM, lognormal, n = {}", n).c_str(), 20000, kLognormalIqm,
                    iqm_of(n, lognormal));
  }
  coverage("IQM, lognormal, n = 10 (warned of)", 20000, kLognormalIqm, iqm_of(10, lognormal));
  coverage("IQM, lognormal, n = 20 (warned of)", 20000, kLognormalIqm, iqm_of(20, lognormal));
  expect_promised("IQM, 10 runs of 20 episodes", 20000, 0, [](Stream& stream, const Draws&) {
    Values means;
    for (const Values& run : nested(10, stream)) means.push_back(mean(run));
    return iqm_interval(means);
  });
}

// The studentized bootstrap covers as well, but at ten units some of its intervals tell nothing.
TEST(IqmCoverage, IsNotPaidForWithUselessIntervals) {
  expect_promised("  studentized bootstrap instead, IQM, normal, n = 10", 4000, 0,
                  bootstrap_of(10, normal, studentized_iqm));
  expect_promised("  studentized bootstrap instead, IQM, lognormal, n = 50", 4000, kLognormalIqm,
                  bootstrap_of(50, lognormal, studentized_iqm));
  Values trimmed, bootstrapped;
  for (std::uint64_t trial = 0; trial < 2000; ++trial) {
    Stream stream = Draws(2017, "widths", 0).stream("trial", trial);
    const Values values = sample(10, stream, normal);
    const Interval a = *iqm_interval(values);
    const std::optional<Interval> b =
        bootstrap_interval(values, studentized_iqm, Draws(2017, "widths", trial), 0.95, 999);
    trimmed.push_back(a.high - a.low);
    bootstrapped.push_back(b ? b->high - b->low : INFINITY);
  }
  for (const auto& [name, widths] : {std::pair("trimmed mean's", &trimmed), {"bootstrap's", &bootstrapped}}) {
    std::printf(
        "width of the %s interval, normal, n = 10: median %.2f, 99 of 100 below %.2f, all below %.1f\n", name,
        median(*widths), quantile(*widths, 0.99), quantile(*widths, 1));
  }
  EXPECT_LT(quantile(trimmed, 1), 8);
  EXPECT_LT(quantile(trimmed, 0.99), quantile(bootstrapped, 0.99));
}

/// Coverage of profiles of n normal values at each of some thresholds: as given, or placed by each sample.
struct ProfileCoverage {
  double average = 0, least = 1, most = 0;
};
ProfileCoverage profile_coverage(std::size_t n,
                                 const std::function<Values(const Values& sample)>& thresholds) {
  constexpr int kTrials = 20000;
  std::vector<int> covered;
  for (int trial = 0; trial < kTrials; ++trial) {
    Stream stream = Draws(2017, "profiles", n).stream("trial", static_cast<std::uint64_t>(trial));
    const Values values = sample(n, stream, normal);
    const auto profile = performance_profile(values, thresholds(values), Better::higher);
    covered.resize(profile.size());
    for (std::size_t i = 0; i < profile.size(); ++i) {
      const double truth = 0.5 * std::erfc(profile[i].threshold / std::sqrt(2.0));
      covered[i] += profile[i].ci95.low <= truth && truth <= profile[i].ci95.high;
    }
  }
  ProfileCoverage result;
  for (const int count : covered) {
    const double share = count / static_cast<double>(kTrials);
    result.average += share / static_cast<double>(covered.size());
    result.least = std::min(result.least, share);
    result.most = std::max(result.most, share);
  }
  return result;
}

// The number of n values beyond a threshold is a whole number, so that no interval of a share covers it in
// exactly 95 %: of ten values with a true share of one half, in 89.1 % or in 97.9 %. The promise is therefore
// about all thresholds together, as a band is read.
TEST(ProfileCoverage, OfNormalValues) {
  Values at_shares;
  for (int percent = 5; percent <= 95; ++percent) at_shares.push_back(normal_quantile(percent / 100.0));
  const auto range = [](const Values& values) {
    Values thresholds;
    const double low = quantile(values, 0), high = quantile(values, 1);
    for (int i = 0; i <= 100; ++i) thresholds.push_back(low + (high - low) * i / 100);
    return thresholds;
  };
  for (const std::size_t n : {10u, 20u, 50u}) {
    const ProfileCoverage fixed = profile_coverage(n, [&](const Values&) { return at_shares; });
    std::printf("profile, n = %zu, true shares 5 to 95 %%: on average %.1f %%, from %.1f to %.1f %%\n", n,
                100 * fixed.average, 100 * fixed.least, 100 * fixed.most);
    const ProfileCoverage drawn = profile_coverage(n, range);
    std::printf("profile, n = %zu, over the range of the sample:  on average %.1f %%\n", n,
                100 * drawn.average);
    for (const double average : {fixed.average, drawn.average}) {
      EXPECT_GE(average, 0.93);
      EXPECT_LE(average, 0.97);
    }
    EXPECT_GE(fixed.least, 0.88);
  }
}

double warned(std::size_t n, const Sampler& value) {
  int warnings = 0;
  for (std::uint64_t trial = 0; trial < 4000; ++trial) {
    Stream stream = Draws(2017, "warnings", n).stream("trial", trial);
    warnings += !caution(static_cast<double>(n), sample_skewness(sample(n, stream, value)), "runs").empty();
  }
  return warnings / 4000.0;
}

TEST(Warnings, AppearForSkewedSamplesBelowFifty) {
  for (const std::size_t n : {5u, 10u, 15u, 20u, 30u, 40u, 49u, 50u, 100u}) {
    std::printf("warned of: lognormal %.1f %%, normal %.1f %%, n = %zu\n", 100 * warned(n, lognormal),
                100 * warned(n, normal), n);
  }
  for (std::size_t n = 3; n < 50; ++n) EXPECT_GE(warned(n, lognormal), 0.985) << n;
  EXPECT_LT(warned(30, normal), 0.25);
  EXPECT_LT(warned(40, normal), 0.06);
  EXPECT_LT(warned(49, normal), 0.02);
  EXPECT_LT(warned(50, normal), 0.005);
}

}  // namespace
}  // namespace coppice
