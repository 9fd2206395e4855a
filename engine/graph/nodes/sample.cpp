#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "engine/data/table_file.h"
#include "engine/graph/artifacts.h"
#include "engine/vocabulary/test_function.h"

namespace coppice {
namespace {

/// Inputs of a known function and, with noise, its values: a dataset for supervised learning.
struct SampleNode : Node {
  static constexpr const char* kExample = "<sample id=\"samples\" samples=\"1000\"><sine/></sample>";
  static constexpr const char* kOutput = "y";

  using Node::check;

  enum class Draw { uniform, grid };
  std::int64_t samples = 0;
  double noise = 0;
  Draw draw = Draw::uniform;
  Sub<TestFunction> function;

  std::vector<std::string> makes() const override { return {"dataset", "timing"}; }
  bool random() const override { return draw == Draw::uniform || noise > 0; }

  void check() const {
    const std::size_t inputs = function->inputs().size();
    if (draw == Draw::grid && inputs != 1) {
      throw std::invalid_argument(
          fmt::format("a grid is of one input, and <{}> has {}", function.resolved.name, inputs));
    }
  }

  std::vector<std::string> dataset_columns(const NodeContext&) const override {
    std::vector<std::string> names;
    for (const Axis& axis : function->inputs()) names.push_back(axis.name);
    names.emplace_back(kOutput);
    return names;
  }

  void run(NodeContext& context) const override {
    const Space space = function->inputs();
    using Type = ColumnInfo::Type;
    Table table;
    for (const Axis& axis : space) table.columns.push_back({axis.name, Type::number, axis.unit, "Input."});
    table.columns.push_back({kOutput, Type::number, "",
                             fmt::format("Of {}{}.", function.resolved.name, noise > 0 ? " and noise" : "")});
    std::vector<double> x(space.size());
    for (std::int64_t i = 0; i < samples; ++i) {
      const Draws draws = context.draws().scenario(static_cast<std::uint64_t>(i));
      for (std::size_t d = 0; d < x.size(); ++d) x[d] = input(space[d], d, i, draws);
      std::vector<Cell>& row = table.rows.emplace_back(x.begin(), x.end());
      row.emplace_back(function->value(x) + (noise > 0 ? draws.normal("noise", 0, noise) : 0.0));
    }
    context.count("samples", samples);
    write_table(context.folder() / kDatasetFile, table);
  }

  static Parameters<SampleNode> parameters() {
    using This = SampleNode;
    return node_parameters<This>()
        .require("samples", &This::samples, "", "Number of samples.", between(2, 100000000))
        .add("noise", &This::noise, "", "Deviation of normal noise that is added to the values.", at_least(0))
        .choice("draw", &This::draw, {"uniform", "grid"},
                "Inputs drawn uniformly between their limits, or of one input evenly spaced ones, limits "
                "included.")
        .direct(&This::function, "What is sampled.");
  }

 private:
  double input(const Axis& axis, std::size_t d, std::int64_t sample, const Draws& draws) const {
    if (draw == Draw::uniform) {
      return draws.uniform("input", axis.low, axis.high, static_cast<std::uint32_t>(d));
    }
    if (sample == samples - 1) return axis.high;
    return axis.low + (axis.high - axis.low) * static_cast<double>(sample) / static_cast<double>(samples - 1);
  }
};

const Component<Node, SampleNode> kSampleNode(
    "sample", "Sample a known function, with noise: a dataset to try supervised learning on.",
    "no publication");

}  // namespace
}  // namespace coppice
