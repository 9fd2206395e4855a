#include <algorithm>
#include <stdexcept>

#include "engine/data/hash.h"
#include "engine/graph/record.h"
#include "engine/graph/store.h"

namespace coppice {
namespace {

/// folder/kind/ab/name: few files in each folder.
std::filesystem::path spread(const std::filesystem::path& folder, std::string_view kind,
                             const std::string& name, std::string_view extension = {}) {
  std::string path;
  path.reserve(folder.native().size() + kind.size() + name.size() + extension.size() + 5);
  path.append(folder.native()).append("/").append(kind).append("/").append(name, 0, 2);
  return path.append("/").append(name).append(extension);
}

bool has_content(const std::filesystem::path& object, const StoredFile& file) {
  try {
    return file_hash(object) == file.hash;
  } catch (const std::runtime_error&) {  // unreadable
    return false;
  }
}

/// True when the object is there, has its size, and has its content: not written since, or reading it shows.
bool is_whole(const std::filesystem::path& object, const StoredFile& file) {
  FileStamp stamp;
  if (!stamp_file(object.native(), stamp) || stamp.size != file.size) return false;
  return stamp.modified_ns == file.modified_ns || has_content(object, file);
}

}  // namespace

std::filesystem::path StoreReader::record(const std::string& key) const {
  return spread(folder_, "results", key, ".json");
}

std::filesystem::path StoreReader::object(const std::string& hash) const {
  return spread(folder_, "objects", hash);
}

std::filesystem::path StoreReader::timing(const std::string& key) const {
  return spread(folder_, "timing", key, ".csv");
}

std::filesystem::path StoreReader::checkpoint(const std::string& key) const {
  return folder_ / "checkpoints" / key;
}

std::vector<std::string> StoreReader::keys() const {
  namespace fs = std::filesystem;
  std::vector<std::string> found;
  std::error_code ignored;  // what cannot be read is not there
  for (fs::recursive_directory_iterator i(folder_ / "results", ignored), end; i != end;
       i.increment(ignored)) {
    if (i->path().extension() == ".json") found.push_back(i->path().stem().string());
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::optional<ResultRecord> StoreReader::read(const std::string& key) const {
  const std::filesystem::path file = record(key);
  FileStamp stamp;
  if (!stamp_file(file.native(), stamp)) return std::nullopt;
  try {
    std::optional<ResultRecord> found = parse_record(read_file(file));
    if (!found || found->key != key) return std::nullopt;
    return found;
  } catch (const std::runtime_error&) {  // what cannot be read is not there; writing it anew tells why
    return std::nullopt;
  }
}

std::optional<ResultRecord> StoreReader::find(const std::string& key) const {
  std::optional<ResultRecord> found = read(key);
  if (!found) return found;
  for (const StoredFile& part : found->files) {
    if (!is_whole(object(part.hash), part)) return std::nullopt;
  }
  return found;
}

std::optional<ResultRecord> StoreReader::find_verified(const std::string& key) const {
  std::optional<ResultRecord> found = read(key);
  if (!found) return found;
  for (const StoredFile& part : found->files) {
    if (!has_content(object(part.hash), part)) return std::nullopt;
  }
  return found;
}

}  // namespace coppice
