#include "engine/graph/nodes/tuning.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "engine/graph/artifacts.h"
#include "engine/graph/compute.h"
#include "engine/graph/nodes/episodes.h"

namespace coppice {
namespace {

constexpr std::int64_t kMostAtOnce = 64;     // so that it shows progress and can stop
constexpr std::int64_t kHistoryRows = 1000;  // about as many, however large the budget
constexpr std::chrono::microseconds kWorthThreads(200);

}  // namespace

Tuning::Tuning(const Optimizer& optimizer, SearchTask task, const SearchTarget& target, TuningOptions options,
               NodeContext& context)
    : task_(std::move(task)),
      target_(target),
      options_(options),
      names_(optimizer.measures()),
      context_(context),
      search_(optimizer.start(task_)),
      best_observed_(-std::numeric_limits<double>::infinity()) {
  std::optional<Archive> saved = context.checkpoint();
  if (!saved) return;
  try {
    load(*saved);
  } catch (const std::runtime_error&) {  // a checkpoint that cannot be read is no loss but of time
    search_ = optimizer.start(task_);
    history_ = {};
    improvements_ = {};
    evaluations_ = not_finite_ = last_row_ = next_row_ = 0;
    best_observed_ = -std::numeric_limits<double>::infinity();
  }
}

void Tuning::run() {
  CheckpointClock clock;
  while (evaluations_ < task_.budget && !reached_target()) {
    const bool stop = context_.parallel().stop_requested();
    if (stop || clock.due()) clock.save(context_, state());
    if (stop) throw Interrupted();
    const Candidates candidates = search_->ask(std::min(kMostAtOnce, task_.budget - evaluations_));
    if (candidates.points.rows() == 0) break;
    check(candidates);
    const std::vector<double> values = evaluate(candidates);
    note(candidates, values);
    search_->tell(values);
    if (evaluations_ >= next_row_) add_row();
    context_.progress(evaluations_, task_.budget);
  }
  if (evaluations_ > last_row_) add_row();
}

bool Tuning::reached_target() const {
  const std::optional<double> optimum = target_.optimum(), best = improvements_.best();
  return options_.stop_gap && optimum && best && *optimum - *best <= *options_.stop_gap;
}

void Tuning::check(const Candidates& candidates) const {
  for (std::size_t i = 0; i < task_.box.size(); ++i) {
    for (const double x : candidates.points.column(i)) {
      if (x >= task_.box[i].low && x <= task_.box[i].high) continue;
      throw std::logic_error(
          fmt::format("a candidate has {} = {}, outside of its limits", task_.box[i].name, x));
    }
  }
}

std::vector<double> Tuning::evaluate(const Candidates& candidates) {
  std::vector<double> values(candidates.points.rows());
  const auto work = [&](std::size_t i) {
    std::vector<double> x(candidates.points.columns());
    candidates.points.row(i, x);
    const auto number = static_cast<std::uint64_t>(evaluations_) + i;
    try {
      values[i] =
          target_.value(x, options_.common_scenarios ? candidates.scenarios[i] : number, context_.parallel());
    } catch (const Interrupted&) {
      throw;
    } catch (...) {
      throw Unfinished(fmt::format("evaluation {} of {} failed, of {}: {}", number + 1, task_.budget,
                                   point_text(task_.box, x), failure_text()));
    }
  };
  // The clock decides where evaluations run, not what they give.
  const auto begin = std::chrono::steady_clock::now();
  try {
    Serial here;
    (spread_ ? context_.parallel() : here).for_each(values.size(), work);
  } catch (const Unfinished&) {
    if (evaluations_ > last_row_) add_row();
    write_history();
    throw;
  }
  spread_ = std::chrono::steady_clock::now() - begin > kWorthThreads;
  return values;
}

void Tuning::note(const Candidates& candidates, const std::vector<double>& values) {
  std::vector<double> x(candidates.points.columns());
  for (std::size_t i = 0; i < values.size(); ++i) {
    ++evaluations_;
    if (!std::isfinite(values[i])) ++not_finite_;
    if (std::isfinite(values[i])) best_observed_ = std::max(best_observed_, values[i]);
    candidates.points.row(i, x);
    const bool exact = !target_.noisy();
    improvements_.add(evaluations_, exact ? values[i] : target_.true_value(x).value_or(values[i]));
  }
}

std::vector<std::string> Tuning::measures(const Optimizer& optimizer, bool optimum_known) {
  std::vector<std::string> names = {"best_value"};
  if (optimum_known) names.emplace_back("gap");
  for (const std::string& measure : optimizer.measures()) names.push_back(measure);
  return names;
}

void Tuning::add_row() {
  TrainingProgress row{evaluations_, task_.budget, {{"best_value", search_->best_value()}}};
  const std::optional<double> optimum = target_.optimum(), best = improvements_.best();
  if (optimum && best) row.measures.emplace_back("gap", *optimum - *best);
  const std::vector<double> values = search_->measures();
  for (std::size_t i = 0; i < names_.size(); ++i) row.measures.emplace_back(names_[i], values[i]);
  history_.add(row);
  last_row_ = evaluations_;
  next_row_ = evaluations_ + task_.budget / kHistoryRows;
}

std::string Tuning::stop_reason() const {
  const std::string reason = search_->stop_reason();
  if (!reason.empty()) return reason;
  return reached_target() ? "target" : "budget";
}

void Tuning::write_history() const {
  write_table(context_.folder() / kProgressFile, history_.table());
  write_table(context_.folder() / kImprovementsFile, improvements_.table(target_.optimum()));
}

Table Tuning::summary() const {
  using Type = ColumnInfo::Type;
  Table table;
  table.columns = {{"evaluations", Type::integer, "", "Evaluations made, repeated ones included."},
                   {"not_finite", Type::integer, "", "Those whose value was not a finite number."},
                   {"best_value", Type::number, "", "Value of the best point as the search estimates it."},
                   {"best_observed", Type::number, "", "Largest value of an evaluation; lucky, under noise."},
                   {"stop_reason", Type::text, "", "Why the search ended."}};
  table.rows.push_back({evaluations_, not_finite_, search_->best_value(), best_observed_, stop_reason()});
  return table;
}

Archive Tuning::state() const {
  Archive archive;
  archive.put("counts", std::vector<std::int64_t>{evaluations_, not_finite_, last_row_, next_row_});
  archive.put("best_observed", std::vector<double>{best_observed_});
  const auto save = [&](const char* part, const auto& what) {
    const Archive::Scope scope(archive, part);
    what.save(archive);
  };
  save("search", *search_);
  save("history", history_);
  save("improvements", improvements_);
  return archive;
}

void Tuning::load(Archive& archive) {
  const auto counts = archive.get<std::vector<std::int64_t>>("counts");
  const auto observed = archive.get<std::vector<double>>("best_observed");
  if (counts.size() != 4 || observed.size() != 1) throw std::runtime_error("not the counts of a search");
  evaluations_ = counts[0];
  not_finite_ = counts[1];
  last_row_ = counts[2];
  next_row_ = counts[3];
  best_observed_ = observed[0];
  const auto load = [&](const char* part, auto& what) {
    const Archive::Scope scope(archive, part);
    what.load(archive);
  };
  load("search", *search_);
  load("history", history_);
  load("improvements", improvements_);
}

}  // namespace coppice
