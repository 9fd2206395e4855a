#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

#include "engine/cli/console.h"
#include "engine/cli/exit_status.h"
#include "engine/cli/policy_inputs.h"
#include "engine/cli/row_stream.h"
#include "engine/data/csv.h"
#include "registry/suggest.h"

namespace coppice::cli {
namespace {

constexpr const char* kInput = "<standard input>";

std::shared_ptr<const SourceFile> source(std::string text) {
  return std::make_shared<const SourceFile>(SourceFile{kInput, std::move(text)});
}

/// The same mistake, located in the whole input: what was read before is stood in for by empty lines.
ConfigError moved_down(const ConfigError& error, const std::string& records, std::size_t lines_before) {
  std::vector<Diagnostic> all = error.diagnostics();
  const auto whole = source(std::string(lines_before, '\n') + records);
  for (Diagnostic& diagnostic : all) {
    // The records were read below a copy of the header, which is line 1.
    diagnostic.place.line += static_cast<int>(lines_before) - 1;
    diagnostic.place.file = whole;
  }
  return ConfigError(std::move(all));
}

/// What acts on one state after the other, as they come in.
class Actor {
 public:
  Actor(const ReadyPolicy& ready, std::uint64_t seed)
      : policy_(*ready.policy),
        spaces_(ready.spaces),
        draws_(seed, "act", 0),
        memory_(policy_.memory_size()) {}

  std::string header() const {
    std::string text = "action_id";
    for (std::size_t i = 0; i < spaces_.widest_action(); ++i) text += ",a_" + axis_name(i);
    return text + '\n';
  }

  /// Finds the state's axes among the input's columns.
  void read_header(const CsvReader& reader) {
    Diagnostics diagnostics;
    std::vector<std::string> names;
    for (const Axis& axis : spaces_.states) names.push_back("s_" + axis.name);
    for (std::size_t i = 0; i < reader.header().size(); ++i) {
      const std::string& name = reader.header()[i];
      if (name.starts_with("s_") && std::find(names.begin(), names.end(), name) == names.end()) {
        diagnostics.error(reader.header_place(i), "the state has no axis '" + name + "'",
                          suggestion(name, names));
      }
    }
    for (const std::string& name : names) {
      const std::optional<std::size_t> column = reader.column(name);
      if (!column) diagnostics.error(reader.header_place(0), "there is no column '" + name + "'");
      state_columns_.push_back(column.value_or(0));
    }
    diagnostics.throw_if_any();
    episode_column_ = reader.column("episode");
  }

  /// Appends the action for the current record.
  void act(const CsvReader& reader, std::string& text) {
    Diagnostics diagnostics;
    state_.resize(state_columns_.size());
    for (std::size_t i = 0; i < state_.size(); ++i) {
      const std::size_t column = state_columns_[i];
      const std::optional<double> value = parse_number(reader[column]);
      if (!value) {
        diagnostics.error(reader.place(column), fmt::format("'{}' must be a finite number, not '{}'",
                                                            reader.header()[column], reader[column]));
      }
      state_[i] = value.value_or(0);
    }
    diagnostics.throw_if_any();
    const std::string episode(episode_column_ ? reader[*episode_column_] : "");
    if (!started_ || episode != episode_) begin(episode);
    policy_.act(state_, memory_, draws_.scenario(scenario_).step(step_++), action_);
    text += std::to_string(action_.id);
    for (std::size_t i = 0; i < spaces_.widest_action(); ++i) {
      text += ',';
      if (i < action_.values.size()) append_csv(text, action_.values[i]);
    }
    text += '\n';
  }

 private:
  /// The column of an action's parameter is named after the widest action's axes.
  std::string axis_name(std::size_t i) const {
    for (const ActionBox& box : spaces_.actions) {
      if (box.axes.size() == spaces_.widest_action()) return box.axes[i].name;
    }
    return {};
  }
  void begin(const std::string& episode) {
    scenario_ += started_ ? 1 : 0;
    started_ = true;
    episode_ = episode;
    step_ = 0;
    policy_.reset(memory_);
  }

  const Policy& policy_;
  const Spaces& spaces_;
  Draws draws_;
  std::vector<double> memory_;
  std::vector<std::size_t> state_columns_;
  std::optional<std::size_t> episode_column_;
  std::vector<double> state_;
  Action action_;
  std::string episode_;
  std::uint64_t scenario_ = 0;
  std::uint32_t step_ = 0;
  bool started_ = false;
};

struct PolicyAct : PolicyInputs {
  std::uint64_t seed = 0;

  static Arguments<PolicyAct> arguments() {
    return policy_arguments<PolicyAct>().option("--seed", "N", &PolicyAct::seed,
                                                "Root seed of a policy that draws.");
  }

  int run(const CommandLine& line, Console& console) const {
    const ReadyPolicy ready = ready_policy(line, *this);
    Actor actor(ready, seed);
    RowStream rows(STDIN_FILENO, [&] { console.flush(); });
    std::string header;
    std::size_t lines = 0;
    while (const std::optional<std::string> records = rows.next()) {
      act_on(*records, lines, header, actor, console);
      lines += static_cast<std::size_t>(std::count(records->begin(), records->end(), '\n'));
    }
    if (header.empty())
      throw ConfigError(std::string(kInput) + ": no data; a header with the columns s_<axis> is needed");
    return kDone;
  }

 private:
  /// Acts on whole records; the first that come bring the header.
  static void act_on(const std::string& records, std::size_t lines_before, std::string& header, Actor& actor,
                     Console& console) {
    const bool first = header.empty();
    std::string text;
    try {
      CsvReader reader(source(header + records));
      if (first) {
        actor.read_header(reader);
        for (const std::string& name : reader.header()) append_csv(header += header.empty() ? "" : ",", name);
        header += '\n';
        text += actor.header();
      }
      while (reader.next()) actor.act(reader, text);
    } catch (const ConfigError& error) {
      console.out(text);
      if (first) throw;
      throw moved_down(error, records, lines_before);
    }
    console.out(text);
  }
};

const Command<PolicyAct> kPolicyAct(
    {.name = "policy act",
     .group = Group::policies,
     .doc = "Reads states as CSV from stdin and writes the policy's actions as CSV.",
     .details = "The columns s_<axis> of the state are needed, in any order; other columns are passed over. "
                "One row is "
                "written for each that is read, as soon as it is there: action_id and the columns a_<axis> "
                "of the widest "
                "action, empty where an action has fewer. Rows are the steps of one episode, or of several "
                "when there is "
                "a column 'episode'. The first bad row ends it.",
     .examples = {{"printf 's_position,s_speed\\n1,0\\n' | runner policy act learned.policy",
                   "The action in one state."}}});

}  // namespace
}  // namespace coppice::cli
