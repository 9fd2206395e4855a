#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/vocabulary/optimizer.h"

namespace coppice {

/// A search that goes on by generations: makes some candidates, learns from the values of all of them, makes
/// the next. Hands generations out in pieces of any size and keeps the budget, so that methods need not.
class Generations : public Search {
 public:
  Candidates ask(std::int64_t limit) final;
  void tell(std::span<const double> values) final;
  std::string stop_reason() const final { return stop_reason_; }
  void save(Archive& archive) const final;
  void load(Archive& archive) final;

 protected:
  /// The task must be one (check_task).
  explicit Generations(SearchTask task) : task_(std::move(task)) {}

  /// The next candidates, at least 1 and at most `left`, all inside the box; none after stop().
  virtual Candidates next_generation(std::int64_t left) = 0;
  /// The values of all of them, none of them NaN (-infinity instead).
  virtual void learn(const Candidates& generation, std::span<const double> values) = 0;
  virtual void save_method(Archive& archive) const = 0;
  virtual void load_method(Archive& archive) = 0;

  void stop(std::string reason) { stop_reason_ = std::move(reason); }
  const SearchTask& task() const { return task_; }
  std::size_t dimension() const { return task_.box.size(); }

 private:
  const SearchTask task_;
  Candidates generation_;       ///< asked, or to be asked
  std::vector<double> values_;  ///< told of its first rows
  std::size_t asked_ = 0;       ///< rows of the last ask
  std::int64_t told_ = 0;       ///< evaluations in all
  std::string stop_reason_;
};

/// Rows [begin, end) of candidates.
Candidates rows_of(const Candidates& candidates, std::size_t begin, std::size_t end);

// Candidates in archives, as "points" and "scenarios".
void save_candidates(Archive& archive, const Candidates& candidates);
/// Throws std::runtime_error unless they have `columns` numbers each.
Candidates load_candidates(const Archive& archive, std::size_t columns);
void save_matrix(Archive& archive, std::string_view name, const Matrix& matrix);
Matrix load_matrix(const Archive& archive, std::string_view name, std::size_t columns);

// Single numbers in archives. (No method has so many that an array of one is a waste.)
void save_integer(Archive& archive, std::string_view name, std::int64_t value);
std::int64_t load_integer(const Archive& archive, std::string_view name);
void save_number(Archive& archive, std::string_view name, double value);
double load_number(const Archive& archive, std::string_view name);
/// Throws std::runtime_error unless there are `size` of them.
std::vector<double> load_numbers(const Archive& archive, std::string_view name, std::size_t size);

}  // namespace coppice
