#include "reports/metric.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "engine/data/table_file.h"
#include "engine/graph/artifacts.h"

namespace coppice {
namespace {

/// How a metric comes from the columns of an evaluation.
struct Source {
  const char* name;
  const char* mean;
  const char* sd;  ///< over episodes; null for a share
  const char* skewness;
  const char* returns;  ///< of each episode: column of returns.csv
  double sign;
  std::optional<Better> better;  ///< nothing: depends on what the end of an episode means
  const char* doc;
  bool of_fit = false;
};
constexpr std::array<Source, 9> kSources = {{
    {"cost", "mean_return", "sd", "skewness", "return", -1, Better::lower, "cost (minus the sum of rewards)"},
    {"return", "mean_return", "sd", "skewness", "return", 1, Better::higher, "return (sum of rewards)"},
    {"discounted_return", "mean_discounted_return", "sd_discounted_return", "skewness_discounted_return",
     "discounted_return", 1, Better::higher, "discounted return"},
    {"discounted_cost", "mean_discounted_return", "sd_discounted_return", "skewness_discounted_return",
     "discounted_return", -1, Better::lower, "discounted cost (minus the discounted sum of rewards)"},
    {"steps", "mean_steps", "sd_steps", "skewness_steps", "steps", 1, std::nullopt,
     "number of steps of an episode"},
    {"terminal_rate", "terminal_rate", nullptr, nullptr, "terminal", 1, std::nullopt,
     "share of episodes that end in a terminal state"},
    {"rmse", "rmse", nullptr, nullptr, nullptr, 1, Better::lower, "root mean squared error", true},
    {"r2", "r2", nullptr, nullptr, nullptr, 1, Better::higher, "share of the variance that is explained",
     true},
    {"leaves", "leaves", nullptr, nullptr, nullptr, 1, Better::lower, "number of leaves", true},
}};

const Source& source(Metric metric) {
  return kSources.at(static_cast<std::size_t>(metric));
}

Observation observe_fit(const InputNode& node, const Source& from) {
  const Table table = read_table(node.folder / kScoresFile);
  if (!table.has(from.mean)) {
    throw std::invalid_argument(fmt::format("the function of '{}' has no {}", node.id, from.name));
  }
  const std::vector<Cell>& row = table.rows.back();
  Observation seen;
  seen.episodes = static_cast<std::int64_t>(number(row[table.column("samples")]));
  seen.mean = number(row[table.column(from.mean)]);
  seen.is_fit = true;
  return seen;
}

/// Of n zeros and ones, as standard_deviation and sample_skewness have it.
Moments moments_of_share(double n, double share) {
  const double squares = share * (1 - share);
  if (!(squares > 0)) return {n, share, n < 2 ? std::numeric_limits<double>::quiet_NaN() : 0, 0};
  const double deviation = std::sqrt(squares * n / (n - 1));
  const double cubes = squares * (1 - 2 * share) / (deviation * deviation * deviation);
  return {n, share, deviation, cubes * n * n / ((n - 1) * (n - 2))};
}

}  // namespace

std::vector<std::string> metric_names() {
  std::vector<std::string> names;
  for (const Source& metric : kSources) names.emplace_back(metric.name);
  return names;
}

bool is_share(Metric metric) {
  return metric == Metric::terminal_rate;
}

std::string metric_doc(Metric metric) {
  return source(metric).doc;
}

void require_metric(const std::vector<InputNode>& nodes, Metric metric) {
  const std::string artifact = source(metric).of_fit ? "fit" : "evaluation";
  for (const InputNode& node : nodes) {
    if (std::find(node.makes.begin(), node.makes.end(), artifact) != node.makes.end()) continue;
    throw std::invalid_argument(fmt::format("'{}' is of {}, and '{}' (<{}>) makes none", source(metric).name,
                                            source(metric).of_fit ? "fits" : "evaluations", node.id,
                                            node.kind));
  }
}

std::vector<std::string> direction_names() {
  return {"auto", "higher", "lower"};
}

std::optional<Better> better(Metric metric, Direction given) {
  if (given == Direction::automatic) return source(metric).better;
  return given == Direction::higher ? Better::higher : Better::lower;
}

Better require_better(Metric metric, Direction given) {
  if (const std::optional<Better> known = better(metric, given)) return *known;
  throw std::invalid_argument(
      fmt::format("better: whether a high or a low {} is good depends on what the end of an episode means; "
                  "give better=\"higher\" or better=\"lower\"",
                  source(metric).name));
}

Observation observe(const InputNode& node, Metric metric) {
  if (source(metric).of_fit) return observe_fit(node, source(metric));
  const Table table = read_table(node.folder / kEvaluationFile);
  const std::vector<Cell>& row = table.rows.at(0);
  const auto value = [&](const char* column) { return number(row[table.column(column)]); };
  const Source& from = source(metric);
  const double n = value("episodes");
  Observation seen;
  seen.episodes = static_cast<std::int64_t>(n);
  seen.mean = from.sign * value(from.mean);
  if (is_share(metric)) {
    seen.moments = moments_of_share(n, seen.mean);
    seen.ci95 = share_interval(seen.mean, n);
  } else {
    seen.moments = {n, seen.mean, value(from.sd), from.sign * value(from.skewness)};
    seen.ci95 = confidence_interval(mean_estimate(seen.moments));
  }
  return seen;
}

std::vector<double> observe_episodes(const InputNode& node, Metric metric) {
  if (source(metric).of_fit) return {};
  std::error_code code;
  if (!std::filesystem::exists(node.folder / kReturnsFile, code)) return {};
  const Table table = read_table(node.folder / kReturnsFile);
  const std::size_t column = table.column(source(metric).returns);
  std::vector<double> values;
  for (const std::vector<Cell>& row : table.rows) values.push_back(source(metric).sign * number(row[column]));
  return values;
}

}  // namespace coppice
