#include "engine/graph/nodes/evaluation_table.h"

#include <numeric>

#include "engine/statistics/estimates.h"
#include "engine/statistics/mean_estimate.h"

namespace coppice {
namespace {

/// The mean of whole numbers: their sum is exact, and divided once.
double mean_count(const auto& values) {
  const std::int64_t sum = std::accumulate(values.begin(), values.end(), std::int64_t{0});
  return static_cast<double>(sum) / static_cast<double>(values.size());
}

std::vector<double> numbers(const auto& values) {
  return {values.begin(), values.end()};
}

}  // namespace

Table evaluation_table(const Returns& returns, int horizon, double discount) {
  const double mean_return = mean(returns.total);
  const std::optional<Interval> ci = confidence_interval(mean_estimate(returns.total));
  const auto limit = [&](double Interval::*end) { return ci ? Cell((*ci).*end) : Cell(); };
  Table table;
  std::vector<Cell> row;
  const auto add = [&](std::string name, ColumnInfo::Type type, Cell cell, std::string doc) {
    table.columns.push_back({std::move(name), type, "", std::move(doc)});
    row.push_back(std::move(cell));
  };
  add("episodes", ColumnInfo::Type::integer, static_cast<std::int64_t>(returns.total.size()),
      "Episodes played.");
  add("mean_return", ColumnInfo::Type::number, mean_return,
      "Mean over the episodes of the sum of rewards, undiscounted.");
  add("mean_cost", ColumnInfo::Type::number, -mean_return, "Minus mean_return.");
  add("sd", ColumnInfo::Type::number, standard_deviation(returns.total),
      "Deviation of an episode's return (n - 1).");
  add("ci95_low", ColumnInfo::Type::number, limit(&Interval::low),
      "Lower end of the 95 % interval of mean_return over the episodes.");
  add("ci95_high", ColumnInfo::Type::number, limit(&Interval::high), "Upper end of that interval.");
  add("mean_discounted_return", ColumnInfo::Type::number, mean(returns.discounted),
      "Mean of the discounted sum of rewards.");
  add("mean_steps", ColumnInfo::Type::number, mean_count(returns.steps),
      "Mean number of steps of an episode.");
  add("terminal_rate", ColumnInfo::Type::number, mean_count(returns.terminal),
      "Share of the episodes that ended in a terminal state, before the horizon.");
  add("horizon", ColumnInfo::Type::integer, static_cast<std::int64_t>(horizon),
      "Steps of an episode at most.");
  add("discount", ColumnInfo::Type::number, discount, "Discount of a step, for the discounted return.");
  add("sd_discounted_return", ColumnInfo::Type::number, standard_deviation(returns.discounted),
      "Deviation of an episode's discounted return (n - 1).");
  add("sd_steps", ColumnInfo::Type::number, standard_deviation(numbers(returns.steps)),
      "Deviation of an episode's number of steps (n - 1).");
  add("skewness", ColumnInfo::Type::number, sample_skewness(returns.total),
      "Skewness of an episode's return.");
  add("skewness_discounted_return", ColumnInfo::Type::number, sample_skewness(returns.discounted),
      "Skewness of an episode's discounted return.");
  add("skewness_steps", ColumnInfo::Type::number, sample_skewness(numbers(returns.steps)),
      "Skewness of an episode's number of steps.");
  table.rows.push_back(std::move(row));
  return table;
}

}  // namespace coppice
