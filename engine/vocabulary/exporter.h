#pragma once

#include <string>

#include "engine/vocabulary/policy_model.h"
#include "engine/vocabulary/space.h"
#include "registry/component.h"

namespace coppice {

/// A policy on its way out of the program.
struct ExportedPolicy {
  std::string name;        ///< an identifier in snake_case
  std::string component;   ///< of the policy ("fitted_policy")
  std::string writer;      ///< name and version of the program that made it
  std::string provenance;  ///< key of the node that made it; may be empty
  Spaces spaces;
  PolicyModel model;

  const ActionBox& action() const { return spaces.actions[static_cast<std::size_t>(model.action)]; }
};

/// A format that policies are exported in. Its component's version is raised whenever its output changes.
class Exporter {
 public:
  static constexpr const char* kInterface = "exporter";
  virtual ~Exporter() = default;

  virtual std::string extension() const = 0;  ///< of its files, without the point
  /// True when its output is no text.
  virtual bool binary() const { return false; }
  /// Throws std::invalid_argument when the format cannot name a policy so.
  virtual void check_name(const std::string& /*name*/) const {}
  /// The file's content; equal policies give equal bytes. Throws std::invalid_argument saying what of the
  /// policy the format cannot express.
  virtual std::string write(const ExportedPolicy& policy) const = 0;
};

}  // namespace coppice
