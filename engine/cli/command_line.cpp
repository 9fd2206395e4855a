#include "engine/cli/command_line.h"

#include <utility>

#include "registry/text.h"

namespace coppice::cli {
namespace {

/// As the user could have typed it in a shell.
std::string quoted(const std::string& argument) {
  const bool plain =
      !argument.empty() && argument.find_first_of(" \t\n\"'$&|<>;()*?\\`") == std::string::npos;
  return plain ? argument : "'" + argument + "'";
}

}  // namespace

CommandLine::CommandLine(std::vector<std::string> arguments) : arguments_(std::move(arguments)) {
  std::string text = "runner";
  for (const std::string& argument : arguments_) {
    const std::string word = quoted(argument);
    columns_.push_back(static_cast<int>(count_characters(text)) + 2 + (word == argument ? 0 : 1));
    text += " " + word;
  }
  file_ = std::make_shared<const SourceFile>(SourceFile{"<command line>", std::move(text)});
}

Place CommandLine::place(std::string_view text) const {
  Place place{file_, 1, 1, static_cast<int>(count_characters(file_->text)), nullptr};
  for (std::size_t i = 0; i < arguments_.size(); ++i) {
    const std::string_view argument = arguments_[i];
    if (text.empty() || !argument.ends_with(text)) continue;
    const std::size_t before = argument.size() - text.size();
    const bool whole = before == 0;
    const bool value = before > 1 && (argument[before - 1] == '=' || (before == 2 && argument[0] == '-'));
    if (!whole && !value) continue;
    place.column = columns_[i] + static_cast<int>(count_characters(argument.substr(0, before)));
    place.length = static_cast<int>(count_characters(text));
    if (whole) return place;
  }
  return place;
}

ConfigError CommandLine::error(std::string_view argument, std::string message, std::string hint) const {
  return ConfigError({Diagnostic{place(argument), std::move(message), std::move(hint), {}}});
}

}  // namespace coppice::cli
