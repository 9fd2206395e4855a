#include "engine/data/csv.h"
#include "engine/data/table_file.h"
#include "engine/graph/artifacts.h"

namespace coppice {
namespace {

/// Transitions, or with no problem any table, read from a CSV file.
struct DatasetNode : Node {
  static constexpr std::size_t kHead = std::size_t{1} << 20;  // more than any header has

  FilePath file;
  Reference problem;

  std::vector<std::string> makes() const override { return {"dataset", "timing"}; }
  bool random() const override { return false; }

  std::vector<std::string> dataset_columns(const NodeContext& context) const override {
    if (!problem.id.empty()) {
      return dataset_column_names(load_problem(context.inputs("problem").front())->spaces());
    }
    return CsvReader(read_head(file.path, kHead)).header();
  }

  std::shared_ptr<const Spaces> spaces(const NodeContext& context) const override {
    return problem.id.empty() ? nullptr : load_spaces(context.inputs("problem").front());
  }

  /// The header; the rows are read when the node runs.
  void check(const NodeContext& context) const override {
    if (problem.id.empty()) return;  // as for its columns
    check_dataset_header(read_head(file.path, kHead), *spaces(context));
  }

  void run(NodeContext& context) const override {
    const std::filesystem::path target = context.folder() / kDatasetFile;
    if (problem.id.empty()) {
      write_table(target, read_table(file.path));
    } else {
      const auto source = load_problem(context.inputs("problem").front());
      write_dataset(target, read_dataset(file.path, source->spaces()));
    }
  }

  static Parameters<DatasetNode> parameters() {
    return node_parameters<DatasetNode>()
        .require("file", &DatasetNode::file, "", "The CSV file.")
        .reference(
            "problem", &DatasetNode::problem, "problem",
            "Problem that the transitions are of: its axes name the columns. None: any table, for fit.",
            false);
  }
};

const Component<Node, DatasetNode> kDatasetNode("dataset", "Read transitions, or any table, from a CSV file.",
                                                "no publication");

}  // namespace
}  // namespace coppice
