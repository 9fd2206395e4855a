#include "engine/cli/inputs.h"

#include <algorithm>
#include <filesystem>

#include "registry/suggest.h"

namespace coppice::cli {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code ignored;
  for (fs::directory_iterator entry(folder.empty() ? "." : folder, ignored), end; !ignored && entry != end;
       entry.increment(ignored)) {
    names.push_back(entry->path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

struct SortedWords {
  std::vector<std::string> configs;
  std::vector<Override> overrides;
};

SortedWords sorted(const CommandLine& line, const std::vector<std::string>& words) {
  SortedWords sorted;
  for (const std::string& word : words) {
    const std::size_t assign = word.find(":=");
    if (assign == std::string::npos) {
      sorted.configs.push_back(word);
    } else {
      sorted.overrides.push_back({word.substr(0, assign), word.substr(assign + 2), line.place(word)});
    }
  }
  if (sorted.configs.empty()) {
    throw line.error("", "a config file is missing", "runner CONFIG... [name:=value ...]");
  }
  return sorted;
}

/// The mistakes go to `diagnostics`.
std::vector<ExperimentConfig> expand_all(const CommandLine& line, const ConfigInputs& inputs,
                                         Diagnostics& diagnostics) {
  SortedWords words = sorted(line, inputs.words);
  std::vector<ExperimentConfig> experiments;
  bool all_there = true;
  for (const std::string& config : words.configs) {
    try {
      require_file(line, config);
      experiments.push_back(expand(config, {words.overrides, inputs.seed}, diagnostics));
    } catch (const ConfigError& error) {
      diagnostics.add(error);
      all_there = false;
    }
  }
  // A config that could not be read might have declared what the others do not.
  if (all_there) check_overrides(experiments, words.overrides, diagnostics);
  return experiments;
}

}  // namespace

std::string nearest_path(const std::string& path) {
  fs::path found;
  for (const fs::path& part : fs::path(path)) {
    std::error_code ignored;
    if (part.empty() || fs::exists(found / part, ignored)) {
      found /= part;
      continue;
    }
    const std::string near = nearest(part.string(), names_in(found));
    if (near.empty()) return {};
    found /= near;
  }
  return found == fs::path(path) ? "" : found.string();  // a broken link is near to itself
}

void require_file(const CommandLine& line, const std::string& argument) {
  std::error_code ignored;
  if (fs::is_directory(argument, ignored)) {
    throw line.error(argument, "'" + argument + "' is a folder, not a file");
  }
  if (fs::exists(argument, ignored)) return;
  if (fs::is_symlink(fs::symlink_status(argument, ignored))) {
    const std::string target = fs::read_symlink(argument, ignored).string();
    throw line.error(argument, "'" + argument + "' is a link to '" + target + "', which is not there");
  }
  std::string hint;
  if (const std::string near = nearest_path(argument); !near.empty()) {
    hint = "did you mean '" + near + "'?";
  } else if (const std::size_t equals = argument.find('='); equals != std::string::npos && equals > 0) {
    hint = "arguments are set with ':=': " + argument.substr(0, equals) + ":" + argument.substr(equals);
  }
  throw line.error(argument, "there is no file '" + argument + "'", hint);
}

std::vector<ExperimentConfig> expand_all(const CommandLine& line, const ConfigInputs& inputs) {
  Diagnostics diagnostics;
  std::vector<ExperimentConfig> experiments = expand_all(line, inputs, diagnostics);
  diagnostics.throw_if_any();
  return experiments;
}

std::vector<Plan> plan_all(const CommandLine& line, const ConfigInputs& inputs) {
  Diagnostics diagnostics;
  std::vector<ExperimentConfig> experiments = expand_all(line, inputs, diagnostics);
  std::vector<Plan> plans;
  try {
    plans = make_plans(std::move(experiments));
  } catch (const ConfigError& error) {
    diagnostics.add(error);
  }
  diagnostics.throw_if_any();
  return plans;
}

std::vector<Plan>& plan_to_keep(const CommandLine& line, const ConfigInputs& inputs) {
  static auto* const kKept = new std::vector<Plan>();
  return *kKept = plan_all(line, inputs);
}

}  // namespace coppice::cli
