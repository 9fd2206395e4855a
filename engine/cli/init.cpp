#include <fmt/format.h>

#include <filesystem>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/cli/command.h"
#include "engine/cli/console.h"
#include "engine/cli/exit_status.h"
#include "engine/config/language.h"
#include "engine/data/file_system.h"
#include "registry/schema.h"

namespace coppice::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kExperiment = R"(<?xml version="1.0" encoding="UTF-8"?>
<?xml-model href="coppice.xsd" type="application/xml" schematypens="http://www.w3.org/2001/XMLSchema"?>
<experiment coppice="1" seed="1" doc="Learn to stop a car at the origin">
  <arg name="replicates" default="5" doc="training runs; intervals are over these"/>

  <!-- What is to be done, and who does it so far. 'runner list problem' names other problems. -->
  <problem id="car"><double_integrator/></problem>
  <policy id="random"><random/></policy>

  <!-- Samples to learn from, then the training; both once for each replicate. -->
  <collect id="episodes" problem="car" policy="random" episodes="300" replicates="${replicates}"/>
  <train id="fpf_pwl" problem="car" samples="episodes" replicates="${replicates}">
    <fpf model_samples="3000" target_min="-5" maximization="exact" policy_samples="2000">
      <q_value><extra_trees leaves="pwl" n_min="15"/></q_value>
      <policy><extra_trees leaves="pwl" n_min="300"/></policy>
    </fpf>
  </train>

  <!-- Evidence: every policy on scenarios that none of them was made with. -->
  <evaluate id="scores" problem="car" policies="random, fpf_pwl" episodes="20"/>
  <table id="costs" of="scores" rows="policy" metric="cost"/>
</experiment>
)";

constexpr std::string_view kIgnored = "out/\n";

struct Init {
  std::string folder = ".";

  static Arguments<Init> arguments() {
    return Arguments<Init>().positional(
        "DIR", &Init::folder, "The project's folder; made when it is not there.", Completes::folder, false);
  }

  int run(const CommandLine& line, Console& console) const {
    const std::vector<std::pair<std::string, std::string>> files = {
        {"experiment.xml", std::string(kExperiment)},
        {"coppice.xsd", xml_schema(Catalogue::instance(), config_language())},
        {".gitignore", std::string(kIgnored)}};
    for (const auto& [name, text] : files) {
      if (fs::exists(fs::symlink_status(fs::path(folder) / name)))
        throw line.error(folder, fmt::format("'{}' has a file {} already; nothing was written", folder, name),
                         "name another folder");
    }
    make_folder(folder);
    for (const auto& [name, text] : files) {
      write_file(fs::path(folder) / name, text);
      console.offer((fs::path(folder) / name).lexically_normal().string() + '\n');
    }
    console.say(
        fmt::format("next: runner {}\n", (fs::path(folder) / "experiment.xml").lexically_normal().string()));
    return kDone;
  }
};

const Command<Init> kInit(
    {.name = "init",
     .group = Group::project,
     .rank = 1,
     .doc = "Starts a project folder: a first experiment, and the schema that lets editors complete it.",
     .details = "Files that are there are left as they are: the command then writes nothing.",
     .examples = {{"runner init my_robot",
                   "Writes my_robot/experiment.xml, my_robot/coppice.xsd and a .gitignore."}}});

}  // namespace
}  // namespace coppice::cli
