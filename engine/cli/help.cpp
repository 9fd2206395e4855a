#include "engine/cli/help.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/cli/layout.h"
#include "engine/cli/parse.h"

namespace coppice::cli {
namespace {

const char* title(Group group) {
  static constexpr const char* kTitles[] = {"Experiments", "Results", "Components", "Policies", "Project"};
  return kTitles[static_cast<int>(group)];
}

/// "  left    right", the right part wrapped; below a left part that is too long.
std::string row(const std::string& left, const std::string& right, std::size_t left_width,
                std::size_t width) {
  const std::string indent(left_width + 4, ' ');
  const std::string body = wrapped(indent + right, width, indent.size());
  if (left.size() > left_width) return "  " + left + '\n' + body + '\n';
  return fmt::format("  {:<{}}  {}\n", left, left_width, body.substr(indent.size()));
}

std::string spelling(const ArgumentInfo& info) {
  if (info.positional()) return info.name + (info.many ? "..." : "");
  const std::string names = (info.letter.empty() ? "    " : info.letter + ", ") + info.name;
  return info.flag() ? names : names + ' ' + info.value;
}

std::string meaning(const ArgumentInfo& info) {
  return info.default_text.empty() ? info.doc : info.doc + " Default: " + info.default_text + ".";
}

std::string usage(const CommandInfo& command) {
  std::string text = "runner " + command.name;
  for (const ArgumentInfo& info : command.arguments) {
    if (!info.positional()) continue;
    const std::string word = info.name + (info.many ? "..." : "");
    text += info.required ? ' ' + word : " [" + word + ']';
    if (info.completes == Completes::config) text += " [name:=value ...]";
  }
  return text + " [options]";
}

std::string rows(const std::vector<ArgumentInfo>& arguments, bool positional, std::size_t width) {
  std::string text;
  for (const ArgumentInfo& info : arguments) {
    if (info.positional() == positional) text += row(spelling(info), meaning(info), 24, width);
  }
  return text;
}

std::string markdown_rows(const std::vector<ArgumentInfo>& arguments) {
  std::string text;
  for (const ArgumentInfo& info : arguments) {
    const std::string letter = info.letter.empty() ? "" : '`' + info.letter + "`, ";
    std::string name = info.flag() || info.positional() ? info.name : info.name + ' ' + info.value;
    if (info.positional() && info.many) name += "...";
    text += fmt::format("- {}`{}`: {}\n", letter, name, meaning(info));
  }
  return text;
}

}  // namespace

std::string overview(std::size_t width, const std::string& family) {
  std::string text = family.empty() ? "Usage: runner CONFIG... [name:=value ...] [options]\n       runner "
                                      "COMMAND [arguments] [options]\n"
                                    : "Usage: runner " + family + " COMMAND [arguments] [options]\n";
  const char* previous = nullptr;
  for (const CommandInfo& info : commands()) {
    if (info.hidden || (!family.empty() && !info.name.starts_with(family + " "))) continue;
    if (previous != title(info.group)) text += fmt::format("\n{}:\n", title(info.group));
    previous = title(info.group);
    text += row(info.name, info.doc, 18, width);
  }
  text += "\nOptions of every command:\n" + rows(global_arguments(), false, width);
  return text +
         "\n'runner COMMAND --help' explains a command. 'runner CONFIG...' is short for 'runner run "
         "CONFIG...'.\n";
}

std::string help(const CommandInfo& command, std::size_t width) {
  std::string text =
      wrapped("Usage: " + usage(command), width, 7) + "\n\n" + wrapped(command.doc, width) + '\n';
  if (!command.details.empty()) text += '\n' + wrapped(command.details, width) + '\n';
  const std::string arguments = rows(command.arguments, true, width);
  if (!arguments.empty()) text += "\nArguments:\n" + arguments;
  text += "\nOptions:\n" + rows(command.arguments, false, width) + rows(global_arguments(), false, width);
  if (!command.examples.empty()) text += "\nExamples:\n";
  for (const Example& example : command.examples) {
    text +=
        "  " + example.command + '\n' + "      " + wrapped("      " + example.doc, width, 6).substr(6) + '\n';
  }
  return text;
}

std::string command_reference() {
  std::string text =
      "# Commands\n\nWritten by `runner manual` from the declarations of the commands.\n\n"
      "Every command takes:\n\n" +
      markdown_rows(global_arguments());
  for (const CommandInfo& info : commands()) {
    if (info.hidden) continue;
    text += fmt::format("\n## {}\n\n`{}`\n\n{}\n", info.name, usage(info), info.doc);
    if (!info.details.empty()) text += '\n' + info.details + '\n';
    if (!info.arguments.empty()) text += '\n' + markdown_rows(info.arguments);
    if (!info.examples.empty()) text += "\nExamples:\n";
    for (const Example& example : info.examples) {
      text += fmt::format("\n- {}:\n  `{}`\n", example.doc, example.command);
    }
  }
  return text;
}

}  // namespace coppice::cli
