#include <nlohmann/json.hpp>

#include "engine/cli/command.h"
#include "engine/cli/console.h"
#include "engine/cli/exit_status.h"
#include "engine/cli/layout.h"
#include "registry/component.h"
#include "registry/suggest.h"

namespace coppice::cli {
namespace {

using Json = nlohmann::ordered_json;

struct List {
  std::string kind;
  bool as_json = false;

  static Arguments<List> arguments() {
    return Arguments<List>()
        .positional("KIND", &List::kind,
                    "Kind of component: problem, policy, solver, ...; all when not given.",
                    Completes::interface, false)
        .flag("--json", &List::as_json, "The same as JSON.");
  }

  int run(const CommandLine& line, Console& console) const {
    const Catalogue& catalogue = Catalogue::instance();
    std::vector<std::string> kinds = catalogue.interfaces();
    if (!kind.empty()) {
      if (std::find(kinds.begin(), kinds.end(), kind) == kinds.end()) {
        throw line.error(kind, "there is no kind of component '" + kind + "'", suggestion(kind, kinds));
      }
      kinds = {kind};
    }
    std::vector<std::vector<std::string>> rows;
    Json all = Json::array();
    for (const std::string& name : kinds) {
      for (const ComponentInfo* info : catalogue.all(name)) {
        rows.push_back({info->name, info->doc});
        if (kind.empty()) rows.back().insert(rows.back().begin(), name);
        all.push_back({{"kind", name},
                       {"name", info->name},
                       {"doc", info->doc},
                       {"source", info->source},
                       {"version", info->version}});
      }
    }
    const std::size_t width = console.stdout_is_terminal() ? static_cast<std::size_t>(console.width()) : 0;
    console.out(as_json ? all.dump(2) + '\n' : aligned(rows, 0, width));
    return kDone;
  }
};

const Command<List> kList({.name = "list",
                           .group = Group::components,
                           .rank = 1,
                           .doc = "Lists the components, all or of one kind.",
                           .examples = {{"runner list", "All components with their kind."},
                                        {"runner list problem", "The problems."}}});

}  // namespace
}  // namespace coppice::cli
