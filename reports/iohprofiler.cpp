#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "engine/data/file_system.h"
#include "engine/data/table_file.h"
#include "engine/graph/node.h"
#include "registry/text.h"
#include "reports/cells.h"
#include "reports/searches.h"

namespace coppice {
namespace {

/// What the format's separators leave of a name.
std::string plain(std::string name) {
  for (char& c : name) {
    if (c == ',' || c == '=' || c == '\'' || c == '"' || c == '\n') c = ' ';
  }
  return name;
}

/// What file systems leave of it.
std::string file_name(std::string name) {
  for (char& c : name) {
    if (std::string_view("/\\:*?<>|' \",=").find(c) != std::string_view::npos) c = '_';
  }
  return name;
}

/// The searches of one algorithm on one function, as the format has them: a file of meta-data for all
/// dimensions (.info), and one of raw data for each (.dat, two columns).
class FunctionLog {
 public:
  FunctionLog(std::string algorithm, std::string function, std::size_t number)
      : algorithm_(std::move(algorithm)), function_(std::move(function)), number_(number) {}

  void add(std::optional<int> replicate, const SearchLog& search) {
    if (search.values.empty()) return;  // nothing finite was seen
    Scenario& scenario = scenarios_[search.dimension];
    if (to_optimum_.value_or(search.to_optimum) != search.to_optimum) {
      throw std::invalid_argument(
          fmt::format("the optimum of '{}' is known to some of its searches only", function_));
    }
    to_optimum_ = search.to_optimum;
    scenario.data += "\"function evaluation\" \"best-so-far f(x)\"\n";
    for (std::size_t i = 0; i < search.values.size(); ++i)
      add_line(scenario, search.improved_at[i], search.values[i]);
    // Each block ends with the last evaluation.
    if (search.improved_at.back() < search.evaluations) {
      add_line(scenario, search.evaluations, search.values.back());
    }
    scenario.runs +=
        fmt::format(", {}:{}|{}", replicate.value_or(0) + 1, search.evaluations, search.values.back());
  }

  void write(const std::filesystem::path& folder) const {
    const std::string data_folder = fmt::format("data_f{}", number_);
    std::string info;
    for (const auto& [dimension, scenario] : scenarios_) {
      const std::string data = fmt::format("{}/IOHprofiler_f{}_DIM{}.dat", data_folder, number_, dimension);
      info += fmt::format(
          "suite = 'coppice', funcId = {}, funcName = '{}', DIM = {}, maximization = {}, algId = "
          "'{}'\n%\n{}{}\n",
          number_, plain(function_), dimension, to_optimum_.value_or(true) ? "F" : "T", plain(algorithm_),
          data, scenario.runs);
      make_folder((folder / data).parent_path());
      write_file(folder / data, scenario.data);
    }
    if (info.empty()) return;
    write_file(folder / fmt::format("IOHprofiler_f{}_{}.info", number_, file_name(function_)), info);
  }

 private:
  struct Scenario {
    std::string data, runs;
  };
  static void add_line(Scenario& scenario, std::int64_t evaluations, double value) {
    scenario.data += fmt::format("{} {}\n", evaluations, value);
  }

  std::string algorithm_, function_;
  std::size_t number_;
  std::map<std::int64_t, Scenario> scenarios_;
  std::optional<bool> to_optimum_;  ///< whether values are gaps to it, to be made small
};

/// Writes searches for IOHanalyzer: a folder for each algorithm.
struct IohprofilerNode : Node {
  static constexpr const char* kFolder = "iohprofiler";

  References of;
  std::vector<std::string> algorithm = {"node"}, function = {"objective"}, dimension;

  std::vector<std::string> makes() const override { return {"log", "timing"}; }
  bool gathers(std::string_view) const override { return true; }
  bool shows_labels() const override { return true; }
  bool random() const override { return false; }

  void check(const NodeContext& context) const override { arranged(context); }

  void run(NodeContext& context) const override {
    const std::vector<InputNode>& nodes = context.inputs("of");
    std::map<std::string, std::map<std::string, FunctionLog>> logs;
    std::vector<std::string> functions;
    for (const TableCell& cell : arranged(context)) {
      const auto names = cell.keys.begin();
      const auto split = names + static_cast<std::ptrdiff_t>(algorithm.size());
      const std::string by = join({names, split}, " ");
      const std::string of_what = join({split, split + static_cast<std::ptrdiff_t>(function.size())}, " ");
      if (std::find(functions.begin(), functions.end(), of_what) == functions.end())
        functions.push_back(of_what);
      const auto number = static_cast<std::size_t>(std::find(functions.begin(), functions.end(), of_what) -
                                                   functions.begin() + 1);
      FunctionLog& log = logs[by].try_emplace(of_what, by, of_what, number).first->second;
      for (const std::size_t entry : cell.entries) log.add(nodes[entry].replicate, read_search(nodes[entry]));
    }
    for (const auto& [by, its_logs] : logs) {
      for (const auto& [of_what, log] : its_logs) log.write(context.folder() / kFolder / file_name(by));
    }
  }

  static Parameters<IohprofilerNode> parameters() {
    using This = IohprofilerNode;
    return node_parameters<This>()
        .references("of", &This::of, "search", "Searches.")
        .add("algorithm", &This::algorithm, "",
             "What names the algorithm: columns of sweeps, node (the search's id).")
        .add("function", &This::function, "", "What names the function, likewise, or objective or problem.")
        .add("dimension", &This::dimension, "",
             "Columns that only tell dimensions of a function apart; the number itself is known.");
  }

 private:
  std::vector<TableCell> arranged(const NodeContext& context) const {
    TableKeys keys{algorithm, function, "algorithm, function and dimension", "algorithm", "function"};
    keys.columns.insert(keys.columns.end(), dimension.begin(), dimension.end());
    return arrange(entries_of(context.inputs("of")), keys);
  }
};

const Component<Node, IohprofilerNode> kIohprofilerNode(
    "iohprofiler", "Write the history of searches as logs that IOHanalyzer reads.",
    "Doerr et al., IOHprofiler, arXiv 1810.05281 (2018); two-column format");

}  // namespace
}  // namespace coppice
