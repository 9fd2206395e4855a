#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "engine/graph/placement.h"
#include "engine/graph/plan.h"
#include "engine/graph/store.h"

namespace coppice {

/// Folder of a run for what failed nodes wrote until they failed, in the last run.
inline constexpr std::string_view kFailedFolder = "failed";

/// Where a file of a result goes in the run folder: into the node's folder, or, when it is published, under
/// the node's name among the others of its kind ("tables/<id>.csv", "tables/<id>.<column>=<value>.csv").
std::string place_of_file(const PlannedNode& node, std::string_view file);

/// The folder of one experiment's run: results linked from the store under the names of the config, and a
/// hidden folder
/// `.coppice` with the lock and the record of what lies where. May be read by any number of processes; one at
/// a time writes.
class RunFolder {
 public:
  /// Reads the record of the last run. Changes nothing.
  explicit RunFolder(std::filesystem::path folder);

  /// True when the node's result lies here as a run left it.
  bool intact(const PlannedNode& node) const;
  /// True when its files also have the content that the run left; reads them. Times are not looked at.
  bool has_content(const PlannedNode& node) const;
  /// What the last run left for a node; null when it is unknown.
  const Placement* last(const PlannedNode& node) const;
  bool has_record() const { return recorded_; }
  /// True while another process holds the lock.
  bool in_use() const;

  /// Makes the folder and takes it for this process. Throws ConfigError when another process has it, or when
  /// it cannot be written.
  void lock();
  /// True when something lies here that a run made and that is not in `keep` (places of nodes and joined
  /// tables).
  bool has_more_than(const std::vector<std::string>& keep) const;
  /// Removes that.
  void remove_all_but(const std::vector<std::string>& keep);
  /// The place of the table with all rows of a node.
  static std::string joined_table(const std::string& id) { return "nodes/" + id + ".csv"; }
  /// Puts a result into its place, with labels where the node wants them. May be called by several threads.
  void place(const PlannedNode& node, const ResultRecord& result, const StoreReader& store);
  /// Writes nodes/<id>.csv for every node with labelled tables: the rows of all its points, items and
  /// replicates.
  void join_tables(const Plan& plan);
  /// True when these tables are there as join_tables left them.
  bool tables_joined(const Plan& plan) const;
  /// Records what lies here. Throws std::runtime_error.
  void save();

  const std::filesystem::path& path() const { return path_; }

 private:
  void announce(const std::string& item);
  void forget(const std::string& item);
  bool files_intact(const Placement& placement) const;
  void write_labels(const PlannedNode& node, Placement& placement) const;
  Placement linked(const PlannedNode& node, const ResultRecord& result, const StoreReader& store) const;
  void join_table(const std::string& id, const std::vector<const PlannedNode*>& nodes);

  std::filesystem::path path_;
  Placements placements_;
  std::vector<std::string> unrecorded_;  ///< what a killed run may have put here
  bool recorded_ = false;
  std::unique_ptr<OpenFile> lock_;
  std::unique_ptr<OpenFile> announcements_;
  std::mutex mutex_;  ///< of placements_ and announcements_ while nodes run
};

}  // namespace coppice
