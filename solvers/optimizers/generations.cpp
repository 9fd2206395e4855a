#include "solvers/optimizers/generations.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "solvers/optimizers/box.h"

namespace coppice {

Candidates Generations::ask(std::int64_t limit) {
  if (limit < 1) throw std::invalid_argument("a search must be asked for at least one candidate");
  asked_ = 0;
  if (!stop_reason_.empty()) return {Matrix(0, dimension()), {}};
  if (values_.size() == generation_.points.rows()) {
    generation_ = next_generation(task_.budget - told_);
    values_.clear();
    if (generation_.points.rows() == 0) {
      if (stop_reason_.empty()) throw std::logic_error("a search made no candidates, but did not stop");
      return {Matrix(0, dimension()), {}};
    }
  }
  const std::size_t left = generation_.points.rows() - values_.size();
  asked_ = static_cast<std::size_t>(std::min(limit, static_cast<std::int64_t>(left)));
  return rows_of(generation_, values_.size(), values_.size() + asked_);
}

void Generations::tell(std::span<const double> values) {
  if (values.size() != asked_) {
    throw std::logic_error(
        fmt::format("{} candidates were asked for, {} values told", asked_, values.size()));
  }
  asked_ = 0;
  for (const double value : values) values_.push_back(comparable(value));
  told_ += static_cast<std::int64_t>(values.size());
  if (values.empty() || values_.size() < generation_.points.rows()) return;
  learn(generation_, values_);
  if (stop_reason_.empty() && told_ >= task_.budget) stop("budget");
}

void Generations::save(Archive& archive) const {
  save_candidates(archive, generation_);
  archive.put("values", values_);
  save_integer(archive, "told", told_);
  archive.put("stop_reason", stop_reason_);
  Archive::Scope scope(archive, "method");
  save_method(archive);
}

void Generations::load(Archive& archive) {
  generation_ = load_candidates(archive, dimension());
  values_ = archive.get<std::vector<double>>("values");
  if (values_.size() > generation_.points.rows())
    throw std::runtime_error("search: more values than candidates");
  told_ = load_integer(archive, "told");
  stop_reason_ = archive.get<std::string>("stop_reason");
  asked_ = 0;
  Archive::Scope scope(archive, "method");
  load_method(archive);
}

Candidates rows_of(const Candidates& candidates, std::size_t begin, std::size_t end) {
  const std::size_t columns = candidates.points.columns();
  Candidates part{Matrix(end - begin, columns), {}};
  for (std::size_t c = 0; c < columns; ++c) {
    const std::span<const double> from = candidates.points.column(c).subspan(begin, end - begin);
    std::copy(from.begin(), from.end(), part.points.column(c).begin());
  }
  part.scenarios.assign(candidates.scenarios.begin() + static_cast<std::ptrdiff_t>(begin),
                        candidates.scenarios.begin() + static_cast<std::ptrdiff_t>(end));
  return part;
}

void save_matrix(Archive& archive, std::string_view name, const Matrix& matrix) {
  archive.put(name, std::vector<double>(matrix.values().begin(), matrix.values().end()));
}

Matrix load_matrix(const Archive& archive, std::string_view name, std::size_t columns) {
  const auto& values = archive.get<std::vector<double>>(name);
  if (columns == 0 || values.size() % columns != 0) {
    throw std::runtime_error(
        fmt::format("search: {} has {} numbers, which make no rows of {}", name, values.size(), columns));
  }
  Matrix matrix(values.size() / columns, columns);
  std::copy(values.begin(), values.end(), matrix.values().begin());
  return matrix;
}

void save_candidates(Archive& archive, const Candidates& candidates) {
  save_matrix(archive, "points", candidates.points);
  archive.put("scenarios",
              std::vector<std::int64_t>(candidates.scenarios.begin(), candidates.scenarios.end()));
}

Candidates load_candidates(const Archive& archive, std::size_t columns) {
  Candidates candidates{load_matrix(archive, "points", columns), {}};
  const auto& scenarios = archive.get<std::vector<std::int64_t>>("scenarios");
  if (scenarios.size() != candidates.points.rows()) {
    throw std::runtime_error("search: the numbers of points and of scenarios differ");
  }
  candidates.scenarios.assign(scenarios.begin(), scenarios.end());
  return candidates;
}

void save_integer(Archive& archive, std::string_view name, std::int64_t value) {
  archive.put(name, std::vector<std::int64_t>{value});
}

std::int64_t load_integer(const Archive& archive, std::string_view name) {
  const auto& values = archive.get<std::vector<std::int64_t>>(name);
  if (values.size() != 1) throw std::runtime_error(fmt::format("search: {} is not one number", name));
  return values.front();
}

void save_number(Archive& archive, std::string_view name, double value) {
  archive.put(name, std::vector<double>{value});
}

double load_number(const Archive& archive, std::string_view name) {
  return load_numbers(archive, name, 1)[0];
}

std::vector<double> load_numbers(const Archive& archive, std::string_view name, std::size_t size) {
  const auto& values = archive.get<std::vector<double>>(name);
  if (values.size() != size) {
    throw std::runtime_error(
        fmt::format("search: {} has {} numbers, expected are {}", name, values.size(), size));
  }
  return values;
}

}  // namespace coppice
