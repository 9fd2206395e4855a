#include <fmt/format.h>

#include "engine/cli/command.h"
#include "engine/cli/console.h"
#include "engine/cli/exit_status.h"
#include "engine/cli/layout.h"
#include "engine/graph/store.h"

namespace coppice::cli {
namespace {

struct Gc {
  std::string out = "out";
  bool dry_run = false;

  static Arguments<Gc> arguments() {
    return Arguments<Gc>()
        .positional("DIR", &Gc::out, "Folder of results.", Completes::folder, false)
        .flag("--dry-run", &Gc::dry_run, "Only say what would be removed.");
  }

  int run(const CommandLine& line, Console& console) const {
    if (!std::filesystem::is_directory(std::filesystem::path(out) / "store")) {
      throw line.error(out, "'" + out + "' is no folder of results: it has no store");
    }
    const Garbage garbage = collect_garbage(out, dry_run);
    console.say(fmt::format("{} {} and {}, {:.1f} MB\n", dry_run ? "would remove" : "removed",
                            counted(garbage.results, "result"), counted(garbage.objects, "file"),
                            1e-6 * static_cast<double>(garbage.bytes)));
    return kDone;
  }
};

const Command<Gc> kGc({.name = "gc",
                       .group = Group::results,
                       .rank = 8,
                       .doc = "Removes stored results that no experiment in the output folder refers to.",
                       .examples = {{"runner gc --dry-run", "What could be removed from out/."},
                                    {"runner gc results", "Removes it from results/."}}});

}  // namespace
}  // namespace coppice::cli
