#pragma once

#include <memory>
#include <string>

#include "engine/graph/artifacts.h"
#include "engine/vocabulary/exporter.h"

namespace coppice {

/// The exporter of a format ("cpp"). Throws std::invalid_argument that names those that there are.
std::shared_ptr<const Exporter> make_exporter(const std::string& format);

/// Throws std::invalid_argument unless `name` is an identifier in snake_case: it becomes a namespace, and the
/// name of a file.
void check_export_name(const std::string& name);

/// A policy as exporters take it: prepared for `spaces`, and with the writer and the provenance of its file.
/// Throws std::invalid_argument for one that cannot be exported.
ExportedPolicy exported_policy(std::string name, const MadePolicy& policy, const PolicyFile& file,
                               const Spaces& spaces);

}  // namespace coppice
