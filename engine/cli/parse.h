#pragma once

#include <string>

#include "engine/cli/command.h"

namespace coppice::cli {

/// What the user asks for.
struct Request {
  const CommandInfo* command = nullptr;  ///< null: none was named
  std::string family;                    ///< "policy" when only the first of two words was given
  Given given;
  bool help = false;
  bool version = false;
};

/// The options of every subcommand: --help, --version, --color.
const std::vector<ArgumentInfo>& global_arguments();

/// The value of --color, known before anything else so that it holds for mistakes on the line too.
std::string color_choice(const CommandLine& line);

/// Finds the subcommand (a config where one would stand means `run`) and sorts the arguments, in any order.
/// Throws ConfigError with every unknown or incomplete argument, each with the nearest valid name.
Request parse(const CommandLine& line);

}  // namespace coppice::cli
