#include "registry/manual.h"

#include <filesystem>

#include "engine/cli/command.h"
#include "engine/cli/console.h"
#include "engine/cli/exit_status.h"
#include "engine/cli/help.h"
#include "engine/config/language.h"
#include "engine/data/file_system.h"

namespace coppice::cli {
namespace {

struct Manual {
  std::string folder;

  static Arguments<Manual> arguments() {
    return Arguments<Manual>().positional(
        "DIR", &Manual::folder, "Folder to write into; made when it is not there.", Completes::folder);
  }

  int run(const CommandLine&, Console&) const {
    std::filesystem::create_directories(folder);
    std::vector<ManualPage> pages = manual_pages(Catalogue::instance(), config_language());
    pages.push_back({"commands.md", command_reference()});
    for (const ManualPage& page : pages) write_file(std::filesystem::path(folder) / page.file, page.text);
    return kDone;
  }
};

const Command<Manual> kManual(
    {.name = "manual",
     .group = Group::components,
     .rank = 4,
     .doc = "Writes the reference manual as Markdown: all components, the language, units, commands.",
     .examples = {{"runner manual docs/manual", "Writes the pages that the project ships."}}});

}  // namespace
}  // namespace coppice::cli
