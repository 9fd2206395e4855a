#pragma once

#include <cstdint>
#include <map>
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
};

/// A node element of one sweep point: everything substituted, without over, at, if and unless.
struct NodeElement {
  Element element;
  std::vector<std::string> sweeps;  ///< ids in `over`
  Point point;                      ///< values of all columns of these sweeps, in the order of `sweeps`
};

/// A file that expansion read, with its content's hash (XXH3-128, hexadecimal).
struct InputFile {
  std::string path;
  std::string hash;
};

/// A config after includes, arguments, macros, conditions and sweeps.
struct ExperimentConfig {
  std::string name;
  std::string doc;
  std::uint64_t seed = 0;
  std::string path;  ///< of the file given by the user
  Place place;       ///< of the root element
  std::vector<SweepPoints> sweeps;
  std::vector<NodeElement> nodes;  ///< in document order; the points of one element stand together
  std::vector<InputFile> files;
  std::vector<Override> overrides;                ///< those that this config took
  std::map<std::string, std::string> arguments;  ///< every declared argument with its final value
};

/// Expands one config. Overrides that no file declares are errors (with the nearest declared name). Throws ConfigError
/// with every mistake found.
ExperimentConfig expand(const std::string& path, const std::vector<Override>& overrides);

/// The flat file: expand() of its text gives the same experiment again.
Element flat(const ExperimentConfig& experiment);

/// Names of attributes that belong to the language, not to a component: if, unless (on every element).
bool is_control_attribute(std::string_view name);

/// Declarations of the control elements (include, arg, let, macro, call, insert, group, sweep and its parts): for the
/// schema, the manual and completion.
struct ControlElement {
  std::string name;
  std::string doc;
  std::vector<std::pair<std::string, std::string>> attributes;  ///< name, doc; required ones end in '!'
  std::vector<std::string> children;                            ///< control elements allowed inside; "*": anything
};
const std::vector<ControlElement>& control_elements();

}  // namespace coppice
