#include "solvers/optimizers/cma_es_search.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/vocabulary/elementary.h"
#include "solvers/optimizers/box.h"

namespace coppice {
namespace {

constexpr std::size_t kMostFull = 200;      // parameters with a full covariance when it is automatic
constexpr std::size_t kMostFinalists = 16;  // the oldest go first

bool separable(const CmaEs& method, std::size_t n) {
  return method.covariance == CmaEs::Covariance::separable ||
         (method.covariance == CmaEs::Covariance::automatic && n > kMostFull);
}

Matrix with_row(const Matrix& matrix, std::span<const double> row) {
  const std::size_t skipped = matrix.rows() == kMostFinalists ? 1 : 0;
  Matrix result(matrix.rows() - skipped + 1, row.size());
  for (std::size_t c = 0; c < row.size(); ++c) {
    for (std::size_t r = skipped; r < matrix.rows(); ++r) result(r - skipped, c) = matrix(r, c);
  }
  result.set_row(result.rows() - 1, row);
  return result;
}

}  // namespace

CmaSearch::CmaSearch(const CmaEs& method, const SearchTask& task)
    : Generations(task),
      method_(method),
      map_(task.box),
      testing_(method.noise == CmaEs::Noise::on || (method.noise == CmaEs::Noise::automatic && task.noisy)),
      settings_(first_settings()),
      start_(map_.inside_out(first_point(task))),
      finalists_(0, task.box.size()) {
  begin_run();
}

CmaRunSettings CmaSearch::first_settings() const {
  const std::size_t n = dimension();
  const std::size_t population =
      method_.population ? static_cast<std::size_t>(*method_.population) : default_population(n);
  return {.population = population,
          .refining_population = population,
          .sigma = method_.sigma,
          .active = method_.active,
          .separable = separable(method_, n),
          .tolerance = method_.tolerance};
}

void CmaSearch::begin_run() {
  run_ = std::make_unique<CmaRun>(settings_, start_);
  run_began_ = evaluations_;
}

std::vector<double> CmaSearch::point_at(std::span<const double> coordinates) const {
  std::vector<double> point(dimension());
  map_.into(coordinates, point);
  return point;
}

/// Under noise the mean of the distribution, never the luckiest sample.
std::vector<double> CmaSearch::estimate() const {
  return point_at(average_.empty() ? run_->distribution().mean() : average_.mean());
}

std::vector<double> CmaSearch::best() const {
  if (choosing_) return choice_.best_point();
  if (test_.values_differ()) return estimate();
  return best_.empty() ? first_point(task()) : best_;
}

double CmaSearch::best_value() const {
  if (choosing_ && !std::isnan(choice_.best_value())) return choice_.best_value();
  if (test_.values_differ()) return noisy_value_;
  return best_.empty() ? std::numeric_limits<double>::quiet_NaN() : best_value_;
}

std::vector<double> CmaSearch::measures() const {
  const CmaLearningRates* learning = run_->learning_rates();
  return {run_->distribution().sigma(), static_cast<double>(run_->population()),
          static_cast<double>(restarts_), test_.changes(), learning != nullptr ? learning->mean_rate() : 1};
}

Candidates CmaSearch::begin_choice(std::int64_t left) {
  finalists_ = with_row(finalists_, estimate());
  finalists_ = with_row(finalists_, point_at(run_->distribution().mean()));
  choice_ = PairedChoice(finalists_, left, 2 * static_cast<std::uint64_t>(generation_));
  choosing_ = true;
  return choice_.next_round();
}

Candidates CmaSearch::next_generation(std::int64_t left) {
  if (choosing_) return choice_.next_round();
  const auto reserved = static_cast<std::int64_t>(method_.final_share * static_cast<double>(task().budget));
  if (test_.values_differ() && left - reserved < static_cast<std::int64_t>(run_->population())) {
    return begin_choice(left);
  }
  const std::vector<double>& points =
      run_->sample(task().draws.stream("cma_es", static_cast<std::uint64_t>(generation_)), map_);
  const std::size_t n = dimension(), population = run_->population();
  const std::size_t repeated =
      testing_ && !run_->learning_rates() ? std::min(test_.repetitions(generation_), population) : 0;
  const std::size_t size = std::min(population + repeated, static_cast<std::size_t>(left));
  Candidates candidates{Matrix(size, n), {}};
  std::vector<double> point(n);
  const auto scenario = 2 * static_cast<std::uint64_t>(generation_);
  for (std::size_t i = 0; i < size; ++i) {
    const bool again = i >= population;
    map_.into({points.data() + (again ? i - population : i) * n, n}, point);
    candidates.points.set_row(i, point);
    candidates.scenarios.push_back(again ? scenario + 1 : scenario);
  }
  return candidates;
}

void CmaSearch::learn(const Candidates& generation, std::span<const double> values) {
  evaluations_ += static_cast<std::int64_t>(values.size());
  if (choosing_) {
    choice_.learn(values);
    return;
  }
  if (values.size() > run_->population()) test_noise(values);
  update_run(generation, values);
  ++generation_;
}

void CmaSearch::test_noise(std::span<const double> values) {
  const std::size_t population = run_->population();
  const std::size_t repeated = values.size() - population;
  test_.learn(generation_, values.first(repeated), values.subspan(population));
  if (test_.disturbed()) run_->expect_noise();
}

void CmaSearch::update_run(const Candidates& generation, std::span<const double> values) {
  const std::size_t population = run_->population();
  const auto first = values.first(std::min(values.size(), population));
  const auto winner = static_cast<std::size_t>(std::max_element(first.begin(), first.end()) - first.begin());
  const bool improved = first[winner] > best_value_ || best_.empty();
  if (improved) {
    best_value_ = first[winner];
    best_.resize(dimension());
    generation.points.row(winner, best_);
  }
  if (first.size() < population) return;  // the budget ends here
  const bool inject = method_.elitist && !improved && !test_.values_differ();
  run_->update(first, best_value_, inject ? map_.inside_out(best_) : std::vector<double>{});
  if (run_->learning_rates()) average_.add(run_->distribution().mean());
  std::vector<double> sorted(first.begin(), first.end());
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(population / 2),
                   sorted.end());
  noisy_value_ = sorted[population / 2];
  if (!run_->stop_reason().empty()) end_run();
}

void CmaSearch::end_run() {
  if (method_.restarts == CmaEs::Restarts::none || restarts_ >= method_.max_restarts) {
    stop(run_->stop_reason());
    return;
  }
  if (test_.values_differ()) finalists_ = with_row(finalists_, estimate());
  (small_ ? small_spent_ : large_spent_) += evaluations_ - run_began_;
  restart();
}

/// IPOP: the population grows (Auger and Hansen 2005). BIPOP: whichever of two regimes has spent less goes
/// on, the other one with populations and deviations drawn (Hansen 2009).
void CmaSearch::restart() {
  ++restarts_;
  settings_ = first_settings();
  Stream stream = task().draws.stream("cma_es_restart", static_cast<std::uint64_t>(restarts_));
  small_ = method_.restarts == CmaEs::Restarts::bipop && doublings_ > 0 && small_spent_ < large_spent_;
  if (!small_) ++doublings_;
  const double largest = elementary::pow(method_.growth, static_cast<double>(doublings_));
  const double u = stream.uniform(), v = stream.uniform();
  const double factor = small_ ? std::max(1.0, elementary::pow(0.5 * largest, u * u)) : largest;
  const double population = static_cast<double>(settings_.population) * factor;
  settings_.population =
      static_cast<std::size_t>(std::clamp(population, 2.0, static_cast<double>(task().budget) + 2));
  if (small_) settings_.sigma *= elementary::pow(10, -2 * v);
  for (std::size_t i = 0; i < dimension(); ++i) {
    const Axis& axis = task().box[i];
    const double place = stream.uniform();
    if (std::isfinite(axis.low) && std::isfinite(axis.high)) start_[i] = place;
  }
  average_ = {};
  begin_run();
}

void CmaSearch::save_method(Archive& archive) const {
  archive.put("integers",
              std::vector<std::int64_t>{generation_, evaluations_, restarts_, doublings_, large_spent_,
                                        small_spent_, run_began_, small_ ? 1 : 0, choosing_ ? 1 : 0,
                                        static_cast<std::int64_t>(settings_.population)});
  archive.put("numbers", std::vector<double>{best_value_, noisy_value_, settings_.sigma});
  archive.put("start", start_);
  archive.put("best", best_);
  save_matrix(archive, "finalists", finalists_);
  test_.save(archive);
  const auto part = [&](const char* name, const auto& object) {
    const Archive::Scope scope(archive, name);
    object.save(archive);
  };
  part("average", average_);
  part("run", *run_);
  part("choice", choice_);
}

void CmaSearch::load_method(Archive& archive) {
  const auto& integers = archive.get<std::vector<std::int64_t>>("integers");
  generation_ = integers.at(0);
  evaluations_ = integers.at(1);
  restarts_ = integers.at(2);
  doublings_ = integers.at(3);
  large_spent_ = integers.at(4);
  small_spent_ = integers.at(5);
  run_began_ = integers.at(6);
  small_ = integers.at(7) != 0;
  choosing_ = integers.at(8) != 0;
  settings_.population = static_cast<std::size_t>(integers.at(9));
  const std::vector<double> numbers = load_numbers(archive, "numbers", 3);
  best_value_ = numbers[0];
  noisy_value_ = numbers[1];
  settings_.sigma = numbers[2];
  start_ = load_numbers(archive, "start", dimension());
  best_ = archive.get<std::vector<double>>("best");
  finalists_ = load_matrix(archive, "finalists", dimension());
  test_.load(archive);
  run_ = std::make_unique<CmaRun>(settings_, start_);
  {
    const Archive::Scope scope(archive, "average");
    average_.load(archive);
  }
  {
    const Archive::Scope scope(archive, "run");
    run_->load(archive);
  }
  const Archive::Scope scope(archive, "choice");
  choice_.load(archive, dimension());
}

}  // namespace coppice
