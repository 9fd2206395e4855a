#include <fmt/format.h>

#include "engine/cli/console.h"
#include "engine/cli/exit_status.h"
#include "engine/cli/inputs.h"
#include "engine/cli/last_run.h"
#include "engine/cli/layout.h"
#include "engine/graph/status.h"
#include "registry/suggest.h"

namespace coppice::cli {
namespace {

std::string indented(const std::string& text) {
  std::string out = "    ";
  for (const char c : text) {
    out += c;
    if (c == '\n') out += "    ";
  }
  while (out.ends_with(' ') || out.ends_with('\n')) out.pop_back();
  return out + '\n';
}

std::string text(const Explanation& explanation) {
  std::string text = fmt::format("{}: {}\n", explanation.name, to_text(explanation.status));
  for (const Change& change : explanation.status.changes) {
    text += fmt::format("  {}\n    was {}\n    is  {}\n", change.what,
                        change.before.empty() ? "-" : change.before, change.now.empty() ? "-" : change.now);
  }
  return text + "  key " + explanation.key + ", made of\n" + indented(explanation.key_text);
}

struct Why {
  std::string node;
  std::vector<std::string> words;
  std::optional<std::uint64_t> seed;
  std::string out = "out";

  static Arguments<Why> arguments() {
    return Arguments<Why>()
        .positional("NODE", &Why::node, "A node's id, or its name as 'plan' shows it.", Completes::node)
        .positional(
            "CONFIG", &Why::words,
            "Configs that may have it, and name:=value; those of the last runs in the output folder when not "
            "given.",
            Completes::config, false)
        .option("--seed", "N", &Why::seed, "Root seed, in place of the configs' own.")
        .option("--out", "DIR", &Why::out, "Folder of the results.", Completes::folder);
  }

  int run(const CommandLine& line, Console& console) const {
    std::vector<std::string> known;
    bool found = false;
    for (const Plan& plan : plans(line)) {
      const std::vector<std::string> ids = plan.ids();
      known.insert(known.end(), ids.begin(), ids.end());
      if (plan.find(node).empty()) continue;
      found = true;
      for (const Explanation& explanation : explain(plan, node, out)) console.out(text(explanation));
    }
    if (!found) throw line.error(node, "there is no node '" + node + "'", suggestion(node, known));
    return kDone;
  }

 private:
  std::vector<Plan> plans(const CommandLine& line) const {
    if (words.empty()) return plans_of_last_runs(line, out);
    ConfigInputs inputs;
    inputs.words = words;
    inputs.seed = seed;
    return plan_all(line, inputs);
  }
};

const Command<Why> kWhy(
    {.name = "why",
     .group = Group::experiments,
     .rank = 5,
     .doc = "Shows what a node's key is made of, and which input changed since the last run.",
     .details = "A node runs again exactly when its key is a new one.",
     .examples = {{"runner why scores",
                   "The nodes 'scores' of the experiments in out/, with the configs as they are now."},
                  {"runner why scores configs/quickstart.xml replicates:=8 --out results",
                   "What a change of an argument would make of them."}}});

}  // namespace
}  // namespace coppice::cli
