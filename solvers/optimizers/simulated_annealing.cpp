#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/vocabulary/elementary.h"
#include "solvers/optimizers/box.h"
#include "solvers/optimizers/generations.h"
#include "solvers/optimizers/paired_choice.h"

namespace coppice {
namespace {

/// Simulated annealing with a linear profile of temperature and of neighbourhood (thesis, A.3). Departs from
/// the thesis's in that it returns the best point, not the last; that the temperature may be found from the
/// values; and that under noise the point in memory is evaluated anew beside each neighbour, on the same
/// scenario.
class SimulatedAnnealing : public Optimizer {
 public:
  std::optional<double> temperature;
  double cooling = 1;
  double neighbourhood_cooling = 1;
  int finalists = 8;
  double final_share = 0.1;

  std::unique_ptr<Search> start(const SearchTask& task) const override;
  std::vector<std::string> measures() const override { return {"temperature", "accepted"}; }

  static Parameters<SimulatedAnnealing> parameters() {
    return Parameters<SimulatedAnnealing>()
        .automatic(
            "temperature", &SimulatedAnnealing::temperature, "",
            "T0 of the linear profile T = T0 (n - k) / n (Eq. A.1), in units of the value; auto: a hundredth "
            "of the standard deviation of the first values (of a twentieth of the budget, 100 at most), "
            "until "
            "when it is 0.",
            at_least(0))
        .add("cooling", &SimulatedAnnealing::cooling, "", "The profile is raised to this power; 1: Eq. A.1.",
             between(0.1, 20))
        .add("neighbourhood_cooling", &SimulatedAnnealing::neighbourhood_cooling, "",
             "So is (n - k) / n in the size of the neighbourhood; 1: Eq. A.2.", between(0.1, 20))
        .add("finalists", &SimulatedAnnealing::finalists, "",
             "Points of a noisy search that come into the final choice.", between(1, 1000))
        .add("final_share", &SimulatedAnnealing::final_share, "",
             "Part of a noisy search's budget for that choice, by paired evaluations.", between(0, 0.9));
  }
};

/// A point, the sum of its values and their number.
struct State {
  std::vector<double> x;
  double sum = 0;
  double count = 0;
  double mean() const { return comparable(sum / count); }
};

class Annealing : public Generations {
 public:
  Annealing(const SimulatedAnnealing& method, const SearchTask& task) : Generations(task), method_(method) {
    if (!task.noisy) {
      iterations_ = task.budget;
      return;
    }
    final_ = static_cast<std::int64_t>(method.final_share * static_cast<double>(task.budget));
    iterations_ = (task.budget - final_ + 1) / 2;  // the first evaluates one point, others two
  }

  std::vector<double> best() const override {
    if (choice_.finalists() > 0) return choice_.best_point();
    return task().noisy && !current_.x.empty() ? current_.x : best_.x.empty() ? first_point(task()) : best_.x;
  }
  double best_value() const override {
    const double chosen = choice_.best_value();
    if (!std::isnan(chosen)) return chosen;
    const State& state = task().noisy ? current_ : best_;
    return state.count > 0 ? state.mean() : std::numeric_limits<double>::quiet_NaN();
  }
  std::vector<double> measures() const override {
    return {temperature(), k_ > 0 ? static_cast<double>(accepted_) / static_cast<double>(k_) : 0};
  }

 protected:
  Candidates next_generation(std::int64_t) override {
    if (choice_.finalists() > 0) return choice_.next_round();
    const bool again = task().noisy && k_ > 0;
    Candidates generation{Matrix(again ? 2 : 1, dimension()), {}};
    generation.points.set_row(0, k_ == 0 ? first_point(task()) : neighbour());
    if (again) generation.points.set_row(1, current_.x);
    generation.scenarios.assign(generation.points.rows(), static_cast<std::uint64_t>(k_));
    return generation;
  }

  void learn(const Candidates& generation, std::span<const double> values) override {
    if (choice_.finalists() > 0) return choice_.learn(values);
    estimate_temperature(values[0]);
    State proposed{std::vector<double>(dimension()), values[0], 1};
    generation.points.row(0, proposed.x);
    if (best_.x.empty() || (!task().noisy && values[0] > best_.mean())) best_ = proposed;
    if (k_ == 0) {
      current_ = std::move(proposed);
    } else {
      if (values.size() > 1) {
        current_.sum += values[1];
        ++current_.count;
      }
      const double loss = (values.size() > 1 ? values[1] : current_.mean()) - values[0];
      if (accepts(loss)) move_to(std::move(proposed));
    }
    if (++k_ == iterations_ && task().noisy) choose();
  }

  void save_method(Archive& archive) const override;
  void load_method(Archive& archive) override;

 private:
  double profile() const {  // (n - k) / n
    return static_cast<double>(iterations_ - k_) / static_cast<double>(iterations_);
  }
  double temperature() const {  // Eq. A.1
    const double highest = method_.temperature ? *method_.temperature : estimate_;
    return highest * elementary::pow(profile(), method_.cooling);
  }
  std::vector<double> neighbour() const {  // Eq. A.2, moved into the box
    const double size = elementary::pow(profile(), method_.neighbourhood_cooling);
    const Draws draws = task().draws.scenario(static_cast<std::uint64_t>(k_));
    std::vector<double> x = current_.x;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double amplitude = task().box[i].high - task().box[i].low;
      x[i] += size * amplitude * draws.uniform("neighbour", -1, 1, static_cast<std::uint32_t>(i));
    }
    clip(task().box, x);
    return x;
  }
  /// With probability exp(-loss / T).
  bool accepts(double loss) const {
    if (std::isnan(loss)) return true;  // both infinite: any is as good
    if (loss <= 0) return true;
    const double t = temperature();
    if (!(t > 0)) return false;
    return task().draws.scenario(static_cast<std::uint64_t>(k_)).uniform("accept", 0, 1) <
           elementary::exp(-loss / t);
  }
  void move_to(State proposed) {
    ++accepted_;
    keep_finalist();
    current_ = std::move(proposed);
  }

  void estimate_temperature(double value) {
    const std::int64_t first = std::clamp<std::int64_t>(iterations_ / 20, 2, 100);
    if (k_ >= first || method_.temperature) return;
    if (std::isfinite(value)) first_values_.push_back(value);
    if (k_ + 1 < first || first_values_.size() < 2) return;
    double mean = 0, squares = 0;
    const auto count = static_cast<double>(first_values_.size());
    for (const double v : first_values_) mean += v / count;
    for (const double v : first_values_) squares += (v - mean) * (v - mean) / (count - 1);
    estimate_ = 0.01 * std::sqrt(squares);
  }

  /// Keeps the point in memory, which is about to be left, when it is among the best by its own mean. The
  /// value that made it enter is not in question alone: it was evaluated again at each step since.
  void keep_finalist() {
    if (!task().noisy || current_.count < 2) return;
    finalists_.push_back(current_);
    std::stable_sort(finalists_.begin(), finalists_.end(),
                     [](const State& a, const State& b) { return a.mean() > b.mean(); });
    if (finalists_.size() + 1 > static_cast<std::size_t>(method_.finalists)) {
      finalists_.resize(static_cast<std::size_t>(method_.finalists) - 1);
    }
  }
  void choose() {
    Matrix points(finalists_.size() + 1, dimension());
    points.set_row(0, current_.x);  // first: it wins a tie
    for (std::size_t i = 0; i < finalists_.size(); ++i) points.set_row(i + 1, finalists_[i].x);
    const std::int64_t left = task().budget - (2 * iterations_ - 1);
    if (left > 0) choice_ = PairedChoice(std::move(points), left, static_cast<std::uint64_t>(k_));
  }

  const SimulatedAnnealing method_;
  std::int64_t iterations_ = 0;  ///< n of Eq. A.1
  std::int64_t final_ = 0;       ///< evaluations for the final choice
  std::int64_t k_ = 0;           ///< iterations done
  std::int64_t accepted_ = 0;
  State current_, best_;  ///< best: without noise
  double estimate_ = 0;   ///< of T0
  std::vector<double> first_values_;
  std::vector<State> finalists_;  ///< best first
  PairedChoice choice_;
};

void save_state(Archive& archive, std::string_view name, const State& state) {
  Archive::Scope scope(archive, name);
  archive.put("x", state.x);
  archive.put("value", std::vector<double>{state.sum, state.count});
}

State load_state(Archive& archive, std::string_view name, std::size_t dimension) {
  Archive::Scope scope(archive, name);
  const std::vector<double> value = load_numbers(archive, "value", 2);
  State state{archive.get<std::vector<double>>("x"), value[0], value[1]};
  if (!state.x.empty() && state.x.size() != dimension)
    throw std::runtime_error("search: a point of another size");
  return state;
}

void Annealing::save_method(Archive& archive) const {
  archive.put("counts",
              std::vector<std::int64_t>{k_, accepted_, static_cast<std::int64_t>(finalists_.size())});
  save_state(archive, "current", current_);
  save_state(archive, "best", best_);
  save_number(archive, "estimate", estimate_);
  archive.put("first_values", first_values_);
  for (std::size_t i = 0; i < finalists_.size(); ++i) {
    save_state(archive, "finalist" + std::to_string(i), finalists_[i]);
  }
  choice_.save(archive);
}

void Annealing::load_method(Archive& archive) {
  const auto counts = archive.get<std::vector<std::int64_t>>("counts");
  if (counts.size() != 3) throw std::runtime_error("search: counts of annealing are missing");
  k_ = counts[0];
  accepted_ = counts[1];
  current_ = load_state(archive, "current", dimension());
  best_ = load_state(archive, "best", dimension());
  estimate_ = load_number(archive, "estimate");
  first_values_ = archive.get<std::vector<double>>("first_values");
  finalists_.clear();
  for (std::int64_t i = 0; i < counts[2]; ++i) {
    finalists_.push_back(load_state(archive, "finalist" + std::to_string(i), dimension()));
  }
  choice_.load(archive, dimension());
}

std::unique_ptr<Search> SimulatedAnnealing::start(const SearchTask& task) const {
  check_boxed_task(task, "simulated_annealing");
  return std::make_unique<Annealing>(*this, task);
}

const Component<Optimizer, SimulatedAnnealing> kSimulatedAnnealing(
    "simulated_annealing", "Simulated annealing with linear profiles; returns the best point.",
    "L. Hofer's thesis (2017), Eq. A.1 and A.2; Kirkpatrick, Gelatt and Vecchi, Science 220 (1983)");

}  // namespace
}  // namespace coppice
