#include "solvers/optimizers/nlopt_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "solvers/optimizers/box.h"

namespace coppice {
namespace {

struct Destroy {
  void operator()(nlopt_opt opt) const { nlopt_destroy(opt); }
};
using Handle = std::unique_ptr<std::remove_pointer_t<nlopt_opt>, Destroy>;

Handle create(nlopt_algorithm algorithm, const NloptSettings& settings) {
  Handle opt(nlopt_create(algorithm, static_cast<unsigned>(settings.box.size())));
  if (!opt) return opt;
  nlopt_set_xtol_rel(opt.get(), settings.point_tolerance);
  nlopt_set_ftol_rel(opt.get(), settings.value_tolerance);
  if (settings.initial_step) {
    std::vector<double> step;
    for (const Axis& axis : settings.box) {
      const double side = axis.high - axis.low;
      step.push_back(*settings.initial_step * (std::isfinite(side) && side > 0 ? side : 1));
    }
    nlopt_set_initial_step(opt.get(), step.data());
  }
  return opt;
}

const char* reason_of(nlopt_result result) {
  switch (result) {
    case NLOPT_SUCCESS:
      return "converged";
    case NLOPT_FTOL_REACHED:
      return "value_tolerance";
    case NLOPT_XTOL_REACHED:
      return "point_tolerance";
    case NLOPT_MAXEVAL_REACHED:
    case NLOPT_FORCED_STOP:  // by us, when the budget is spent
      return "budget";
    case NLOPT_ROUNDOFF_LIMITED:
      return "roundoff";
    default:
      return "failed";
  }
}

}  // namespace

NloptRun::NloptRun(NloptSettings settings, std::vector<double> replay)
    : settings_(std::move(settings)), replay_(std::move(replay)), x_(settings_.first.size()) {
  thread_ = std::thread([this] { run(); });
  std::unique_lock lock(mutex_);
  await_library(lock);
}

NloptRun::~NloptRun() {
  {
    const std::unique_lock lock(mutex_);
    abandoned_ = true;
    library_turn_ = true;
  }
  turn_.notify_all();
  thread_.join();
}

void NloptRun::answer(double value) {
  std::unique_lock lock(mutex_);
  value_ = value;
  library_turn_ = true;
  turn_.notify_all();
  await_library(lock);
}

void NloptRun::await_library(std::unique_lock<std::mutex>& lock) {
  turn_.wait(lock, [this] { return !library_turn_; });
}

void NloptRun::run() {
  const nlopt_result result = optimize();
  const std::unique_lock lock(mutex_);
  reason_ = reason_of(result);
  over_ = true;
  library_turn_ = false;
  turn_.notify_all();
}

nlopt_result NloptRun::optimize() {
  std::vector<double> x = settings_.first;
  if (std::all_of(settings_.box.begin(), settings_.box.end(),
                  [](const Axis& axis) { return axis.low == axis.high; })) {
    evaluate(x.data());  // there is nothing to vary
    return NLOPT_SUCCESS;
  }
  const Handle opt = create(settings_.algorithm, settings_);
  if (!opt) return NLOPT_FAILURE;
  opt_ = opt.get();
  if (settings_.local) {
    const Handle local = create(*settings_.local, settings_);
    if (!local || nlopt_set_local_optimizer(opt_, local.get()) < 0) return NLOPT_FAILURE;
  }
  if (settings_.population) nlopt_set_population(opt_, static_cast<unsigned>(*settings_.population));
  std::vector<double> low, high;
  for (const Axis& axis : settings_.box) {
    low.push_back(axis.low);
    high.push_back(axis.high);
  }
  nlopt_set_lower_bounds(opt_, low.data());
  nlopt_set_upper_bounds(opt_, high.data());
  nlopt_set_min_objective(opt_, evaluate, this);
  nlopt_set_maxeval(opt_, static_cast<int>(std::min<std::int64_t>(settings_.evaluations, 2000000000)));
  nlopt_srand(static_cast<unsigned long>(settings_.seed & 0xffffffffu));  // of this thread alone
  double value = 0;
  return nlopt_optimize(opt_, x.data(), &value);
}

double NloptRun::evaluate(unsigned, const double* x, double*, void* run) {
  return static_cast<NloptRun*>(run)->evaluate(x);
}

double NloptRun::evaluate(const double* x) {
  double value = 0;
  {
    std::unique_lock lock(mutex_);
    // Some methods exceed their limit by a few evaluations; they must not exceed ours.
    if (abandoned_ || evaluations_ >= static_cast<std::size_t>(settings_.evaluations)) {
      if (opt_ != nullptr) nlopt_force_stop(opt_);
      return any_ ? worst_ : 0;
    }
    if (evaluations_ < replay_.size()) {
      value = replay_[evaluations_];
    } else {
      x_.assign(x, x + x_.size());
      clip(settings_.box, x_);  // methods that scale the box may round to outside
      library_turn_ = false;
      turn_.notify_all();
      turn_.wait(lock, [this] { return library_turn_; });
      if (abandoned_) {
        if (opt_ != nullptr) nlopt_force_stop(opt_);
        return any_ ? worst_ : 0;
      }
      value = value_;
    }
  }
  ++evaluations_;
  if (!std::isfinite(value)) {  // methods compute with values: worse, or better, than all by their range
    if (!any_) return value > 0 ? -1e20 : 1e20;
    const double range = worst_ > best_ ? worst_ - best_ : 1;
    return value > 0 ? best_ - range : worst_ + range;
  }
  best_ = any_ ? std::min(best_, -value) : -value;
  worst_ = any_ ? std::max(worst_, -value) : -value;
  any_ = true;
  return -value;
}

std::string nlopt_version_text() {
  int major = 0, minor = 0, bugfix = 0;
  nlopt_version(&major, &minor, &bugfix);
  return fmt::format("{}.{}.{}", major, minor, bugfix);
}

}  // namespace coppice
