#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string_view>

#include "engine/data/table_file.h"
#include "engine/graph/artifacts.h"
#include "engine/graph/nodes/dataset_columns.h"
#include "engine/statistics/estimates.h"

namespace coppice {
namespace {

/// The named columns of a dataset: one row of x and y for each of its rows.
struct Samples {
  Matrix x, y;
};

/// The rows of all the datasets, one after the other.
Samples read_samples(const std::vector<InputNode>& datasets, const std::vector<std::string>& inputs,
                     const std::string& output) {
  std::vector<std::string> names = inputs;
  names.push_back(output);
  const Matrix table = read_columns(datasets, names);
  Samples samples{Matrix(table.rows(), inputs.size()), Matrix(table.rows(), 1)};
  const std::span<const double> values = table.values();
  std::copy_n(values.begin(), samples.x.values().size(), samples.x.values().begin());
  std::copy_n(values.end() - static_cast<std::ptrdiff_t>(table.rows()), table.rows(),
              samples.y.values().begin());
  return samples;
}

/// One row of scores.csv: how well the function predicts a set.
std::vector<Cell> score(std::string name, const Function& function, const Samples& samples) {
  Matrix predicted(samples.y.rows(), 1);
  function.predict_batch(samples.x, predicted);
  const double center = mean(samples.y.column(0));
  double residual = 0, total = 0;
  for (std::size_t i = 0; i < predicted.rows(); ++i) {
    const double error = predicted(i, 0) - samples.y(i, 0);
    residual += error * error;
    total += (samples.y(i, 0) - center) * (samples.y(i, 0) - center);
  }
  const auto rows = static_cast<double>(predicted.rows());
  return {std::move(name), static_cast<std::int64_t>(predicted.rows()), std::sqrt(residual / rows),
          total > 0 ? 1 - residual / total : std::numeric_limits<double>::quiet_NaN()};
}

/// Supervised learning: a function from some columns of a dataset to another.
struct FitNode : Node {
  using Node::check;

  Reference samples, test;
  std::vector<std::string> inputs;
  std::string output;
  Sub<Approximator> approximator;

  std::vector<std::string> makes() const override { return {"function", "fit", "score", "timing"}; }
  std::vector<std::string> labelled_tables() const override { return {std::string(kScoresFile)}; }
  bool gathers_replicates(std::string_view parameter) const override {
    return parameter == "samples" || parameter == "test";
  }

  void check() const {
    Rules rules;
    std::set<std::string_view> before;
    for (const std::string& input : inputs) {
      if (!before.insert(input).second)
        rules.broken("inputs", fmt::format("the input '{}' stands twice", input));
      if (input == output) rules.broken("output", fmt::format("'{}' is input and output", output));
    }
    rules.enforce();
  }

  void check(const NodeContext& context) const override {
    Rules rules;
    for (const std::string_view parameter : {"samples", "test"}) {  // each must have every column
      check_columns(context.inputs(parameter), "inputs", inputs, rules);
      check_columns(context.inputs(parameter), "output", {output}, rules);
    }
    if (!test.id.empty()) check_test(context, rules);
    rules.enforce();
  }
  void run(NodeContext& context) const override {
    const Samples training = read_samples(context.inputs("samples"), inputs, output);
    const MadeFunction function =
        approximator->fit({training.x, training.y, {}}, context.draws().fork("fit"), context.parallel());
    FunctionFile file{.writer = {},
                      .provenance = context.key(),
                      .inputs = inputs,
                      .output = output,
                      .component = function.resolved,
                      .arrays = {}};
    function->save(file.arrays);
    write_function_file(context.folder() / kFunctionFile, file);

    using Type = ColumnInfo::Type;
    Table scores;
    scores.columns = {{"set", Type::text, "", "train: the samples fitted to; test: samples never seen."},
                      {"samples", Type::integer, "", "Number of samples."},
                      {"rmse", Type::number, "", "Root of the mean squared error, in the output's unit."},
                      {"r2", Type::number, "", "Share of the output's variance that is explained."}};
    scores.rows.push_back(score("train", *function, training));
    if (!test.id.empty()) {
      scores.rows.push_back(score("test", *function, read_samples(context.inputs("test"), inputs, output)));
    }
    for (const auto& [fact, value] : function->facts()) {
      scores.columns.push_back({fact, Type::number, "", "Of the function."});
      for (std::vector<Cell>& row : scores.rows) row.emplace_back(value);
    }
    write_table(context.folder() / kScoresFile, scores);
    context.count("samples", static_cast<std::int64_t>(training.x.rows()));
  }

  static Parameters<FitNode> parameters() {
    using This = FitNode;
    return node_parameters<This>()
        .reference("samples", &This::samples, "dataset", "Dataset to fit to.")
        .reference("test", &This::test, "dataset", "Dataset to score on, drawn independently of the samples.",
                   false)
        .require("inputs", &This::inputs, "", "Columns that the function depends on.")
        .require("output", &This::output, "", "Column that it predicts.")
        .direct(&This::approximator, "What is fitted.");
  }

 private:
  /// A test on what was trained on measures nothing.
  static void check_test(const NodeContext& context, Rules& rules) {
    for (const InputNode& train : context.inputs("samples")) {
      for (const InputNode& judge : context.inputs("test")) {
        const std::string origin = common_origin(train, judge);
        if (origin.empty()) continue;
        rules.broken("test", fmt::format("samples '{}' and test '{}' {}", train.id, judge.id, origin),
                     judge.streams.empty() ? "" : fmt::format("give '{}' a seed_label of its own", judge.id));
        return;
      }
    }
  }
};

const Component<Node, FitNode> kFitNode("fit", "Fit a function to the columns of a dataset, and score it.",
                                        "no publication", 2);

}  // namespace
}  // namespace coppice
