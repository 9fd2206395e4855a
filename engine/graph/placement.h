#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/data/file_system.h"

namespace coppice {

/// A file that a run put into its folder, and how it left it.
struct PlacedFile {
  std::string path;  ///< below the run folder
  FileStamp stamp;
  std::string hash;  ///< of its content; "" when it is not known, as of timing.csv
};

/// A result as it lies in the run folder.
struct Placement {
  std::string key;
  std::string labels;  ///< hash of the names shown in its tables; "" when it shows none
  std::vector<PlacedFile> files;
};

/// What the last run left in a run folder, by PlannedNode::folder.
using Placements = std::map<std::string, Placement, std::less<>>;

/// Where they are recorded, below the run folder.
inline constexpr std::string_view kPlacementsFile = ".coppice/placements";

/// Nothing when the file is not there, damaged or of another format: the folder then counts as unknown.
std::optional<Placements> read_placements(const std::filesystem::path& file);
void write_placements(const std::filesystem::path& file, const Placements& placements);

}  // namespace coppice
