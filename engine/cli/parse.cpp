#include "engine/cli/parse.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>

#include "engine/cli/inputs.h"
#include "registry/suggest.h"

namespace coppice::cli {
namespace {

bool names(const ArgumentInfo& info, std::string_view option) {
  return info.name == option || (!info.letter.empty() && info.letter == option);
}

/// True for an option whose value is the next word, in whichever subcommand.
bool takes_next_word(const std::string& option) {
  const auto takes = [&](const ArgumentInfo& info) {
    return !info.positional() && !info.flag() && names(info, option);
  };
  const auto any = [&](const std::vector<ArgumentInfo>& all) {
    return std::any_of(all.begin(), all.end(), takes);
  };
  return any(global_arguments()) || std::any_of(commands().begin(), commands().end(),
                                                [&](const CommandInfo& info) { return any(info.arguments); });
}

/// Indices of the words that are neither options nor values of options.
std::vector<std::size_t> positional_words(const std::vector<std::string>& arguments) {
  std::vector<std::size_t> words;
  bool options = true;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (options && arguments[i] == "--") {
      options = false;
    } else if (!options || arguments[i].size() < 2 || arguments[i][0] != '-') {
      words.push_back(i);
    } else if (takes_next_word(arguments[i])) {
      ++i;
    }
  }
  return words;
}

/// Also a broken link.
bool is_there(const std::string& path) {
  std::error_code ignored;
  return std::filesystem::exists(std::filesystem::symlink_status(path, ignored));
}

bool looks_like_config(const std::string& word) {
  if (word.ends_with(".xml") || word.find(":=") != std::string::npos) return true;
  std::error_code ignored;
  return word.find('/') != std::string::npos || std::filesystem::is_regular_file(word, ignored);
}

/// The names that may stand first ("policy"), or after `family`.
std::vector<std::string> valid_words(const std::string& family) {
  std::vector<std::string> words;
  for (const CommandInfo& info : commands()) {
    if (info.hidden) continue;
    const std::size_t space = info.name.find(' ');
    if (family.empty()) {
      words.push_back(info.name.substr(0, space));
    } else if (info.name.starts_with(family + " ")) {
      words.push_back(info.name.substr(space + 1));
    }
  }
  words.erase(std::unique(words.begin(), words.end()), words.end());
  return words;
}

/// Takes the subcommand's words out of `rest`.
void find_subcommand(const CommandLine& line, std::vector<std::string>& rest, Request& request) {
  const std::vector<std::size_t> words = positional_words(rest);
  if (words.empty()) {
    const auto global = [](const std::string& word) {
      return std::any_of(global_arguments().begin(), global_arguments().end(), [&](const ArgumentInfo& info) {
        return names(info, word.substr(0, word.find('=')));
      });
    };
    // Options alone: a run that lacks its configs, which its own checks will say.
    if (std::none_of(rest.begin(), rest.end(), global))
      request.command = rest.empty() ? nullptr : find_command("run");
    return;
  }
  const std::string first = rest[words[0]];
  const bool family = !valid_words(first).empty();
  if (family && words.size() > 1) {
    const std::string second = rest[words[1]];
    request.command = find_command(first + " " + second);
    if (request.command == nullptr) {
      throw line.error(second, "'" + first + "' has no subcommand '" + second + "'",
                       suggestion(second, valid_words(first)));
    }
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(words[1]));
  } else if (family) {
    request.family = first;
  } else {
    request.command = find_command(first);
  }
  if (family || request.command != nullptr) {
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(words[0]));
    return;
  }
  const bool near_command = !nearest(first, valid_words("")).empty();
  if (looks_like_config(first) || (!near_command && is_there(first))) {
    request.command = find_command("run");
  } else {
    const std::string file = near_command ? "" : nearest_path(first);
    throw line.error(first, "there is no subcommand '" + first + "', and no config file of this name",
                     file.empty() ? suggestion(first, valid_words("")) : "did you mean '" + file + "'?");
  }
}

CLI::Option* declare(CLI::App& app, const ArgumentInfo& info) {
  const std::string names = info.letter.empty() ? info.name : info.letter + "," + info.name;
  CLI::Option* option = info.flag() ? app.add_flag(names) : app.add_option(names);
  if (info.positional()) {
    option->expected(info.many ? -1 : 1);
  } else if (!info.flag()) {
    option->expected(0, 1);  // a missing value is refused below, in our own words
  }
  option->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  return option;
}

void check(const CommandLine& line, const ArgumentInfo& info, const std::vector<std::string>& texts,
           Diagnostics& diagnostics) {
  if (texts.size() > 1 && !info.many && !info.flag()) {
    diagnostics.error(line.place(texts.back()), "'" + info.name + "' is given more than once");
  }
  for (const std::string& text : texts) {
    if (info.flag() && text != "true") {
      diagnostics.error(line.place(text), "'" + info.name + "' takes no value");
    } else if (!info.flag() && text.empty()) {
      diagnostics.error(line.place(info.name), "'" + info.name + "' needs a value " + info.value, info.doc);
    } else if (!info.choices.empty() &&
               std::find(info.choices.begin(), info.choices.end(), text) == info.choices.end()) {
      diagnostics.error(line.place(text), "'" + info.name + "' cannot be '" + text + "'",
                        suggestion(text, info.choices));
    }
  }
  if (texts.empty() && info.required) {
    diagnostics.error(line.place(""), "a " + info.name + " is missing", info.doc);
  }
}

void refuse_rest(const CommandLine& line, const CommandInfo& command, const std::vector<std::string>& rest,
                 Diagnostics& diagnostics) {
  const std::string who = command.name.empty() ? "runner" : "runner " + command.name;
  std::vector<std::string> options;
  for (const std::vector<ArgumentInfo>& all : {command.arguments, global_arguments()}) {
    for (const ArgumentInfo& info : all) {
      if (!info.positional()) options.push_back(info.name);
    }
  }
  for (const std::string& word : rest) {
    if (word == "--") continue;
    const bool option = word.starts_with("-");
    const std::string name = option ? word.substr(0, word.find('=')) : word;
    if (option) {
      diagnostics.error(line.place(word), "'" + who + "' has no option '" + name + "'",
                        suggestion(name, options));
    } else {
      diagnostics.error(line.place(word), "'" + who + "' does not take '" + word + "'",
                        "see " + who + " --help");
    }
  }
}

}  // namespace

const std::vector<ArgumentInfo>& global_arguments() {
  static const std::vector<ArgumentInfo> kArguments = {
      {.name = "--help", .letter = "-h", .doc = "Shows the help of the subcommand and ends."},
      {.name = "--version", .doc = "Shows the version and ends."},
      {.name = "--color",
       .value = "auto|always|never",
       .doc = "Colours in messages; auto: on a terminal, unless NO_COLOR is set.",
       .choices = {"auto", "always", "never"},
       .default_text = "auto"}};
  return kArguments;
}

std::string color_choice(const CommandLine& line) {
  const std::vector<std::string>& words = line.arguments();
  std::string choice = "auto";
  for (std::size_t i = 0; i < words.size() && words[i] != "--"; ++i) {
    if (words[i].starts_with("--color=")) choice = words[i].substr(words[i].find('=') + 1);
    if (words[i] == "--color" && i + 1 < words.size()) choice = words[i + 1];
  }
  return choice;
}

Request parse(const CommandLine& line) {
  Request request;
  std::vector<std::string> rest = line.arguments();
  find_subcommand(line, rest, request);
  const CommandInfo none;
  const CommandInfo& command = request.command != nullptr ? *request.command : none;

  CLI::App app;
  app.set_help_flag();
  app.allow_extras();
  std::vector<std::pair<const ArgumentInfo*, CLI::Option*>> declared;
  for (const ArgumentInfo& info : command.arguments) declared.emplace_back(&info, declare(app, info));
  for (const ArgumentInfo& info : global_arguments()) declared.emplace_back(&info, declare(app, info));
  std::reverse(rest.begin(), rest.end());
  app.parse(rest);

  Diagnostics diagnostics;
  std::vector<std::vector<std::string>> texts;
  for (const auto& [info, option] : declared) texts.push_back(option->results());
  const std::size_t own = command.arguments.size();
  request.help = !texts[own].empty();
  request.version = !texts[own + 1].empty();
  if (request.help || request.version) return request;
  for (std::size_t i = 0; i < declared.size(); ++i) check(line, *declared[i].first, texts[i], diagnostics);
  refuse_rest(line, command, app.remaining(), diagnostics);
  diagnostics.throw_if_any();
  texts.resize(own);
  request.given = std::move(texts);
  return request;
}

}  // namespace coppice::cli
