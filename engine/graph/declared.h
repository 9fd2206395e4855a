#pragma once

#include <memory>
#include <set>
#include <string>
#include <vector>

#include "engine/config/experiment.h"
#include "engine/graph/node.h"

namespace coppice {

/// One id in a reference parameter, and where the user wrote it.
struct DeclaredTarget {
  std::size_t node = 0;  ///< index into Declarations::nodes
  Place place;
};

/// A reference parameter of an element with the nodes it names; those that do not exist are left out.
struct DeclaredReference {
  const ParameterInfo* parameter = nullptr;
  std::vector<DeclaredTarget> targets;
};

/// A node element of one sweep point, read.
struct DeclaredElement {
  const Element* written = nullptr;  ///< as expansion made it, in the experiment
  std::vector<std::string> sweeps;
  Point point;
  std::shared_ptr<const Node> node;         ///< null after a mistake in the element
  std::shared_ptr<const Element> resolved;  ///< without over and at
  std::vector<DeclaredReference> references;
  bool sound = true;  ///< false after any mistake in it or in what it reads
};

/// A node as the user declared it: an id with the elements of its sweep points.
struct DeclaredNode {
  std::string id;
  std::string kind;
  const ComponentInfo* info = nullptr;
  std::vector<DeclaredElement> elements;
};

/// The nodes of an experiment, in document order, and an order in which every node comes after those it
/// refers to.
struct Declarations {
  std::vector<DeclaredNode> nodes;
  std::vector<std::size_t> order;
  std::set<std::string, std::less<>> of_unknown_kind;  ///< ids of elements that are no node kind
  std::map<std::string, Place, std::less<>> left_out;  ///< ids of nodes whose conditions do not hold
};

/// Reads every element, finds the nodes that references name, and orders them. Mistakes go to `diagnostics`:
/// unknown kinds and ids, ids used twice, references to nodes that do not make what is needed, cycles. The
/// result points into `experiment`.
Declarations declare(const ExperimentConfig& experiment, Diagnostics& diagnostics);

/// The part of declare that follows references and orders the nodes.
void resolve_references(Declarations& declarations, Diagnostics& diagnostics);

}  // namespace coppice
