#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <tuple>

#include "engine/config/config_root.h"
#include "engine/config/expander.h"
#include "engine/config/experiment.h"
#include "engine/config/sweep.h"
#include "registry/suggest.h"

namespace coppice {
namespace {

using config::Expansion;
using config::GivenArgument;
using config::GivenArguments;

constexpr std::size_t kMostPasses = 10'000;  // combinations of swept arguments

/// Puts together the passes of expansion, one for each combination of the swept arguments.
class Merger {
 public:
  explicit Merger(ExperimentConfig& experiment) : experiment_(experiment) {}

  void add(Expansion pass, const std::vector<GivenArgument*>& swept, Diagnostics& diagnostics) {
    for (SweepPoints& sweep : pass.sweeps) add_sweep(std::move(sweep), diagnostics);
    Point combination;
    values_.resize(swept.size());
    for (std::size_t i = 0; i < swept.size(); ++i) {
      const GivenArgument& argument = *swept[i];
      const std::string& value = pass.arguments.at(argument.override.name);
      combination.emplace_back(argument.override.name, value);
      const std::string key = config::point_key({config::Value::inferred(value)});
      const auto [known, is_new] = values_[i].first_with.try_emplace(key, argument.chosen);
      if (is_new) values_[i].texts.push_back(value);
      const bool unknown = value.empty() && !pass.complete;  // it could not be worked out
      if (known->second < argument.chosen && !unknown)
        values_[i].repeated.try_emplace(argument.chosen, value);
    }
    // A value that was given twice is reported in the end.
    if (combinations_.insert(combination).second) {
      for (NodeElement& node : pass.nodes) add_node(std::move(node), combination);
    }
    for (UnusedPart& part : pass.unused) add_unused(std::move(part));
    experiment_.left_out.insert(experiment_.left_out.end(), pass.left_out.begin(), pass.left_out.end());
    experiment_.arguments.merge(pass.arguments);
    experiment_.complete = experiment_.complete && pass.complete;
  }

  void finish(const std::vector<GivenArgument*>& swept, Diagnostics& diagnostics) {
    for (auto& group : groups_) {
      for (NodeElement& node : group) experiment_.nodes.push_back(std::move(node));
    }
    std::vector<SweepPoints> implicit;
    values_.resize(swept.size());
    for (std::size_t i = 0; i < swept.size(); ++i) {
      implicit.push_back(implicit_sweep(*swept[i], values_[i], diagnostics));
      experiment_.arguments[swept[i]->override.name] = swept[i]->override.value;
    }
    experiment_.sweeps.insert(experiment_.sweeps.begin(), implicit.begin(), implicit.end());
  }

 private:
  void add_unused(UnusedPart part) {
    const Place& place = part.element.place;
    if (unused_.emplace(place.file.get(), place.line, place.column).second)
      experiment_.unused.push_back(std::move(part));
  }

  /// A sweep whose points depend on a swept argument has those of all passes.
  void add_sweep(SweepPoints sweep, Diagnostics& diagnostics) {
    const auto known = std::find_if(experiment_.sweeps.begin(), experiment_.sweeps.end(),
                                    [&](const SweepPoints& other) { return other.id == sweep.id; });
    if (known == experiment_.sweeps.end()) {
      points_.emplace_back(sweep.points.begin(), sweep.points.end());
      experiment_.sweeps.push_back(std::move(sweep));
      return;
    }
    if (known->columns != sweep.columns) {
      diagnostics.error(
          sweep.place,
          fmt::format("the columns of sweep '{}' depend on an argument that is swept", sweep.id));
      return;
    }
    std::set<Point>& points = points_[static_cast<std::size_t>(known - experiment_.sweeps.begin())];
    for (Point& point : sweep.points) {
      if (points.insert(point).second) known->points.push_back(std::move(point));
    }
  }

  /// The points of a node stand together, in the order of the first pass that has it.
  void add_node(NodeElement node, const Point& combination) {
    std::vector<std::string> sweeps;
    for (const auto& [name, value] : combination) sweeps.push_back(name);
    node.sweeps.insert(node.sweeps.begin(), sweeps.begin(), sweeps.end());
    node.point.insert(node.point.begin(), combination.begin(), combination.end());
    const std::string id(node.element.get("id"));
    const auto group = group_of_.try_emplace(id, groups_.size());
    if (group.second || id.empty()) {
      group.first->second = groups_.size();
      groups_.emplace_back();
    }
    groups_[group.first->second].push_back(std::move(node));
  }

  /// The values of a swept argument, as worked out.
  struct SweptValues {
    std::vector<std::string> texts;
    std::map<std::string, std::size_t> first_with;  // by what tells values apart
    std::map<std::size_t, std::string> repeated;
  };

  static SweepPoints implicit_sweep(const GivenArgument& argument, const SweptValues& values,
                                    Diagnostics& diagnostics) {
    const std::string& name = argument.override.name;
    SweepPoints sweep{name, argument.override.place, {name}, {}, true};
    for (const std::string& value : values.texts) sweep.points.push_back({{name, value}});
    for (const auto& [index, value] : values.repeated) {
      diagnostics.error(argument.values[index].value_place,
                        fmt::format("the argument '{}' is given the value {} twice", name, value),
                        "numbers are compared by value, not by spelling");
    }
    return sweep;
  }

  ExperimentConfig& experiment_;
  std::vector<std::set<Point>> points_;           // of each sweep
  std::vector<std::vector<NodeElement>> groups_;  // the points of each node
  std::map<std::string, std::size_t> group_of_;
  std::set<std::tuple<const SourceFile*, int, int>> unused_;
  std::set<Point> combinations_;  // of the swept arguments
  std::vector<SweptValues> values_;
};

/// Reports what keeps the swept arguments from being swept; false then.
bool can_sweep(const std::vector<GivenArgument*>& now, const std::vector<GivenArgument*>& at_first,
               const Expansion& pass, Diagnostics& diagnostics) {
  std::size_t combinations = 1;
  for (const GivenArgument* argument : now) {
    const Override& override = argument->override;
    combinations *= argument->values.size();
    if (combinations > kMostPasses) {
      diagnostics.error(override.place,
                        fmt::format("the swept arguments have more than {} combinations", kMostPasses));
      return false;
    }
    const auto other = std::find_if(pass.sweeps.begin(), pass.sweeps.end(),
                                    [&](const SweepPoints& sweep) { return sweep.id == override.name; });
    if (other != pass.sweeps.end()) {
      diagnostics.error(
          override.place,
          fmt::format("the argument '{}' cannot be swept: a sweep has the same name", override.name),
          fmt::format("the sweep is defined at {}:{}; an argument of type list takes the "
                      "whole list",
                      other->place.file->path, other->place.line));
      return false;
    }
    const bool always = std::find(at_first.begin(), at_first.end(), argument) != at_first.end() &&
                        pass.arguments.contains(override.name);
    if (always) continue;
    diagnostics.error(override.place,
                      fmt::format("the argument '{}' cannot be swept: it is declared for some values of "
                                  "another swept argument only",
                                  override.name));
    return false;
  }
  return true;
}

void expand_passes(config::Files& files, const config::LoadedFile& file, std::uint64_t root_seed,
                   const ExpandOptions& options, ExperimentConfig& experiment, Diagnostics& diagnostics) {
  GivenArguments given(options.overrides);
  Merger merger(experiment);
  std::vector<GivenArgument*> swept;
  for (bool first = true; first || given.next_combination(); first = false) {
    Expansion pass = config::Expander(files, given, root_seed, experiment.seed, diagnostics).run(file);
    if (first) swept = given.swept();
    if (!can_sweep(given.swept(), swept, pass, diagnostics)) {
      experiment.complete = false;
      break;
    }
    merger.add(std::move(pass), swept, diagnostics);
  }
  merger.finish(swept, diagnostics);
  experiment.overrides = given.taken();
}

ExperimentConfig expand_file(config::Files& files, const config::LoadedFile& file,
                             const ExpandOptions& options, Diagnostics& diagnostics) {
  ExperimentConfig experiment;
  experiment.path = file.source->path;
  experiment.place = file.root.place;
  for (const Diagnostic& mistake : file.mistakes)
    diagnostics.error(mistake.place, mistake.message, mistake.hint, mistake.notes);
  const config::RootAttributes root = config::read_root(file, files, nullptr, diagnostics);
  experiment.name = root.name;
  experiment.doc = root.doc;
  experiment.seed = options.seed.value_or(root.seed.value_or(0));
  experiment.complete = root.readable;
  // Another version, or another language altogether: its elements mean nothing here.
  if (root.readable) expand_passes(files, file, root.seed.value_or(0), options, experiment, diagnostics);
  experiment.files = files.read();
  return experiment;
}

ExperimentConfig unreadable(const std::string& path) {
  ExperimentConfig experiment;
  experiment.path = path;
  experiment.complete = false;
  return experiment;
}

}  // namespace

ExperimentConfig expand(const std::string& path, const ExpandOptions& options, Diagnostics& diagnostics) {
  config::Files files;
  try {
    return expand_file(files, files.load(path), options, diagnostics);
  } catch (const ConfigError& error) {
    diagnostics.add(error);
    return unreadable(path);
  }
}

ExperimentConfig expand(const std::shared_ptr<const SourceFile>& source, const ExpandOptions& options,
                        Diagnostics& diagnostics) {
  config::Files files;
  try {
    return expand_file(files, files.add(source), options, diagnostics);
  } catch (const ConfigError& error) {
    diagnostics.add(error);
    return unreadable(source->path);
  }
}

ExperimentConfig expand(const std::string& path, const std::vector<Override>& overrides) {
  Diagnostics diagnostics;
  ExperimentConfig experiment = expand(path, ExpandOptions{overrides, std::nullopt}, diagnostics);
  check_overrides({experiment}, overrides, diagnostics);
  diagnostics.throw_if_any();
  return experiment;
}

void check_overrides(const std::vector<ExperimentConfig>& experiments, const std::vector<Override>& overrides,
                     Diagnostics& diagnostics) {
  std::set<std::string> declared, given;
  bool complete = true;
  for (const ExperimentConfig& experiment : experiments) {
    for (const auto& [name, value] : experiment.arguments) declared.insert(name);
    complete = complete && experiment.complete;
  }
  for (const Override& override : overrides) {
    if (!given.insert(override.name).second) {
      diagnostics.error(override.place, fmt::format("the argument '{}' is given twice", override.name),
                        fmt::format("{}:=a,b runs both values", override.name));
    }
    if (declared.contains(override.name) || !complete) continue;
    diagnostics.error(override.place, fmt::format("no config declares an argument '{}'", override.name),
                      declared.empty() ? "they declare none"
                                       : suggestion(override.name, {declared.begin(), declared.end()}));
  }
}

}  // namespace coppice
