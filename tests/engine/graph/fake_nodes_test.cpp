#include <chrono>
#include <fstream>
#include <thread>

#include "engine/data/table_file.h"
#include "engine/graph/node.h"
#include "registry/text.h"
#include "tests/engine/graph/experiments.h"

namespace coppice {
namespace {

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Makes "data" of a number and a draw.
struct Source : Node {
  double amount = 1;
  FilePath file;
  bool fails = false;
  bool leaves = false;

  std::vector<std::string> makes() const override { return {"data"}; }
  void run(NodeContext& context) const override {
    if (fails && leaves) {
      std::ofstream(context.folder() / "data.txt") << amount;
      throw Unfinished("the source is dry");
    }
    if (fails) throw std::runtime_error("the source is dry");
    const double draw = context.draws().uniform("amount", 0, 1);
    std::ofstream(context.folder() / "data.txt") << amount << " " << draw << "\n";
  }
  static Parameters<Source> parameters() {
    return node_parameters<Source>()
        .add("amount", &Source::amount, "", "Number.", at_least(0))
        .add("file", &Source::file, "", "File.")
        .add("fails", &Source::fails, "", "Throw instead of writing.")
        .add("leaves", &Source::leaves, "", "What was written before is to be kept.");
  }
};
const Component<Node, Source> kSource("fake_source", "Makes data.", "no publication");

/// A definition.
struct Constant : Node {
  double value = 1;
  std::vector<std::string> makes() const override { return {"constant"}; }
  bool definition() const override { return true; }
  void run(NodeContext&) const override {}
  static Parameters<Constant> parameters() {
    return node_parameters<Constant>().add("value", &Constant::value, "", "Number.");
  }
};
const Component<Node, Constant> kConstant("fake_constant", "A number.", "no publication");

/// Reads data, one or many, and makes data.
struct Step : Node {
  Reference from;
  References many, runs;
  Reference constant;
  double factor = 2;

  std::vector<std::string> makes() const override { return {"data"}; }
  bool gathers(std::string_view parameter) const override { return parameter == "many"; }
  bool gathers_replicates(std::string_view parameter) const override { return parameter == "runs"; }
  void check(const NodeContext&) const override {
    if (factor == 13) throw std::invalid_argument("factor must not be 13");
  }
  void run(NodeContext& context) const override {
    std::ofstream out(context.folder() / "data.txt");
    out << factor << "\n";
    for (const char* parameter : {"from", "many"}) {
      for (const InputNode& input : context.inputs(parameter)) out << text_of(input.folder / "data.txt");
    }
  }
  static Parameters<Step> parameters() {
    return node_parameters<Step>()
        .reference("from", &Step::from, "data", "What it reads.", false)
        .references("many", &Step::many, "data", "More that it reads.", false)
        .references("runs", &Step::runs, "data", "Replicates that it reads.", false)
        .reference("constant", &Step::constant, "constant", "A number.", false)
        .add("factor", &Step::factor, "", "Number.");
  }
};
const Component<Node, Step> kStep("fake_step", "Makes data of data.", "no publication");

/// One node for each node it scores.
struct Score : Node {
  References of;
  std::vector<std::string> makes() const override { return {"score"}; }
  std::vector<std::string> labelled_tables() const override { return {"score.csv"}; }
  void run(NodeContext& context) const override {
    const std::string data = text_of(context.inputs("of").front().folder / "data.txt");
    Table table;
    table.columns = {{"value", ColumnInfo::Type::number, "", "First number of the data."}};
    table.rows = {{std::stod(data)}};
    write_table(context.folder() / "score.csv", table);
  }
  static Parameters<Score> parameters() {
    return node_parameters<Score>().references("of", &Score::of, "data", "What it scores.", true, true);
  }
};
const Component<Node, Score> kScore("fake_score", "Scores data.", "no publication");

/// Shows the names of what it reads.
struct Report : Node {
  References of;
  std::vector<std::string> makes() const override { return {}; }
  bool gathers(std::string_view) const override { return true; }
  bool shows_labels() const override { return true; }
  bool random() const override { return false; }
  std::string published_in() const override { return "tables"; }
  void run(NodeContext& context) const override {
    std::ofstream out(context.folder() / "table.csv");
    out << "labels\n";
    for (const InputNode& input : context.inputs("of")) {
      for (const auto& [name, value] : input.labels) out << name << " " << value << " ";
      out << input.replicate.value_or(-1) << "\n";
    }
  }
  static Parameters<Report> parameters() {
    return node_parameters<Report>().references("of", &Report::of, "score", "Scores.");
  }
};
const Component<Node, Report> kReport("fake_report", "Lists scores.", "no publication");

/// Works in units; each may be the last before a stop.
struct Worker : Node {
  std::int64_t units = 10;
  std::string act = "work";

  std::vector<std::string> makes() const override { return {"data"}; }
  void run(NodeContext& context) const override {
    std::int64_t sum = 0;
    std::int64_t done = 0;
    if (const std::optional<Archive> saved = context.checkpoint()) {
      done = saved->get<std::vector<std::int64_t>>("state").at(0);
      sum = saved->get<std::vector<std::int64_t>>("state").at(1);
    }
    if (done == 0) context.measure("unit", 1.5);
    for (; done < units; ++done) {
      context.progress(done, units);
      if (context.parallel().stop_requested()) {
        Archive archive;
        archive.put("state", std::vector<std::int64_t>{done, sum});
        context.save_checkpoint(archive);
        throw Interrupted();
      }
      if (act == "wait") std::this_thread::sleep_for(std::chrono::milliseconds(10));
      sum += done;
      context.count("units", 1);
    }
    std::ofstream(context.folder() / "data.txt") << sum << "\n";
  }
  static Parameters<Worker> parameters() {
    return node_parameters<Worker>()
        .add("units", &Worker::units, "", "Units of work.")
        .add("act", &Worker::act, "", "work or wait.");
  }
};
const Component<Node, Worker> kWorker("fake_worker", "Works in units.", "no publication");

}  // namespace

namespace testing {
namespace {

std::string substituted(std::string text, const Point& point) {
  for (const auto& [column, value] : point) {
    const std::string variable = "${" + column + "}";
    for (std::size_t i = text.find(variable); i != std::string::npos; i = text.find(variable, i)) {
      text.replace(i, variable.size(), value);
    }
  }
  return text;
}

/// The points of the product of sweeps.
std::vector<Point> product(const std::vector<std::string>& ids, const std::vector<SweepPoints>& sweeps) {
  std::vector<Point> points = {{}};
  for (const std::string& id : ids) {
    std::vector<Point> longer;
    for (const Point& start : points) {
      for (const SweepPoints& candidate : sweeps) {
        if (candidate.id != id) continue;
        for (const Point& end : candidate.points) {
          longer.push_back(start);
          longer.back().insert(longer.back().end(), end.begin(), end.end());
        }
      }
    }
    points = std::move(longer);
  }
  return points;
}

}  // namespace

SweepPoints sweep(std::string id, std::string column, std::vector<std::string> values) {
  SweepPoints sweep;
  sweep.id = std::move(id);
  sweep.columns = {column};
  for (std::string& value : values) sweep.points.push_back({{column, std::move(value)}});
  return sweep;
}

ExperimentConfig experiment(const std::string& xml, std::vector<SweepPoints> sweeps) {
  const auto source = std::make_shared<const SourceFile>(SourceFile{"test.xml", xml});
  const Element root = parse_xml(source);
  ExperimentConfig config;
  config.name = root.get("name", "test");
  config.seed = std::stoull(std::string(root.get("seed", "1")));
  config.path = "test.xml";
  config.place = root.place;
  for (const Element& child : root.children) {
    std::vector<std::string> over;
    if (const Attribute* given = child.find("over")) {
      for (const std::string_view id : split_list(given->value)) over.emplace_back(id);
    }
    for (Point& point : product(over, sweeps)) {
      NodeElement node{child, over, std::move(point)};
      std::erase_if(node.element.attributes, [](const Attribute& a) { return a.name == "over"; });
      for (Attribute& a : node.element.attributes) a.value = substituted(a.value, node.point);
      config.nodes.push_back(std::move(node));
    }
  }
  config.sweeps = std::move(sweeps);
  return config;
}

const PlannedNode& named(const Plan& plan, const std::string& name) {
  for (const PlannedNode& node : plan.nodes) {
    if (node.name == name) return node;
  }
  throw std::out_of_range("no node is named " + name);
}

std::vector<std::string> inputs_of(const Plan& plan, const std::string& name) {
  std::vector<std::string> found;
  for (const PlannedInput& input : named(plan, name).inputs) {
    for (const std::size_t i : input.nodes) found.push_back(plan.nodes[i].name);
  }
  return found;
}

std::vector<std::string> names(const Plan& plan) {
  std::vector<std::string> all;
  for (const PlannedNode& node : plan.nodes) all.push_back(node.name);
  return all;
}

::testing::AssertionResult contains(const std::string& text, const std::string& part) {
  if (text.find(part) != std::string::npos) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "\"" << part << "\" is not in:\n" << text;
}

std::string plan_errors(const std::string& xml, std::vector<SweepPoints> sweeps) {
  try {
    make_plan(experiment(xml, std::move(sweeps)));
  } catch (const ConfigError& error) {
    std::string text;
    for (const Diagnostic& diagnostic : error.diagnostics()) {
      text += std::to_string(diagnostic.place.line) + ":" + std::to_string(diagnostic.place.column) + " " +
              diagnostic.message + " | " + diagnostic.hint + "\n";
    }
    return text;
  }
  return "";
}

}  // namespace testing
}  // namespace coppice
