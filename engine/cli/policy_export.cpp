#include <fmt/format.h>

#include <stdexcept>

#include "engine/cli/console.h"
#include "engine/cli/exit_status.h"
#include "engine/cli/policy_inputs.h"
#include "engine/data/file_system.h"
#include "engine/graph/export.h"

namespace coppice::cli {
namespace {

/// Does it; what it throws is a mistake in that word of the command line.
template <class Call>
auto located(const CommandLine& line, const std::string& word, const Call& call) {
  try {
    return call();
  } catch (const std::invalid_argument& wrong) {
    throw line.error(word, wrong.what());
  }
}

struct PolicyExport : PolicyInputs {
  std::string to;
  std::string output = "-";
  std::string name = "policy";

  static Arguments<PolicyExport> arguments() {
    return policy_arguments<PolicyExport>()
        .option("--to", "FORMAT", &PolicyExport::to, "cpp, dot, json, onnx, or another exporter.",
                Completes::exporter)
        .option("--output", "FILE", &PolicyExport::output, "Where to write; -: standard output.",
                Completes::file)
        .option("--name", "NAME", &PolicyExport::name, "Of the policy: the namespace in a C++ header.");
  }

  int run(const CommandLine& line, Console& console) const {
    if (to.empty()) throw line.error(file, "policy export needs --to cpp, dot, json or onnx");
    const std::shared_ptr<const Exporter> exporter = located(line, to, [this] { return make_exporter(to); });
    located(line, name, [&] {
      check_export_name(name);
      exporter->check_name(name);
    });
    if (output == "-" && exporter->binary() && console.stdout_is_terminal())
      throw line.error(to, "the output is no text: say where to with --output FILE");
    const ReadyPolicy ready = ready_policy(line, *this);
    const std::string content = located(line, file, [&] {
      return exporter->write(exported_policy(name, ready.policy, ready.file, ready.spaces));
    });
    if (output == "-") {
      console.out(content);
    } else {
      write_file(output, content);
    }
    return kDone;
  }
};

const Command<PolicyExport> kPolicyExport(
    {.name = "policy export",
     .group = Group::policies,
     .doc = "Writes a policy as a C++ header, JSON, ONNX or a drawing.",
     .details = "What each format can express, and how a robot uses the header, is said in docs/exports.md. "
                "Policies that decide by a program of their own are refused.",
     .examples = {{"runner policy export learned.policy --to cpp --name onboard --output onboard.h",
                   "A header without dependencies."},
                  {"runner policy export learned.policy --to json", "Everything, for other programs."}}});

}  // namespace
}  // namespace coppice::cli
