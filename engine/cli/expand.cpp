#include <fmt/format.h>

#include "engine/cli/console.h"
#include "engine/cli/exit_status.h"
#include "engine/cli/inputs.h"

namespace coppice::cli {
namespace {

struct Expand : ConfigInputs {
  static Arguments<Expand> arguments() { return config_arguments<Expand>(); }

  int run(const CommandLine& line, Console& console) const {
    for (const ExperimentConfig& experiment : expand_all(line, *this)) console.out(flat(experiment));
    return kDone;
  }
};

const Command<Expand> kExpand(
    {.name = "expand",
     .group = Group::experiments,
     .rank = 4,
     .doc = "Writes the flat config: includes, arguments, macros, conditions and sweeps are worked out.",
     .details = "The flat config means the same experiment. Several configs are written one after the other.",
     .examples = {{"runner expand configs/quickstart.xml", "What the config comes to."}}});

}  // namespace
}  // namespace coppice::cli
