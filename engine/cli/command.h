#pragma once

#include <charconv>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "engine/cli/command_line.h"
#include "registry/error.h"

namespace coppice::cli {

class Console;

/// What the shell may offer where an argument's value stands.
enum class Completes {
  nothing,
  config,
  file,
  folder,
  component,
  problem,
  exporter,
  interface,
  node,
  command
};

/// A positional argument ("CONFIG") or an option ("--out"), as parsing, help, completion and the manual see
/// it.
struct ArgumentInfo {
  std::string name;
  std::string letter = {};  ///< "-j"; empty: none
  std::string value = {};   ///< what stands for the value in help ("DIR"); empty: a flag
  std::string doc;
  std::vector<std::string> choices = {};
  std::string default_text = {};
  bool required = false;
  bool many = false;
  Completes completes = Completes::nothing;

  bool positional() const { return !name.starts_with('-'); }
  bool flag() const { return value.empty(); }
};

/// A command line that works, and what it is for.
struct Example {
  std::string command;
  std::string doc;
};

/// The texts given for each argument, in the order of the declaration; a flag's text is empty.
using Given = std::vector<std::vector<std::string>>;

/// Where a subcommand stands in the overview of help.
enum class Group { experiments, results, components, policies, project };

/// A subcommand: everything that dispatch, help, completion and the manual know of it.
struct CommandInfo {
  std::string name;  ///< "run", "policy act"
  Group group = Group::experiments;
  int rank = 9;              ///< place within the group; equal ranks stand by name
  std::string doc;           ///< one line
  std::string details = {};  ///< further paragraphs; may be empty
  std::vector<Example> examples = {};
  bool hidden = false;
  std::vector<ArgumentInfo> arguments = {};
  /// Does it and returns the exit status; throws ConfigError for the user's mistakes.
  std::function<int(const CommandLine&, const Given&, Console&)> run = {};
};

/// All subcommands, sorted by group, rank and name.
const std::vector<CommandInfo>& commands();
const CommandInfo* find_command(std::string_view name);
void add_command(CommandInfo info);

namespace detail {
/// Each sets the value, or returns the broken rule ("must be an integer >= 0").
std::string read_text(const std::string& text, std::string& value);
std::string read_text(const std::string& text, std::optional<std::string>& value);
std::string read_text(const std::string& text, std::optional<std::uint64_t>& value);
std::string read_text(const std::string& text, std::uint64_t& value);
std::string read_text(const std::string& text, std::vector<std::string>& value);
std::string default_text(const std::string& value);
std::string default_text(std::uint64_t value);
template <class V>
std::string default_text(const V&) {
  return {};
}
}  // namespace detail

/// The arguments of a subcommand T: its members; the defaults are those of `T{}`.
template <class T>
class Arguments {
 public:
  /// A positional argument; a vector takes all that are left.
  template <class V>
  Arguments& positional(std::string name, V T::*member, std::string doc, Completes completes,
                        bool required = true) {
    ArgumentInfo info;
    info.value = name;
    info.required = required;
    info.completes = completes;
    return insert(std::move(info), std::move(name), member, std::move(doc));
  }
  /// An option with a value; `names` is "--out", or "-j,--jobs".
  template <class V>
  Arguments& option(std::string names, std::string value, V T::*member, std::string doc,
                    Completes completes = Completes::nothing) {
    ArgumentInfo info;
    info.value = std::move(value);
    info.completes = completes;
    return insert(std::move(info), std::move(names), member, std::move(doc));
  }
  /// An option whose value is one of a few names.
  Arguments& choice(std::string names, std::string T::*member, std::vector<std::string> choices,
                    std::string doc) {
    ArgumentInfo info;
    for (const std::string& name : choices) info.value += (info.value.empty() ? "" : "|") + name;
    info.choices = std::move(choices);
    info.required = !names.starts_with('-');
    return insert(std::move(info), std::move(names), member, std::move(doc));
  }
  Arguments& flag(std::string names, bool T::*member, std::string doc) {
    fields_.push_back([member](T& object, const std::string&) {
      object.*member = true;
      return std::string();
    });
    arguments_.push_back(named({}, std::move(names), std::move(doc)));
    return *this;
  }

  const std::vector<ArgumentInfo>& arguments() const { return arguments_; }

  /// Throws ConfigError with every value that does not fit.
  T read(const CommandLine& line, const Given& given) const {
    T object{};
    Diagnostics diagnostics;
    for (std::size_t i = 0; i < fields_.size(); ++i) {
      for (const std::string& text : given[i]) {
        const std::string broken = fields_[i](object, text);
        if (!broken.empty()) {
          diagnostics.error(line.place(text),
                            "'" + arguments_[i].name + "' " + broken + ", not '" + text + "'");
        }
      }
    }
    diagnostics.throw_if_any();
    return object;
  }

 private:
  template <class V>
  Arguments& insert(ArgumentInfo info, std::string names, V T::*member, std::string doc) {
    info.many = std::is_same_v<V, std::vector<std::string>>;
    info.default_text = detail::default_text(T{}.*member);
    fields_.push_back(
        [member](T& object, const std::string& text) { return detail::read_text(text, object.*member); });
    arguments_.push_back(named(std::move(info), std::move(names), std::move(doc)));
    return *this;
  }
  static ArgumentInfo named(ArgumentInfo info, std::string names, std::string doc) {
    const std::size_t comma = names.find(',');
    if (comma != std::string::npos) info.letter = names.substr(0, comma);
    info.name = comma == std::string::npos ? std::move(names) : names.substr(comma + 1);
    info.doc = std::move(doc);
    return info;
  }

  std::vector<ArgumentInfo> arguments_;
  std::vector<std::function<std::string(T&, const std::string&)>> fields_;
};

/// Registers T as a subcommand; a constant at namespace scope in its file. T has `static Arguments<T>
/// arguments()` and `int run(const CommandLine&, Console&) const`, which returns the exit status.
template <class T>
struct Command {
  explicit Command(CommandInfo info) {
    const Arguments<T> arguments = T::arguments();
    info.arguments = arguments.arguments();
    info.run = [arguments](const CommandLine& line, const Given& given, Console& console) {
      return arguments.read(line, given).run(line, console);
    };
    add_command(std::move(info));
  }
};

}  // namespace coppice::cli
