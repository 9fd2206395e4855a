#include "engine/graph/executor.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/graph/provenance.h"
#include "engine/graph/seconds.h"

namespace coppice {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kTick(100);

std::vector<const Plan*> plans_of(const std::vector<std::unique_ptr<Workspace>>& workspaces) {
  std::vector<const Plan*> plans;
  for (const auto& workspace : workspaces) plans.push_back(&workspace->plan);
  return plans;
}

std::vector<std::vector<NodeStatus>> statuses_of(const std::vector<std::unique_ptr<Workspace>>& workspaces) {
  std::vector<std::vector<NodeStatus>> statuses;
  for (const auto& workspace : workspaces) statuses.push_back(workspace->statuses);
  return statuses;
}

}  // namespace

std::size_t Workspace::up_to_date() const {
  return static_cast<std::size_t>(std::count_if(statuses.begin(), statuses.end(), [](const NodeStatus& s) {
    return s.reason == Reason::up_to_date || s.reason == Reason::shared;
  }));
}

Executor::Executor(std::vector<std::unique_ptr<Workspace>>& workspaces, Store& store, Index& index,
                   const RunOptions& options)
    : workspaces_(workspaces),
      store_(store),
      index_(index),
      options_(options),
      jobs_(make_jobs(plans_of(workspaces), statuses_of(workspaces))),
      durations_(read_durations(options.out)),
      pool_(static_cast<std::size_t>(std::max(options.threads, 0)), &stop_) {
  for (const auto& workspace : workspaces_) totals_.up_to_date += workspace->up_to_date();
  totals_.to_run = jobs_.size();
  for (const Job& job : jobs_) limited_ += limits_of(job).any() ? 1 : 0;
}

const PlannedNode& Executor::node_of(const Job& job) const {
  const NodePlace& place = job.places.front();
  return workspaces_[place.plan]->plan.nodes[place.node];
}

/// The widest that any node sets that wants the result: who sets none is not to lack it for another's.
Limits Executor::limits_of(const Job& job) const {
  std::optional<Limits> widest;
  const auto wider = [](double a, double b) { return a == 0 || b == 0 ? 0 : std::max(a, b); };
  for (const NodePlace& place : job.places) {
    const Limits own(*workspace_of(place).plan.nodes[place.node].node);
    widest = widest ? Limits(wider(widest->time, own.time), wider(widest->memory, own.memory)) : own;
  }
  return widest.value_or(Limits());
}

void Executor::run() {
  Lock lock(mutex_);
  if (options_.listener != nullptr) options_.listener->begin(totals());
  for (std::size_t i = 0; i < jobs_.size(); ++i) {
    if (jobs_[i].waiting_for == 0) submit(i);
  }
  const auto over = [&] {
    const std::size_t settled = totals_.finished + totals_.failed + totals_.skipped;
    return totals_.running == 0 && (stop_ || settled == totals_.to_run);
  };
  while (!settled_.wait_for(lock, kTick, over)) {
    if (options_.stop != nullptr && *options_.stop) stop_ = true;
    if (options_.listener == nullptr) continue;
    predict();
    options_.listener->tick(active_reports(), totals());
  }
  lock.unlock();
  pool_.drop_queued();
  pool_.wait();
  lock.lock();
  const std::size_t settled = totals_.finished + totals_.failed + totals_.skipped;
  interrupted_ = settled < totals_.to_run && options_.stop != nullptr && *options_.stop;
  if (options_.listener != nullptr) options_.listener->end(totals());
}

void Executor::submit(std::size_t job) {
  const PlannedNode& node = node_of(jobs_[job]);
  Task task;
  task.order = static_cast<double>(job);
  task.threads = static_cast<std::size_t>(node.node->threads);
  if (limits_of(jobs_[job]).any()) {
    const std::size_t share = std::max<std::size_t>(pool_.threads() / limited_, 1);
    task.cores = task.threads > 0 ? std::min(task.threads, pool_.threads()) : share;
    task.threads = task.cores;
  }
  task.work = [this, job](TaskParallel& parallel) { execute(job, parallel); };
  pool_.submit(std::move(task));
}

void Executor::execute(std::size_t index, TaskParallel& parallel) {
  Job& job = jobs_[index];
  Active active;
  {
    const Lock lock(mutex_);
    if (stop_) return;
    start(index, active);
  }
  try {
    const ResultRecord record = compute(job, parallel, active);
    for (const NodePlace& place : job.places) {
      Workspace& workspace = workspace_of(place);
      workspace.folder.place(workspace.plan.nodes[place.node], record, store_);
    }
    const Lock lock(mutex_);
    std::erase(active_, &active);
    settle_done(index, record);
  } catch (const Interrupted&) {
    const Lock lock(mutex_);
    std::erase(active_, &active);
    settle_interrupted(index);
  } catch (...) {
    const std::string message = failure_text();
    const Lock lock(mutex_);
    std::erase(active_, &active);
    settle_failed(index, message);
  }
  settled_.notify_all();
}

ResultRecord Executor::compute(Job& job, TaskParallel& parallel, Active& active) {
  const NodePlace& place = job.places.front();
  Workspace& workspace = workspace_of(place);
  const PlannedNode& node = workspace.plan.nodes[place.node];
  if (const Limits limits = limits_of(job); limits.any()) {
    // The process does nothing when the result is there.
    const bool anew = std::any_of(job.places.begin(), job.places.end(), [&](const NodePlace& each) {
      const Reason reason = workspace_of(each).statuses[each.node].reason;
      return reason == Reason::forced || reason == Reason::damaged;
    });
    if (anew) store_.remove(node.key);
    return compute_in_process(node, limits, workspace.folder.path(), store_,
                              {options_.runner, parallel.width()}, stop_);
  }
  return compute_node(workspace.plan, place.node, workspace.folder.path(), store_, parallel,
                      [&](const RunningContext* context) {
                        const Lock lock(mutex_);
                        active.context = context;
                      });
}

void Executor::start(std::size_t index, Active& active) {
  Job& job = jobs_[index];
  job.state = Job::State::running;
  ++totals_.running;
  active.job = index;
  active.start = Clock::now();
  active_.push_back(&active);
  tell(job, "started", {}, nullptr);
  if (options_.listener != nullptr) options_.listener->started(report(job), totals());
}

void Executor::settle_done(std::size_t index, const ResultRecord& record) {
  Job& job = jobs_[index];
  job.state = Job::State::done;
  --totals_.running;
  ++totals_.finished;
  durations_.add(record.family, record.component, record.wall_s);
  tell(job, "finished", {}, &record);
  if (options_.listener != nullptr) {
    NodeReport done = report(job);
    done.wall_s = record.wall_s;
    done.cpu_s = record.cpu_s;
    options_.listener->finished(done, totals());
  }
  for (const std::size_t dependant : job.dependants) {
    if (--jobs_[dependant].waiting_for == 0 && !stop_) submit(dependant);
  }
}

void Executor::settle_failed(std::size_t index, const std::string& message) {
  Job& job = jobs_[index];
  job.state = Job::State::failed;
  --totals_.running;
  ++totals_.failed;
  const NodePlace& place = job.places.front();
  const std::string experiment =
      workspaces_.size() > 1 ? workspace_of(place).plan.experiment.name + ": " : std::string();
  failures_.push_back(fmt::format("{}node {}: {}", experiment, node_of(job).name, message));
  tell(job, "failed", message, nullptr);
  for (const NodePlace& every : job.places) workspace_of(every).failed = true;
  if (options_.listener != nullptr) {
    NodeReport failure = report(job);
    failure.message = message;
    options_.listener->failed(failure, totals());
  }
  skip_dependants(job);
  if (options_.fail_fast) stop_ = true;
}

void Executor::skip_dependants(const Job& job) {
  for (const std::size_t i : job.dependants) {
    Job& dependant = jobs_[i];
    if (dependant.state != Job::State::waiting) continue;
    dependant.state = Job::State::skipped;
    ++totals_.skipped;
    const std::string why =
        "its input " + node_of(job).name + (job.state == Job::State::failed ? " failed" : " was skipped");
    tell(dependant, "skipped", why, nullptr);
    if (options_.listener != nullptr) {
      NodeReport skipped = report(dependant);
      skipped.message = why;
      options_.listener->skipped(skipped, totals());
    }
    skip_dependants(dependant);
  }
}

void Executor::settle_interrupted(std::size_t index) {
  if (!stop_) {
    settle_failed(index, "ended as if interrupted, although nobody asked it to");
    return;
  }
  Job& job = jobs_[index];
  job.state = Job::State::interrupted;
  --totals_.running;
  tell(job, "interrupted", {}, nullptr);
  if (options_.listener != nullptr) options_.listener->interrupted(report(job), totals());
}

/// Notes an event in the journal of every experiment that it concerns.
void Executor::tell(const Job& job, const char* what, const std::string& message,
                    const ResultRecord* record) {
  for (const NodePlace& place : job.places) {
    Workspace& workspace = workspace_of(place);
    const PlannedNode& node = workspace.plan.nodes[place.node];
    Event event;
    event.time = timestamp();
    event.what = what;
    event.node = node.name;
    event.key = node.key;
    event.message = message;
    if (record != nullptr) {
      event.wall_s = record->wall_s;
      event.cpu_s = record->cpu_s;
      index_.add({workspace.plan.experiment.name, node.name, node.key, node.component, node.family,
                  record->wall_s, record->cpu_s, event.time});
    }
    if (workspace.journal) {
      try {
        workspace.journal->write(std::move(event));
      } catch (const std::runtime_error& error) {
        troubles_.push_back(error.what());
        workspace.journal.reset();  // said once
      }
    }
  }
}

NodeReport Executor::report(const Job& job) const {
  NodeReport report;
  report.node = &node_of(job);
  report.experiment = workspace_of(job.places.front()).plan.experiment.name;
  return report;
}

std::vector<NodeReport> Executor::active_reports() const {
  std::vector<NodeReport> reports;
  for (const Active* active : active_) {
    NodeReport& now = reports.emplace_back(report(jobs_[active->job]));
    now.wall_s = seconds_since(active->start);
    if (active->context == nullptr) continue;
    now.done = active->context->done();
    now.total = active->context->total();
  }
  return reports;
}

RunTotals Executor::totals() const {
  RunTotals now = totals_;
  now.elapsed_s = seconds_since(start_);
  return now;
}

void Executor::predict() {
  constexpr double kEvery = 1.0;  // s: it looks at every job
  if (seconds_since(start_) < next_prediction_s_) return;
  next_prediction_s_ = seconds_since(start_) + kEvery;
  totals_.remaining_s = remaining_s();
}

/// Work left, by recorded durations, spread over the cores; at least what the longest node needs.
std::optional<double> Executor::remaining_s() const {
  double sum = 0;
  double longest = 0;
  const auto add = [&](double seconds) {
    sum += std::max(seconds, 0.0);
    longest = std::max(longest, seconds);
  };
  for (const Active* active : active_) {
    const double elapsed = seconds_since(active->start);
    const double done = active->context == nullptr ? 0 : static_cast<double>(active->context->done());
    const double total = active->context == nullptr ? 0 : static_cast<double>(active->context->total());
    const PlannedNode& node = node_of(jobs_[active->job]);
    const std::optional<double> predicted = durations_.predict(node.family, node.component);
    if (total > 0 && done > 0.05 * total && elapsed > 1) {
      add(elapsed * (total - done) / done);
    } else if (predicted) {
      add(*predicted - elapsed);
    } else {
      return std::nullopt;
    }
  }
  for (const Job& job : jobs_) {
    if (job.state != Job::State::waiting) continue;
    const std::optional<double> predicted = durations_.predict(node_of(job).family, node_of(job).component);
    if (!predicted) return std::nullopt;
    add(*predicted);
  }
  return std::max(sum / static_cast<double>(pool_.threads()), longest);
}

}  // namespace coppice
