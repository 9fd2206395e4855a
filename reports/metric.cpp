#include "reports/metric.h"

#include <array>
#include <cmath>

#include "engine/data/table_file.h"
#include "engine/graph/artifacts.h"
#include "engine/statistics/intervals.h"
#include "engine/vocabulary/elementary.h"

namespace coppice {
namespace {

/// How a metric comes from the columns of an evaluation.
struct Source {
  const char* name;
  const char* mean;
  const char* sd;  ///< over episodes; null for a share
  double sign;
  Better better;
  const char* doc;
};
constexpr std::array<Source, 6> kSources = {{
    {"cost", "mean_return", "sd", -1, Better::lower, "cost (minus the sum of rewards)"},
    {"return", "mean_return", "sd", 1, Better::higher, "return (sum of rewards)"},
    {"discounted_return", "mean_discounted_return", "sd_discounted_return", 1, Better::higher,
     "discounted return"},
    {"discounted_cost", "mean_discounted_return", "sd_discounted_return", -1, Better::lower,
     "discounted cost (minus the discounted sum of rewards)"},
    {"steps", "mean_steps", "sd_steps", 1, Better::lower, "number of steps of an episode"},
    {"terminal_rate", "terminal_rate", nullptr, 1, Better::lower,
     "share of episodes that end in a terminal state"},
}};

const Source& source(Metric metric) {
  return kSources.at(static_cast<std::size_t>(metric));
}

/// Student's interval from mean and deviation.
std::optional<Interval> mean_interval(double mean, double sd, double n) {
  if (n < 2) return {};
  const double half = student_t_quantile(0.975, n - 1) * sd / std::sqrt(n);
  return Interval{mean - half, mean + half};
}

/// Wilson's score interval of a share (Journal of the American Statistical Association 22, 1927): a share of
/// 0 or 1 leaves some doubt, too.
Interval share_interval(double share, double n) {
  const double z = normal_quantile(0.975);
  const double scale = 1 + z * z / n;
  const double center = (share + z * z / (2 * n)) / scale;
  const double half = z * std::sqrt(share * (1 - share) / n + z * z / (4 * n * n)) / scale;
  return {center - half, center + half};
}

}  // namespace

std::vector<std::string> metric_names() {
  std::vector<std::string> names;
  for (const Source& metric : kSources) names.emplace_back(metric.name);
  return names;
}

std::string metric_doc(Metric metric) {
  return source(metric).doc;
}

Better better(Metric metric) {
  return source(metric).better;
}

Observation observe(const InputNode& node, Metric metric) {
  const Table table = read_table(node.folder / kEvaluationFile);
  const std::vector<Cell>& row = table.rows.at(0);
  const auto value = [&](const char* column) { return number(row[table.column(column)]); };
  const Source& from = source(metric);
  const double n = value("episodes");
  const double mean = from.sign * value(from.mean);
  return {static_cast<std::int64_t>(n), mean,
          from.sd != nullptr ? mean_interval(mean, value(from.sd), n) : share_interval(mean, n)};
}

}  // namespace coppice
