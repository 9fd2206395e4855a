#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "engine/cli/console.h"
#include "engine/cli/exit_status.h"
#include "engine/cli/inputs.h"
#include "engine/cli/layout.h"

namespace coppice::cli {
namespace {

using Json = nlohmann::ordered_json;

Json json(const Diagnostic& diagnostic) {
  const Place& place = diagnostic.place;
  Json object = {{"file", place.file ? place.file->path : ""},
                 {"line", place.line},
                 {"column", place.column},
                 {"length", place.length},
                 {"message", diagnostic.message},
                 {"hint", diagnostic.hint},
                 {"notes", diagnostic.notes}};
  object["trace"] = Json::array();
  for (const TraceFrame* frame = place.trace.get(); frame != nullptr; frame = frame->outer.get()) {
    object["trace"].push_back(
        {{"what", frame->what}, {"file", frame->file ? frame->file->path : ""}, {"line", frame->line}});
  }
  return object;
}

struct Validate : ConfigInputs {
  std::string format = "text";

  static Arguments<Validate> arguments() {
    return config_arguments<Validate>().choice("--format", &Validate::format, {"text", "json"},
                                               "How mistakes are shown: text on stderr, or JSON on stdout.");
  }

  int run(const CommandLine& line, Console& console) const {
    if (format == "text") {
      for (const Plan& plan : plan_all(line, *this)) {
        console.say(fmt::format("{}: valid, {}\n", plan.experiment.path, counted(plan.nodes.size(), "node")));
      }
      return kDone;
    }
    Json errors = Json::array();
    try {
      plan_all(line, *this);
    } catch (const ConfigError& error) {
      for (const Diagnostic& diagnostic : error.diagnostics()) errors.push_back(json(diagnostic));
    }
    const bool valid = errors.empty();
    const Json report = {{"valid", valid}, {"errors", std::move(errors)}};
    console.out(report.dump(2, ' ', false, Json::error_handler_t::replace) + '\n');
    return valid ? kDone : kBadUsage;
  }
};

const Command<Validate> kValidate(
    {.name = "validate",
     .group = Group::experiments,
     .rank = 3,
     .doc = "Checks configs without running anything; shows every mistake of every file.",
     .examples = {
         {"runner validate configs/quickstart.xml", "Checks one config."},
         {"runner validate configs/quickstart.xml --format json", "The mistakes as JSON, for editors."}}});

}  // namespace
}  // namespace coppice::cli
