#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "solvers/optimizers/box.h"
#include "solvers/optimizers/composite_phases.h"

namespace coppice {
namespace {

constexpr std::size_t kMostProposals = 16;

/// Several optimizers, one after the other, with equal parts of the budget, which is divided once; the best
/// of their proposals (thesis, 4.1.1). What one leaves over goes to those after it; what all leave over to
/// searches from other points. Under noise the proposals come into a final choice by paired evaluations, part
/// of the budget.
class Composite : public Optimizer {
 public:
  static constexpr const char* kExample =
      "<composite><optimizers><cross_entropy/><simulated_annealing/></optimizers></composite>";
  std::vector<Sub<Optimizer>> optimizers;
  double final_share = 0.1;

  std::unique_ptr<Search> start(const SearchTask& task) const override;
  std::vector<std::string> measures() const override { return {"member"}; }
  std::int64_t final_evaluations(const SearchTask& task) const {
    if (!task.noisy) return 0;
    const auto share = static_cast<std::int64_t>(final_share * static_cast<double>(task.budget));
    return std::min(task.budget, std::max<std::int64_t>(share, static_cast<std::int64_t>(optimizers.size())));
  }

  static Parameters<Composite> parameters() {
    return Parameters<Composite>()
        .components("optimizers", &Composite::optimizers, "Its members, in the order of their searches.",
                    true)
        .add("final_share", &Composite::final_share, "",
             "Part of a noisy search's budget for the final choice between the members' proposals, by paired "
             "evaluations (one for each member at least).",
             between(0, 0.9));
  }
};

class CompositeSearch : public Search {
 public:
  CompositeSearch(const Composite& method, const SearchTask& task)
      : method_(method), task_(task), final_(method.final_evaluations(task)) {
    begin_next();
  }

  Candidates ask(std::int64_t limit) override {
    while (current_) {
      Candidates candidates = current_->ask(limit);
      if (candidates.points.rows() > 0) {
        for (const std::uint64_t number : candidates.scenarios) {
          fresh_scenario_ = std::max(fresh_scenario_, number + 1);
        }
        return candidates;
      }
      begin_next();
    }
    return {Matrix(0, task_.box.size()), {}};
  }
  void tell(std::span<const double> values) override {
    if (!current_) throw std::logic_error("a search that is over was told values");
    current_->tell(values);
    spent_ += static_cast<std::int64_t>(values.size());
    if (!current_->stop_reason().empty()) begin_next();
  }

  std::vector<double> best() const override {
    if (chosen_) return chosen_->first;
    if (phase_ == Phase::choice) return current_->best();
    const double now =
        current_ ? comparable(current_->best_value()) : -std::numeric_limits<double>::infinity();
    if (!proposals_.empty() && comparable(proposals_.front().second) >= now) return proposals_.front().first;
    return current_ ? current_->best() : first_point(task_);
  }
  double best_value() const override {
    if (chosen_) return chosen_->second;
    const double now = current_ ? current_->best_value() : std::numeric_limits<double>::quiet_NaN();
    if (phase_ == Phase::choice || proposals_.empty()) return now;
    return std::isnan(now) ? proposals_.front().second : std::max(now, proposals_.front().second);
  }
  std::string stop_reason() const override { return stop_reason_; }
  /// Which member searches, from 1; 0: none.
  std::vector<double> measures() const override {
    return {phase_ == Phase::members ? static_cast<double>(member()) + 1 : 0};
  }
  void save(Archive& archive) const override;
  void load(Archive& archive) override;

 private:
  enum class Phase { members, choice, rest, over };
  using Proposal = std::pair<std::vector<double>, double>;

  std::size_t member() const { return static_cast<std::size_t>(turn_) % method_.optimizers.size(); }
  std::int64_t left() const { return task_.budget - spent_; }

  /// What the turn's member is to do: the first time from the guess, then from elsewhere.
  SearchTask task_of(std::int64_t budget) const {
    SearchTask task = task_;
    task.budget = budget;
    task.draws = task_.draws.fork("composite", static_cast<std::uint64_t>(turn_));
    const bool boxed = std::all_of(task.box.begin(), task.box.end(),
                                   [](const Axis& axis) { return std::isfinite(axis.high - axis.low); });
    if (boxed && static_cast<std::size_t>(turn_) >= method_.optimizers.size()) {
      Stream stream = task.draws.stream("restart");
      task.guess = uniform_point(task.box, stream);
    }
    return task;
  }

  void begin_next() {
    if (current_) take_proposal();
    current_.reset();
    if (phase_ == Phase::members && begin_member()) return;
    if (phase_ == Phase::members && left() > 0 && begin_rest()) return;
    phase_ = Phase::over;
    stop_reason_ = left() > 0 ? "members_stopped" : "budget";
  }

  void take_proposal() {
    if (phase_ == Phase::choice) {
      chosen_ = {current_->best(), current_->best_value()};
      return;
    }
    proposals_.emplace_back(current_->best(), current_->best_value());
    std::stable_sort(proposals_.begin(), proposals_.end(), [](const Proposal& a, const Proposal& b) {
      return comparable(a.second) > comparable(b.second);
    });
    proposals_.resize(std::min(proposals_.size(), kMostProposals));
  }

  /// The next member that can make use of its part of what is left; false when none can.
  bool begin_member() {
    idle_ = spent_ > begun_ || turn_ < 0 ? 0 : idle_ + 1;
    for (; idle_ < method_.optimizers.size(); ++idle_) {
      ++turn_;
      begun_ = spent_;
      const auto members = static_cast<std::int64_t>(method_.optimizers.size() - member());
      budget_ = (left() - final_) / members;
      if (budget_ < 1) continue;
      try {
        current_ = method_.optimizers[member()]->start(task_of(budget_));
      } catch (const std::invalid_argument&) {  // so small a budget is not enough
        continue;
      }
      if (current_->stop_reason().empty()) return true;
    }
    return false;
  }

  bool begin_rest() {
    budget_ = left();
    if (task_.noisy) {
      Matrix points(proposals_.size(), task_.box.size());
      for (std::size_t i = 0; i < points.rows(); ++i) points.set_row(i, proposals_[i].first);
      phase_ = Phase::choice;
      current_ = std::make_unique<FinalChoice>(task_of(budget_), points, fresh_scenario_);
      return true;
    }
    for (const Axis& axis : task_.box) {
      if (!std::isfinite(axis.high - axis.low)) return false;
    }
    phase_ = Phase::rest;
    current_ = std::make_unique<Rest>(task_of(budget_));
    return true;
  }

  const Composite method_;
  const SearchTask task_;
  const std::int64_t final_;  ///< evaluations for the final choice
  Phase phase_ = Phase::members;
  std::int64_t turn_ = -1;   ///< counts the members' searches
  std::int64_t budget_ = 0;  ///< of the current search
  std::int64_t spent_ = 0;
  std::int64_t begun_ = 0;  ///< spent when the current search began
  std::size_t idle_ = 0;    ///< turns without an evaluation
  std::uint64_t fresh_scenario_ = 0;
  std::unique_ptr<Search> current_;
  std::vector<Proposal> proposals_;  ///< best first
  std::optional<Proposal> chosen_;
  std::string stop_reason_;
};

void CompositeSearch::save(Archive& archive) const {
  archive.put("state",
              std::vector<std::int64_t>{static_cast<std::int64_t>(phase_), turn_, budget_, spent_, begun_,
                                        static_cast<std::int64_t>(fresh_scenario_),
                                        chosen_.has_value() ? 1 : 0, static_cast<std::int64_t>(idle_)});
  std::vector<Proposal> proposals = proposals_;
  if (chosen_) proposals.push_back(*chosen_);
  Matrix points(proposals.size(), task_.box.size());
  std::vector<double> values;
  for (std::size_t i = 0; i < proposals.size(); ++i) {
    points.set_row(i, proposals[i].first);
    values.push_back(proposals[i].second);
  }
  save_matrix(archive, "proposals", points);
  archive.put("proposal_values", values);
  archive.put("stop_reason", stop_reason_);
  if (!current_) return;
  Archive::Scope scope(archive, "current");
  current_->save(archive);
}

void CompositeSearch::load(Archive& archive) {
  const auto state = archive.get<std::vector<std::int64_t>>("state");
  if (state.size() != 8 || state[0] < 0 || state[0] > 3 || state[1] < 0) {
    throw std::runtime_error("search: the state of a composite is damaged");
  }
  phase_ = static_cast<Phase>(state[0]);
  turn_ = state[1];
  budget_ = state[2];
  spent_ = state[3];
  begun_ = state[4];
  fresh_scenario_ = static_cast<std::uint64_t>(state[5]);
  idle_ = static_cast<std::size_t>(state[7]);
  const Matrix points = load_matrix(archive, "proposals", task_.box.size());
  const std::vector<double> values = load_numbers(archive, "proposal_values", points.rows());
  proposals_.clear();
  std::vector<double> x(task_.box.size());
  for (std::size_t i = 0; i < points.rows(); ++i) {
    points.row(i, x);
    proposals_.emplace_back(x, values[i]);
  }
  chosen_.reset();
  if (state[6] != 0 && !proposals_.empty()) {
    chosen_ = proposals_.back();
    proposals_.pop_back();
  }
  stop_reason_ = archive.get<std::string>("stop_reason");
  current_.reset();
  if (phase_ == Phase::over) return;
  if (phase_ == Phase::members) current_ = method_.optimizers[member()]->start(task_of(budget_));
  if (phase_ == Phase::choice) current_ = std::make_unique<FinalChoice>(task_of(budget_), points, 0);
  if (phase_ == Phase::rest) current_ = std::make_unique<Rest>(task_of(budget_));
  Archive::Scope scope(archive, "current");
  current_->load(archive);
}

std::unique_ptr<Search> Composite::start(const SearchTask& task) const {
  const auto members = static_cast<std::int64_t>(optimizers.size());
  const std::int64_t final = final_evaluations(task);
  check_task(task, "composite", task.noisy ? 2 * members : members);
  SearchTask part = task;
  part.budget = (task.budget - final) / members;
  for (const Sub<Optimizer>& optimizer : optimizers) {
    try {
      optimizer->start(part);
    } catch (const std::invalid_argument& refused) {
      throw std::invalid_argument(
          fmt::format("<composite>: of {} evaluations each of its {} members gets {}: {}", task.budget,
                      members, part.budget, refused.what()));
    }
  }
  return std::make_unique<CompositeSearch>(*this, task);
}

const Component<Optimizer, Composite> kComposite(
    "composite", "Divides its budget between several optimizers and takes the best of their proposals.",
    "L. Hofer's thesis (2017), 4.1.1");

}  // namespace
}  // namespace coppice
