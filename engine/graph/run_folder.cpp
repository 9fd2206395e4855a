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
constexpr const char* kTiming = "timing.csv";

/// Where a file of a result goes: into the node's folder, or, when it is published, under the node's name
/// among the others of its kind ("tables/<id>.csv").
std::string place_of_file(const PlannedNode& node, const std::string& file) {
  const std::string shelf = node.node->published_in();
  if (shelf.empty()) return node.folder + "/" + file;
  std::string name = node.folder.substr(std::string_view("nodes/").size());
  std::replace(name.begin(), name.end(), '/', '.');
  return shelf + "/" + name + file.substr(std::min(file.find('.'), file.size()));
}

std::string joined_table(const std::string& id) {
  return "nodes/" + id + ".csv";
}

}  // namespace

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
  if (placement == nullptr || placement->key != node.key || placement->labels != labels_hash(node))
    return false;
  std::string path = path_.native() + "/";
  const std::size_t root = path.size();
  for (const PlacedFile& file : placement->files) {
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

bool RunFolder::remove_all_but(const std::vector<std::string>& keep) {
  const std::set<std::string_view> kept(keep.begin(), keep.end());
  bool removed = false;
  for (auto i = placements_.begin(); i != placements_.end();) {
    if (kept.contains(i->first)) {
      ++i;
      continue;
    }
    for (const PlacedFile& file : i->second.files) forget(file.path);
    if (fs::exists(path_ / i->first)) forget(i->first);
    i = placements_.erase(i);
    removed = true;
  }
  std::set<std::string_view> used;
  for (const auto& [place, placement] : placements_) {
    used.insert(place);
    for (const PlacedFile& file : placement.files) used.insert(file.path);
  }
  for (const std::string& item : unrecorded_) {
    if (!used.contains(item)) forget(item);
    removed = true;
  }
  unrecorded_.clear();
  return removed;
}

Placement RunFolder::linked(const PlannedNode& node, const ResultRecord& result,
                            const StoreReader& store) const {
  Placement placement{node.key, labels_hash(node), {}};
  const auto add = [&](const fs::path& object, const std::string& name) {
    PlacedFile file{place_of_file(node, name), {}};
    link_file(object, path_ / file.path);
    placement.files.push_back(std::move(file));
  };
  for (const StoredFile& file : result.files) {
    make_folder((path_ / place_of_file(node, file.name)).parent_path());
    add(store.object(file.hash), file.name);
  }
  std::error_code code;
  const fs::path timing = store.timing(node.key);
  if (node.node->published_in().empty() && fs::exists(timing, code)) {
    make_folder(path_ / node.folder);
    add(timing, kTiming);
  }
  return placement;
}

void RunFolder::place(const PlannedNode& node, const ResultRecord& result, const StoreReader& store) {
  if (node.node->published_in().empty()) {
    announce(node.folder);
    coppice::remove_all(path_ / node.folder);
  } else {
    for (const StoredFile& file : result.files) announce(place_of_file(node, file.name));
  }
  Placement placement = linked(node, result, store);
  for (const std::string& table : node.node->labelled_tables()) {
    const fs::path file = path_ / place_of_file(node, table);
    write_table(file, labelled(read_table(file), node));
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

void RunFolder::join_table(const std::string& id, const std::vector<const PlannedNode*>& nodes) {
  const std::string file = joined_table(id);
  std::string all;
  for (const PlannedNode* node : nodes) {
    const Placement& placement = placements_.find(node->folder)->second;
    all.append(placement.key).append(placement.labels);
  }
  const auto known = placements_.find(file);
  FileStamp stamp;
  if (known != placements_.end() && known->second.key == content_hash(all) &&
      stamp_file(path_ / file, stamp) && stamp == known->second.files.front().stamp) {
    return;
  }
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
