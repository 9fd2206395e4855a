#pragma once

#include <nlopt.h>

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "engine/vocabulary/space.h"

namespace coppice {

/// One run of a method of NLopt.
struct NloptSettings {
  nlopt_algorithm algorithm = NLOPT_LN_BOBYQA;
  std::optional<nlopt_algorithm> local;  ///< of a method that makes local searches
  double point_tolerance = 0;            ///< relative; 0: none
  double value_tolerance = 0;            ///< relative; 0: none
  std::optional<double> initial_step;    ///< as part of a side, or absolute where that is infinite
  std::optional<int> population;
  Space box;
  std::vector<double> first;  ///< inside the box
  std::uint64_t seed = 0;
  std::int64_t evaluations = 0;  ///< at most
};

/// NLopt calls the function that it maximizes; this turns it around. The library runs in a thread of its own,
/// which waits while we have the turn: never do both run. NLopt's random numbers are kept by thread, so that
/// each run has its own, seeded, whatever other runs do.
class NloptRun {
 public:
  /// Starts; the first evaluations are answered with `replay`.
  NloptRun(NloptSettings settings, std::vector<double> replay);
  ~NloptRun();  ///< ends the run, wherever it stands
  NloptRun(const NloptRun&) = delete;
  NloptRun& operator=(const NloptRun&) = delete;

  /// The point to evaluate; null when the run is over.
  const std::vector<double>* candidate() const { return over_ ? nullptr : &x_; }
  /// Its value, to be maximized; returns when the next candidate is known, or the end.
  void answer(double value);
  /// Why it is over: "budget", "point_tolerance", "value_tolerance", "roundoff", "converged", "failed".
  const std::string& reason() const { return reason_; }

 private:
  static double evaluate(unsigned n, const double* x, double* gradient, void* run);
  double evaluate(const double* x);
  void run();
  nlopt_result optimize();
  void await_library(std::unique_lock<std::mutex>& lock);

  const NloptSettings settings_;
  std::vector<double> replay_;
  std::size_t evaluations_ = 0;
  double best_ = 0, worst_ = 0;  ///< finite values so far, as the library sees them
  bool any_ = false;
  nlopt_opt opt_ = nullptr;

  std::mutex mutex_;
  std::condition_variable turn_;
  bool library_turn_ = true;
  bool over_ = false, abandoned_ = false;
  std::vector<double> x_;
  double value_ = 0;
  std::string reason_;
  std::thread thread_;  ///< last: it uses all of the above
};

/// "2.7.1", of the library that is used.
std::string nlopt_version_text();

}  // namespace coppice
