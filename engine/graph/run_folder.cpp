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
  if (shelf.empty()) return fmt::format("{}/{}", node.folder, file);
  std::string name = node.folder.substr(std::string_view("nodes/").size());
  std::replace(name.begin(), name.end(), '/', '.');
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
  const auto add = [&](const fs::path& object, std::string place) {
    make_folder((path_ / place).parent_path());
    link_file(object, path_ / place);
    placement.files.push_back({std::move(place), {}});
  };
  for (const StoredFile& file : result.files) add(store.object(file.hash), place_of_file(node, file.name));
  std::error_code code;
  const fs::path timing = store.timing(node.key);
  if (fs::exists(timing, code)) add(timing, node.folder + "/timing.csv");
  return placement;
}

void RunFolder::place(const PlannedNode& node, const ResultRecord& result, const StoreReader& store) {
  announce(node.folder);
  coppice::remove_all(path_ / node.folder);
  if (!node.node->published_in().empty()) {
    for (const StoredFile& file : result.files) announce(place_of_file(node, file.name));
  }
  Placement placement = linked(node, result, store);
  for (const std::string& table : node.node->labelled_tables()) {
    const fs::path file = path_ / place_of_file(node, table);
    write_table(file, labelled(read_table(file), node));
  }
  if (const std::optional<InputTable> table = node.node->input_table()) {
    const fs::path file = path_ / place_of_file(node, table->file);
    write_table(file, labelled_rows(read_table(file), node.row_labels));
  }
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
    PlacedFile placed{fs::path(file).replace_extension(extension).string(), {}};
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
