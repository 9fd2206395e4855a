#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/config/experiment.h"
#include "engine/graph/node.h"

namespace coppice {

/// The planned nodes that one reference parameter leads to, as indices into Plan::nodes.
struct PlannedInput {
  std::string parameter;
  std::string artifact;
  bool fans_out = false;  ///< the reader is one of several, one for each node that the user named
  std::vector<std::size_t> nodes;
};

/// How tables name a node.
struct NodeLabels {
  std::vector<PointValue> columns;  ///< sweep columns, problem, policy
  std::size_t sweep_columns = 0;    ///< how many of them are sweep columns; they stand first
  std::optional<int> replicate;
  std::map<std::string, std::string> units;  ///< SI units of those that are quantities
};

/// One node to compute, or a definition: a node element at one sweep point, for one item of its fan-out and
/// one replicate.
struct PlannedNode {
  std::string id;
  std::string kind;
  std::vector<std::string> sweeps;
  Point point;       ///< values of all columns of `sweeps`
  std::string item;  ///< id of the node it fans out to ("rfpi" of an evaluation's policies); else empty
  std::optional<int> replicate;  ///< from 0
  int replicates = 0;            ///< how many there are at this point; 0 when it has none
  std::string name;              ///< unique, for people: "scores variant=HA rfpi r003"
  std::string folder;            ///< unique, below the run folder: "nodes/scores/variant=HA/rfpi/r003"
  std::string key;               ///< 32 hexadecimal digits; see key.h
  std::string component;         ///< kind and main components, for predictions: "train fpf double_integrator"
  bool definition = false;
  Place place;

  std::shared_ptr<const Node> node;
  std::shared_ptr<const Element> resolved;  ///< every parameter with its value
  std::vector<PlannedInput> inputs;         ///< in the order of the parameters
  std::vector<PointValue> labels;  ///< columns that name it in tables: sweep columns, problem, policy
  std::map<std::string, std::string> units;  ///< SI units of the labels that are quantities
  std::vector<NodeLabels> row_labels;        ///< of the rows of Node::input_table
  std::vector<std::string> streams;  ///< streams of draws it depends on, its own first (unless a definition)
  std::optional<std::size_t> training;  ///< node that learned the policy it is about; none: not learned
  std::string parameters_text;          ///< part of the key text that comes from `resolved`; see key.h
  std::string family;                   ///< hash of that part: equal for all replicates
  std::vector<std::string> columns;     ///< of the dataset it makes, where known; of the first replicate only
  std::vector<std::string> progress_columns;  ///< of its progress, likewise
  std::shared_ptr<const Spaces> spaces;       ///< of what it makes, likewise
};

/// What a config asks for, before looking at any result. Everything that plan, why and run say comes from
/// here.
struct Plan {
  ExperimentConfig experiment;     ///< its nodes with resolved elements
  std::vector<PlannedNode> nodes;  ///< every node after its inputs, else in document order
  std::vector<InputFile> files;    ///< read by the config and named in parameters

  /// What the key of a node is the hash of: lines "name = value".
  std::string key_text(std::size_t node) const;
  /// Indices of the nodes with this id, or with this name; empty when there is none.
  std::vector<std::size_t> find(std::string_view id_or_name) const;
  std::vector<std::string> ids() const;  ///< in document order
};

/// Makes the nodes, resolves references, joins sweeps and replicates, checks every node, and computes the
/// keys. Throws ConfigError with every mistake.
Plan make_plan(ExperimentConfig experiment);

/// The same for several configs, with the mistakes of all; two experiments of one name are a mistake too.
std::vector<Plan> make_plans(std::vector<ExperimentConfig> experiments);

}  // namespace coppice
