#include "engine/cli/complete.h"

#include <algorithm>
#include <set>

#include "engine/cli/command.h"
#include "engine/cli/parse.h"
#include "engine/config/experiment.h"
#include "registry/component.h"

namespace coppice::cli {
namespace {

using Words = std::vector<std::string>;

/// The configs among the words, expanded; those with mistakes are passed over.
std::vector<ExperimentConfig> configs_among(const Words& words) {
  std::vector<ExperimentConfig> experiments;
  for (const std::string& word : words) {
    if (!word.ends_with(".xml")) continue;
    try {
      experiments.push_back(expand(word, {}));
    } catch (const ConfigError&) {
      continue;
    }
  }
  return experiments;
}

void add_config_arguments(const Words& before, std::set<std::string>& candidates) {
  for (const ExperimentConfig& experiment : configs_among(before)) {
    for (const auto& [name, value] : experiment.arguments) candidates.insert(name + ":=");
  }
}

void add_node_ids(const Words& before, std::set<std::string>& candidates) {
  for (const ExperimentConfig& experiment : configs_among(before)) {
    for (const NodeElement& node : experiment.nodes) candidates.emplace(node.element.get("id"));
  }
}

void add_components(std::set<std::string>& candidates) {
  const Catalogue& catalogue = Catalogue::instance();
  for (const std::string& kind : catalogue.interfaces()) {
    for (const std::string& name : catalogue.names(kind)) candidates.insert(name);
  }
  for (const ControlElement& element : control_elements()) candidates.insert(element.name);
}

/// First words ("policy"), or second ones after `family`.
void add_command_words(const std::string& family, std::set<std::string>& candidates) {
  for (const CommandInfo& info : commands()) {
    if (info.hidden) continue;
    const std::size_t space = info.name.find(' ');
    if (family.empty()) {
      candidates.insert(info.name.substr(0, space));
    } else if (info.name.starts_with(family + ' ')) {
      candidates.insert(info.name.substr(space + 1));
    }
  }
}

/// Adds what fits an argument; returns the line for the shell.
std::string add_values(const ArgumentInfo& info, const Words& before, std::set<std::string>& candidates) {
  candidates.insert(info.choices.begin(), info.choices.end());
  const Catalogue& catalogue = Catalogue::instance();
  switch (info.completes) {
    case Completes::nothing:
      return {};
    case Completes::config:
      add_config_arguments(before, candidates);
      return ":config\n";
    case Completes::file:
      return ":file\n";
    case Completes::folder:
      return ":folder\n";
    case Completes::component:
      add_components(candidates);
      return {};
    case Completes::problem:
      for (const std::string& name : catalogue.names("problem")) candidates.insert(name);
      return {};
    case Completes::exporter:
      for (const std::string& name : catalogue.names("exporter")) candidates.insert(name);
      return {};
    case Completes::interface:
      for (const std::string& name : catalogue.interfaces()) candidates.insert(name);
      return {};
    case Completes::node:
      add_node_ids(before, candidates);
      return {};
    case Completes::command:
      add_command_words("", candidates);
      return {};
  }
  return {};
}

const ArgumentInfo* find_option(const std::vector<ArgumentInfo>& arguments, const std::string& word) {
  const auto found = std::find_if(arguments.begin(), arguments.end(), [&](const ArgumentInfo& info) {
    return !info.positional() && (info.name == word || info.letter == word);
  });
  return found == arguments.end() ? nullptr : &*found;
}

/// The subcommand that the words name, whose words are then left out; `run` when a config stands first.
const CommandInfo* subcommand(Words& words, std::string& family) {
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i].starts_with("-")) continue;
    const CommandInfo* found = find_command(words[i]);
    if (found == nullptr && i + 1 < words.size()) found = find_command(words[i] + ' ' + words[i + 1]);
    if (found != nullptr) {
      words.erase(words.begin(),
                  words.begin() + static_cast<std::ptrdiff_t>(i + (found->name == words[i] ? 1 : 2)));
      return found;
    }
    if (words[i].ends_with(".xml") || words[i].find(":=") != std::string::npos) return find_command("run");
    family = words[i];
    return nullptr;
  }
  return nullptr;
}

/// The positional argument that the word after `before` is.
const ArgumentInfo* next_positional(const std::vector<ArgumentInfo>& arguments, const Words& before) {
  std::size_t given = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (!before[i].starts_with("-")) {
      ++given;
    } else if (const ArgumentInfo* option = find_option(arguments, before[i]);
               option != nullptr && !option->flag()) {
      ++i;
    }
  }
  for (const ArgumentInfo& info : arguments) {
    if (!info.positional()) continue;
    if (given == 0 || info.many) return &info;
    --given;
  }
  return nullptr;
}

}  // namespace

std::string complete(const std::vector<std::string>& words) {
  Words before(words.begin(), words.empty() ? words.end() : words.end() - 1);
  const std::string current = words.empty() ? "" : words.back();
  const Words all_before = before;
  std::string family;
  const CommandInfo* command = subcommand(before, family);
  std::vector<ArgumentInfo> arguments = command != nullptr ? command->arguments : std::vector<ArgumentInfo>();
  arguments.insert(arguments.end(), global_arguments().begin(), global_arguments().end());

  std::set<std::string> candidates;
  std::string shell;
  const ArgumentInfo* option = all_before.empty() ? nullptr : find_option(arguments, all_before.back());
  if (option != nullptr && !option->flag()) {
    shell = add_values(*option, all_before, candidates);
  } else if (current.starts_with("-")) {
    for (const ArgumentInfo& info : arguments) {
      if (!info.positional()) candidates.insert(info.name);
    }
  } else if (command == nullptr) {
    add_command_words(family, candidates);
    if (family.empty()) shell = ":config\n";
  } else if (const ArgumentInfo* positional = next_positional(arguments, before)) {
    shell = add_values(*positional, all_before, candidates);
  }
  std::string text;
  for (const std::string& candidate : candidates) {
    if (candidate.starts_with(current)) text += candidate + '\n';
  }
  return text + shell;
}

}  // namespace coppice::cli
