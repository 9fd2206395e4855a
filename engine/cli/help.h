#pragma once

#include <string>

#include "engine/cli/command.h"

namespace coppice::cli {

/// All subcommands by group, each with its line; or only those of a family ("policy").
std::string overview(std::size_t width, const std::string& family = {});
/// Usage, description, arguments, options and examples of one subcommand.
std::string help(const CommandInfo& command, std::size_t width);
/// The same for all subcommands, as a page of the manual (Markdown).
std::string command_reference();

}  // namespace coppice::cli
