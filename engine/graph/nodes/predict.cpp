#include "engine/data/table_file.h"
#include "engine/graph/artifacts.h"
#include "engine/graph/nodes/dataset_columns.h"

namespace coppice {
namespace {

/// What a learned function says of the rows of a dataset.
struct PredictNode : Node {
  static constexpr const char* kExample =
      "<predict id=\"predictions\" function=\"my_fit\" samples=\"my_dataset\"/>";

  Reference function, samples;

  std::vector<std::string> makes() const override { return {"dataset", "timing"}; }
  bool random() const override { return false; }

  void run(NodeContext& context) const override {
    const FunctionFile file = load_function_file(context.inputs("function").front());
    const MadeFunction predicting = make_function(file);
    const Matrix x = read_columns(context.inputs("samples"), file.inputs);
    Matrix y(x.rows(), 1);
    predicting->predict_batch(x, y);

    using Type = ColumnInfo::Type;
    Table table;
    for (const std::string& input : file.inputs) table.columns.push_back({input, Type::number, "", "Input."});
    table.columns.push_back({file.output, Type::number, "", "What the function predicts."});
    for (std::size_t i = 0; i < x.rows(); ++i) {
      std::vector<Cell>& row = table.rows.emplace_back();
      for (std::size_t c = 0; c < x.columns(); ++c) row.emplace_back(x(i, c));
      row.emplace_back(y(i, 0));
    }
    context.count("samples", static_cast<std::int64_t>(x.rows()));
    write_table(context.folder() / kDatasetFile, table);
  }

  static Parameters<PredictNode> parameters() {
    using This = PredictNode;
    return node_parameters<This>()
        .reference("function", &This::function, "function",
                   "Node whose function predicts: a fit, or a training, whose value function does.")
        .reference("samples", &This::samples, "dataset", "Dataset with the columns that it depends on.");
  }
};

const Component<Node, PredictNode> kPredictNode(
    "predict", "Predict the rows of a dataset with a function that was fitted: a dataset again.",
    "no publication");

}  // namespace
}  // namespace coppice
