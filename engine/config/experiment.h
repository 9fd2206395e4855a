#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "registry/source.h"

namespace coppice {

/// name:=value from the command line; the place points into a SourceFile called "<command line>".
struct Override {
  std::string name;
  std::string value;
  Place place;
};

/// One value of a sweep point: column and text ("variant", "HA").
using PointValue = std::pair<std::string, std::string>;
using Point = std::vector<PointValue>;

/// A sweep after expansion: its points in order, each with the same columns.
struct SweepPoints {
  std::string id;
  Place place;
  std::vector<std::string> columns;
  std::vector<Point> points;
  /// An argument given several values (a:=1,2,3): every node runs over it, whether its element depends on it
  /// or not. A node that gathers may take all its points at once where its element is the same at all of
  /// them.
  bool from_command_line = false;
};

/// A node element of one sweep point: everything substituted, without over, at, if and unless.
struct NodeElement {
  Element element;
  std::vector<std::string> sweeps;  ///< ids in `over`
  Point point;                      ///< values of all columns of these sweeps, in the order of `sweeps`
  std::shared_ptr<const Element> resolved = {};  ///< with every parameter, once the node was read
};

/// A file that expansion read, with its content's hash (XXH3-128, hexadecimal).
struct InputFile {
  std::string path;
  std::string hash;
};

/// What expansion left out, because of a condition or as a macro that nothing calls: it has no meaning, but
/// its words are checked (check_unused).
struct UnusedPart {
  Element element;
  std::string parent;              ///< the element that it stands in; empty: the top level
  std::vector<std::string> names;  ///< that expressions in it can use
  bool names_known = false;        ///< and there can be no others
};

/// A node or a sweep that a condition left out.
struct LeftOut {
  std::string kind;  ///< of the element
  std::string id;    ///< worked out; empty where that failed
  Place place;       ///< of the element
};

/// A config after includes, arguments, macros, conditions and sweeps. The ids of nodes are unique (one
/// element may stand for many points) and fit for file names.
struct ExperimentConfig {
  std::string name;
  std::string doc;
  std::uint64_t seed = 0;
  std::string path;  ///< of the file given by the user
  Place place;       ///< of the root element
  std::vector<SweepPoints> sweeps;
  std::vector<NodeElement> nodes;  ///< in document order; the points of one element stand together
  std::vector<InputFile> files;
  std::vector<Override> overrides;               ///< those that this config took
  std::map<std::string, std::string> arguments;  ///< every declared argument with its final value
  std::vector<UnusedPart> unused;                ///< of all passes of expansion
  std::vector<LeftOut> left_out;                 ///< likewise
  /// False when a mistake may have left out nodes, sweeps or arguments: missing ones are then no mistakes of
  /// their own.
  bool complete = true;
};

struct ExpandOptions {
  std::vector<Override> overrides;
  std::optional<std::uint64_t> seed;  ///< instead of the config's own
};

/// Expands one config. Mistakes go to `diagnostics`; what they leave undecided is marked in the result
/// (`complete`, Attribute::failed, Element::failed), so that later checks can go on without repeating them.
/// Overrides that the config does not declare are no mistakes here: see check_overrides.
ExperimentConfig expand(const std::string& path, const ExpandOptions& options, Diagnostics& diagnostics);
/// The same for a text in memory; the path in `source` is where relative files are looked for.
ExperimentConfig expand(const std::shared_ptr<const SourceFile>& source, const ExpandOptions& options,
                        Diagnostics& diagnostics);
/// Expands one config alone. Throws ConfigError with every mistake found, overrides that no file declares
/// included.
ExperimentConfig expand(const std::string& path, const std::vector<Override>& overrides);

/// With several configs each takes the overrides that it declares. Reports those that none declares, with the
/// nearest name, and those given twice.
void check_overrides(const std::vector<ExperimentConfig>& experiments, const std::vector<Override>& overrides,
                     Diagnostics& diagnostics);

/// Reports unknown elements and attributes, and expressions that mean nothing, in what expansion left out.
/// Values are not worked out: they may make sense only where the part is used.
void check_unused(const ExperimentConfig& experiment, Diagnostics& diagnostics);

/// The text of the flat file, with resolved elements where nodes have them: expand() of it gives the same
/// experiment again.
std::string flat(const ExperimentConfig& experiment);

/// Names of attributes that belong to the language, not to a component: if, unless (on every element).
bool is_control_attribute(std::string_view name);

/// Declarations of the control elements: for the schema, the manual, completion, and for checking configs.
/// The same name may be declared several times, for different parents.
struct ControlElement {
  std::string name;
  std::string doc;
  /// Name and doc; required ones end in '!'; "*" stands for any further attribute.
  std::vector<std::pair<std::string, std::string>> attributes;
  std::vector<std::string> children;  ///< control elements allowed inside; "*": anything
  std::vector<std::string>
      inside;  ///< the control elements it stands in; empty: anywhere (the root: nowhere)
};
const std::vector<ControlElement>& control_elements();

}  // namespace coppice
