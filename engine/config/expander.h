#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "engine/config/evaluator.h"
#include "engine/config/given_arguments.h"
#include "engine/config/sweep.h"

namespace coppice::config {

/// What one pass of expansion makes of a config.
struct Expansion {
  std::vector<SweepPoints> sweeps;
  std::vector<NodeElement> nodes;
  std::map<std::string, std::string> arguments;
  std::vector<UnusedPart> unused;
  std::vector<LeftOut> left_out;
  bool complete = true;
};

/// Expands a config once, for one value of every argument: walks through its elements in the order of the
/// text, works out definitions as it meets them, and collects the nodes. Goes on after a mistake wherever it
/// can.
class Expander {
 public:
  /// `root_seed` is what the config says, `seed` what counts (the command line's, if it gives one): for
  /// <random>.
  Expander(Files& files, GivenArguments& given, std::uint64_t root_seed, std::uint64_t seed,
           Diagnostics& diagnostics);

  Expansion run(const LoadedFile& file);

 private:
  struct MacroParameter {
    std::string name;
    bool block = false;
    bool has_default = false;
    Attribute default_value;
  };
  struct Macro {
    std::string name;
    std::vector<MacroParameter> parameters;
    const Element* element = nullptr;
    Place place;
  };
  /// An element of a file, and the calls and inserts by which expansion came to it: by another include, it is
  /// the same one met again.
  struct Origin {
    const Element* element = nullptr;
    std::vector<const Element*> way;

    Origin() = default;
    Origin(const Element& met, const Context& context);
    auto operator<=>(const Origin&) const = default;  // NOLINT(modernize-use-nullptr): it means the 0
  };
  struct DefinedSweep {
    Origin origin;
    SweepPoints points;
    SweepRows rows;
    bool failed = false;
    std::map<std::string, std::size_t> index;  ///< of the row with these values; filled when first needed
  };
  /// Ends an expansion that would not end by itself; the mistake was reported.
  struct Endless {};
  /// Ends the call of a macro that would not end by itself.
  struct TooDeep : Endless {};
  struct Exclusion {
    const Element* element = nullptr;
    Context context;
  };
  // expander.cpp: the walk. `parent` takes the expanded children; null at the top level, where nodes are
  // collected.
  void children(const Element& element, const Context& context, Element* parent);
  void element(const Element& element, const Context& context, Element* parent);
  bool control(const Element& element, const Context& context, Element* parent);
  bool wanted(const Element& element, const Context& context);
  bool condition(const Attribute& attribute, const Context& context, bool otherwise);
  Element copy(const Element& element, const Context& context);
  void count(const Element& element, const Context& context);
  bool check(const Element& element, std::string_view parent, const Context& context);
  bool global_only(const Element& element, const Context& context);
  void error(const Place& place, const Context& context, std::string message, std::string hint = {},
             std::vector<std::string> notes = {});
  /// Notes what a condition leaves out.
  void skip(const Element& element, const Context& context, const Element* parent);
  void note_left_out(const Element& element, const Context& context);
  std::string quiet_text(const Attribute& attribute, const Context& context) const;
  /// Keeps what is left out, for check_unused.
  void keep_unused(const Element& element, const Context& context, std::string parent);
  void finish_unused(const LoadedFile& file);
  /// A mistake that leaves out elements.
  void leave_out(Element* parent);

  // expander_definitions.cpp
  void argument(const Element& element, const Context& context);
  void let(const Element& element, const Context& context);
  void define(const Attribute& name, std::optional<Value> value, const Element& element, std::string what,
              const Context& context);
  std::optional<Value> argument_value(const Element& element, const std::string& name,
                                      const Context& context);
  std::optional<Value> given_value(const Element& element, GivenArgument& given, const Context& context);
  void check_values(const Element& element, const Context& context);
  std::optional<Value> checked(const Element& element, const Attribute& source, std::optional<Value> value,
                               const Context& context);
  std::optional<Value> typed(const Element& element, const Attribute& source, const Value& value,
                             const Context& context);
  std::optional<Value> with_unit(const Element& element, const Attribute& source, const Value& value,
                                 const Context& context);
  bool allowed(const Element& element, const Attribute& source, const Value& value, const Context& context);

  // expander_include.cpp
  void include(const Element& element, const Context& context, Element* parent);
  const LoadedFile* included_file(const Element& element, const Context& context);
  bool in_circle(const LoadedFile& file, const Attribute& attribute);
  void check_included_root(const LoadedFile& file, const std::shared_ptr<const TraceFrame>& trace);
  void check_passed(const PassedArguments& passed, const std::string& file);

  // expander_macros.cpp
  void macro(const Element& element, const Context& context);
  std::vector<MacroParameter> parameters(const Attribute& params, const Context& context);
  void call(const Element& element, const Context& context, Element* parent);
  void expand_call(const Macro& macro, const Element& element, const Context& context, Element* parent);
  const Macro* find_macro(const Element& element, const Context& context);
  Context body_context(const Macro& macro, const Element& call, const Context& context);
  void pass_values(const Macro& macro, const Element& call, const Context& context, const Context& body);
  void pass_blocks(const Macro& macro, const Element& call, const Context& context, MacroFrame& frame);
  void check_depth(const Element& element, const Context& context);
  void insert(const Element& element, const Context& context, Element* parent);

  // expander_sweeps.cpp
  void sweep(const Element& element, const Context& context);
  static bool met_again(const DefinedSweep& first, const DefinedSweep& again);
  void fill(DefinedSweep& sweep, const Element& plain, const std::vector<Exclusion>& exclusions,
            const Context& context);
  void check_columns(const DefinedSweep& sweep, const Context& context);
  void exclude(DefinedSweep& sweep, const std::vector<Exclusion>& exclusions);

  // expander_nodes.cpp
  void node(const Element& element, const Context& context);
  void node_over_sweeps(const Element& element, const Context& context);
  void node_at_each_point(const Element& element, const std::vector<DefinedSweep*>& sweeps,
                          const std::optional<Attribute>& id, const Context& context);
  bool may_have_so_many(const Element& element, const std::vector<DefinedSweep*>& sweeps,
                        const Context& context);
  bool left_out_with_its_sweeps(const Element& element, Context context);
  const LeftOut* sweep_left_out(const std::string& id) const;
  std::vector<DefinedSweep*> sweeps_of(const Element& element, Context& context);
  bool check_shared_columns(const Attribute& over, const std::vector<DefinedSweep*>& sweeps,
                            const Context& context);
  std::optional<std::vector<std::size_t>> point_of(const Attribute& at,
                                                   const std::vector<DefinedSweep*>& sweeps,
                                                   const Context& context);
  void node_at_point(const Element& element, const std::vector<DefinedSweep*>& sweeps,
                     const std::vector<std::size_t>& rows, const std::optional<Attribute>& id,
                     const Context& context);

  Files& files_;
  GivenArguments& given_;
  std::uint64_t root_seed_, seed_;
  Diagnostics& diagnostics_;
  Evaluator evaluator_;
  std::shared_ptr<Scope> global_;
  std::map<std::string, std::unique_ptr<const Macro>, std::less<>> macros_;
  std::map<std::string, std::unique_ptr<DefinedSweep>, std::less<>> sweeps_;
  std::vector<const DefinedSweep*> sweep_order_;
  std::map<Origin, std::pair<std::size_t, std::size_t>> made_;  // of result_.nodes: first and last + 1
  std::vector<const LoadedFile*> active_;  // files that are being expanded, each included by the one before
  std::vector<Exclusion>* exclusions_ = nullptr;  // of the sweep that is being expanded
  const Element* sweep_ = nullptr;                // that sweep
  std::set<const Macro*> called_;
  std::set<const Element*> unused_;  // those that are kept
  std::size_t elements_ = 0;
  Expansion result_;
};

}  // namespace coppice::config
