#include "engine/graph/run_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <set>
#include <stdexcept>

#include "engine/data/hash.h"
#include "engine/data/table_file.h"
#include "engine/graph/labelled.h"
#include "registry/error.h"

namespace coppice {
namespace {

namespace fs = std::filesystem;

constexpr const char* kHidden = ".coppice";
constexpr const char* kLock = ".coppice/lock";
constexpr const char* kUnrecorded = ".coppice/unrecorded";

/// Removes the temporary files (".<name>...tmp") that a killed process left in a folder, not those below it.
void remove_temporaries(const fs::path& folder) {
  std::error_code ignored;  // what cannot be removed does no harm
  for (fs::directory_iterator entry(folder, ignored), end; entry != end; entry.increment(ignored)) {
    const std::string name = entry->path().filename().string();
    if (name.starts_with('.') && name.ends_with(".tmp")) fs::remove(entry->path(), ignored);
  }
}

}  // namespace

std::string place_of_file(const PlannedNode& node, std::string_view file) {
  const std::string shelf = node.node->published_in();
  const bool of_result = !file.starts_with("timing.");
  if (shelf.empty() || !of_result) return fmt::format("{}/{}", node.folder, file);
  std::string name = node.folder.substr(std::string_view("nodes/").size());
  std::replace(name.begin(), name.end(), '/', '.');
  name = short_name(std::move(name));
  return fmt::format("{}/{}{}", shelf, name, file.substr(std::min(file.find('.'), file.size())));
}

RunFolder::RunFolder(fs::path folder) : path_(std::move(folder)) {
  if (std::optional<Placements> known = read_placements(path_ / kPlacementsFile)) {
    placements_ = std::move(*known);
    recorded_ = true;
  }
  std::error_code code;
  if (!fs::exists(path_ / kUnrecorded, code)) return;
  const std::string text = read_file(path_ / kUnrecorded);
  for (std::size_t start = 0, end; (end = text.find('\n', start)) != std::string::npos; start = end + 1) {
    unrecorded_.push_back(text.substr(start, end - start));
  }
}

const Placement* RunFolder::last(const PlannedNode& node) const {
  const auto found = placements_.find(node.folder);
  return found == placements_.end() ? nullptr : &found->second;
}

bool RunFolder::intact(const PlannedNode& node) const {
  const Placement* placement = last(node);
  return placement != nullptr && placement->key == node.key && placement->labels == labels_hash(node) &&
         files_intact(*placement);
}

bool RunFolder::files_intact(const Placement& placement) const {
  std::string path = path_.native() + "/";
  const std::size_t root = path.size();
  for (const PlacedFile& file : placement.files) {
    FileStamp stamp;
    path.resize(root);
    if (!stamp_file(path.append(file.path), stamp) || stamp != file.stamp) return false;
  }
  return true;
}

bool RunFolder::has_content(const PlannedNode& node) const {
  const Placement* placement = last(node);
  if (placement == nullptr || placement->key != node.key) return false;
  try {
    return std::all_of(placement->files.begin(), placement->files.end(), [&](const PlacedFile& file) {
      return file.hash.empty() || file_hash(path_ / file.path) == file.hash;
    });
  } catch (const std::runtime_error&) {  // unreadable
    return false;
  }
}

bool RunFolder::in_use() const {
  std::error_code code;
  if (lock_ || !fs::exists(path_ / kLock, code)) return false;
  return !OpenFile(path_ / kLock, O_RDONLY).try_lock(true);
}

void RunFolder::lock() {
  try {
    make_folder(path_ / kHidden);
    lock_ = std::make_unique<OpenFile>(path_ / kLock, O_RDWR | O_CREAT);
  } catch (const std::runtime_error& error) {
    throw ConfigError(error.what());
  }
  if (!lock_->try_lock()) {
    const std::string owner = read_file(path_ / kLock);
    throw ConfigError(fmt::format("another run{} works in {}; wait until it ends, or give another --out",
                                  owner.empty() ? "" : " (process " + owner + ")", path_.string()));
  }
  if (::ftruncate(lock_->descriptor(), 0) == 0) lock_->write(std::to_string(::getpid()));
  for (const char* part : {"", kHidden, "nodes", "tables", "figures"}) remove_temporaries(path_ / part);
  coppice::remove_all(path_ / kFailedFolder);
}

/// Notes, before it is made, what is to be removed if this process is killed and the plan changes.
void RunFolder::announce(const std::string& item) {
  const std::lock_guard<std::mutex> guard(mutex_);
  if (!announcements_) {
    announcements_ = std::make_unique<OpenFile>(path_ / kUnrecorded, O_WRONLY | O_CREAT | O_APPEND);
  }
  announcements_->write(item + "\n");
}

/// Removes a file or folder, and the folders above it that become empty.
void RunFolder::forget(const std::string& item) {
  coppice::remove_all(path_ / item);
  for (fs::path parent = fs::path(item).parent_path(); !parent.empty(); parent = parent.parent_path()) {
    if (::rmdir((path_ / parent).c_str()) != 0) break;
  }
}

bool RunFolder::has_more_than(const std::vector<std::string>& keep) const {
  const std::set<std::string_view> kept(keep.begin(), keep.end());
  return !unrecorded_.empty() ||
         std::any_of(placements_.begin(), placements_.end(),
                     [&](const auto& placement) { return !kept.contains(placement.first); });
}

void RunFolder::remove_all_but(const std::vector<std::string>& keep) {
  const std::set<std::string_view> kept(keep.begin(), keep.end());
  std::set<std::string_view> used;
  for (auto i = placements_.begin(); i != placements_.end();) {
    if (kept.contains(i->first)) {
      used.insert(i->first);
      for (const PlacedFile& file : i->second.files) used.insert(file.path);
      ++i;
      continue;
    }
    for (const PlacedFile& file : i->second.files) forget(file.path);
    std::error_code code;
    if (fs::exists(path_ / i->first, code)) forget(i->first);
    i = placements_.erase(i);
  }
  for (const std::string& item : unrecorded_) {
    if (!used.contains(item)) forget(item);
  }
  unrecorded_.clear();
}

Placement RunFolder::linked(const PlannedNode& node, const ResultRecord& result,
                            const StoreReader& store) const {
  Placement placement{node.key, labels_hash(node), {}};
  const auto add = [&](const fs::path& object, std::string place, const std::string& hash) {
    make_folder((path_ / place).parent_path());
    link_file(object, path_ / place);
    placement.files.push_back({std::move(place), {}, hash});
  };
  for (const StoredFile& file : result.files)
    add(store.object(file.hash), place_of_file(node, file.name), file.hash);
  std::error_code code;
  const fs::path timing = store.timing(node.key);
  if (fs::exists(timing, code)) add(timing, place_of_file(node, kTimingFile), "");
  return placement;
}

/// Puts names into the tables that show them.
void RunFolder::write_labels(const PlannedNode& node, Placement& placement) const {
  const auto write = [&](const std::string& table, const auto& label) {
    const fs::path place = place_of_file(node, table);
    write_table(path_ / place, label(read_table(path_ / place)));
    for (const char* extension : {".csv", ".schema.json"}) {
      const std::string written = fs::path(place).replace_extension(extension).string();
      make_read_only(path_ / written);
      const auto same = [&](const PlacedFile& file) { return file.path == written; };
      const auto placed = std::find_if(placement.files.begin(), placement.files.end(), same);
      if (placed != placement.files.end()) placed->hash = file_hash(path_ / written);
    }
  };
  for (const std::string& table : node.node->labelled_tables())
    write(table, [&](const Table& rows) { return labelled(rows, node); });
  if (const std::optional<InputTable> table = node.node->input_table())
    write(table->file, [&](const Table& rows) { return labelled_rows(rows, node.row_labels); });
}

void RunFolder::place(const PlannedNode& node, const ResultRecord& result, const StoreReader& store) {
  announce(node.folder);
  coppice::remove_all(path_ / node.folder);
  if (!node.node->published_in().empty()) {
    for (const StoredFile& file : result.files) announce(place_of_file(node, file.name));
  }
  Placement placement = linked(node, result, store);
  write_labels(node, placement);
  for (PlacedFile& file : placement.files) {
    if (!stamp_file(path_ / file.path, file.stamp)) {
      throw std::runtime_error(fmt::format("cannot read {}: it vanished", (path_ / file.path).string()));
    }
  }
  const std::lock_guard<std::mutex> guard(mutex_);
  placements_[node.folder] = std::move(placement);
}

void RunFolder::join_tables(const Plan& plan) {
  std::map<std::string, std::vector<const PlannedNode*>> by_id;
  for (const PlannedNode& node : plan.nodes) {
    if (node.node->labelled_tables().empty()) continue;
    std::vector<const PlannedNode*>& nodes = by_id[node.id];
    if (placements_.contains(node.folder)) nodes.push_back(&node);
  }
  for (const auto& [id, nodes] : by_id) join_table(id, nodes);
}

bool RunFolder::tables_joined(const Plan& plan) const {
  std::set<std::string_view> checked;
  for (const PlannedNode& node : plan.nodes) {
    if (node.node->labelled_tables().empty() || last(node) == nullptr) continue;
    if (!checked.insert(node.id).second) continue;
    const auto known = placements_.find(joined_table(node.id));
    if (known == placements_.end() || !files_intact(known->second)) return false;
  }
  return true;
}

void RunFolder::join_table(const std::string& id, const std::vector<const PlannedNode*>& nodes) {
  const std::string file = joined_table(id);
  std::string all;
  for (const PlannedNode* node : nodes) {
    const Placement& placement = placements_.find(node->folder)->second;
    all.append(placement.key).append(placement.labels);
  }
  const auto known = placements_.find(file);
  if (known != placements_.end() && known->second.key == content_hash(all) && files_intact(known->second))
    return;
  if (nodes.empty()) {
    if (known != placements_.end()) placements_.erase(known);
    forget(file);
    return;
  }
  std::vector<Table> tables;
  for (const PlannedNode* node : nodes) {
    tables.push_back(read_table(path_ / place_of_file(*node, node->node->labelled_tables().front())));
  }
  announce(file);
  write_table(path_ / file, join_rows(tables));
  Placement placement{content_hash(all), "", {}};
  for (const char* extension : {".csv", ".schema.json"}) {
    PlacedFile placed{fs::path(file).replace_extension(extension).string(), {}, {}};
    make_read_only(path_ / placed.path);
    stamp_file(path_ / placed.path, placed.stamp);
    placement.files.push_back(std::move(placed));
  }
  placements_[file] = std::move(placement);
}

void RunFolder::save() {
  write_placements(path_ / kPlacementsFile, placements_);
  announcements_.reset();
  coppice::remove_all(path_ / kUnrecorded);
  recorded_ = true;
}

}  // namespace coppice
