#include "engine/cli/console.h"
#include "engine/cli/exit_status.h"
#include "engine/cli/help.h"
#include "registry/suggest.h"
#include "registry/text.h"

namespace coppice::cli {
namespace {

struct Help {
  std::vector<std::string> words;

  static Arguments<Help> arguments() {
    return Arguments<Help>().positional(
        "COMMAND", &Help::words, "The command to explain; all when not given.", Completes::command, false);
  }

  int run(const CommandLine& line, Console& console) const {
    const std::size_t width = static_cast<std::size_t>(console.width());
    const std::string name = join(words, " ");
    const CommandInfo* command = find_command(name);
    const std::string list = overview(width, name);
    if (command == nullptr && !name.empty() && !is_family(name)) {
      std::vector<std::string> known;
      for (const CommandInfo& info : commands()) {
        if (!info.hidden) known.push_back(info.name);
      }
      throw line.error(words.back(), "there is no command '" + name + "'", suggestion(name, known));
    }
    console.out(command != nullptr ? help(*command, width) : list);
    return kDone;
  }

 private:
  static bool is_family(const std::string& name) {
    for (const CommandInfo& info : commands()) {
      if (info.name.starts_with(name + ' ')) return true;
    }
    return false;
  }
};

const Command<Help> kHelp({.name = "help",
                           .group = Group::project,
                           .doc = "Explains a command, as 'runner COMMAND --help' does.",
                           .examples = {{"runner help run", "Explains 'run'."}}});

}  // namespace
}  // namespace coppice::cli
