#include "engine/graph/store.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <stdexcept>

#include "engine/data/hash.h"
#include "engine/graph/record.h"
#include "registry/error.h"

namespace coppice {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kBurst_ns = 2'000'000'000;

[[noreturn]] void fail(std::string_view action, const fs::path& path, std::string_view reason) {
  throw std::runtime_error(fmt::format("cannot {} {}: {}", action, path.string(), reason));
}

/// Waits for the lock of an open file.
void lock(const OpenFile& file, const fs::path& path, int operation) {
  while (::flock(file.descriptor(), operation) != 0) {
    if (errno != EINTR) fail("lock", path, std::strerror(errno));
  }
}

/// Everything written below the folder, by whomever, reaches the disk.
void sync_file_system(const OpenFile& inside, const fs::path& folder) {
  if (::syncfs(inside.descriptor()) != 0) fail("write", folder, std::strerror(errno));
}

std::int64_t steady_ns() {
  return std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}

/// Removes the folders in tmp whose owner is dead: their locks are free.
void remove_leftovers(const fs::path& tmp) {
  std::error_code ignored;  // what cannot be removed does no harm; or its owner has just removed it
  for (fs::directory_iterator entry(tmp, ignored), end; entry != end; entry.increment(ignored)) {
    if (!entry->is_directory(ignored)) continue;
    try {
      const OpenFile claim(entry->path(), O_RDONLY | O_DIRECTORY);
      if (claim.try_lock()) fs::remove_all(entry->path(), ignored);
    } catch (const std::runtime_error&) {
      continue;
    }
  }
}

/// The files below a folder, relative to it, sorted.
std::vector<std::string> files_below(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code code;
  for (fs::recursive_directory_iterator i(folder, code), end; !code && i != end; i.increment(code)) {
    const fs::file_type type = i->symlink_status(code).type();
    if (type == fs::file_type::directory) continue;
    if (type != fs::file_type::regular) fail("store", i->path(), "it is not a regular file");
    names.push_back(i->path().lexically_relative(folder).string());
  }
  if (code) fail("read", folder, code.message());
  std::sort(names.begin(), names.end());
  return names;
}

FileStamp stamp_of(const fs::path& file) {
  FileStamp stamp;
  if (!stamp_file(file.native(), stamp)) fail("read", file, "it has vanished");
  return stamp;
}

/// False on a file system without hard links. What another process put there meanwhile stays.
bool link_unless_there(const fs::path& file, const fs::path& place) {
  return ::link(file.c_str(), place.c_str()) == 0 || errno == EEXIST;
}

}  // namespace

Store::Store(fs::path path) : StoreReader(std::move(path)) {
  try {
    for (const char* part : {"results", "objects", "timing", "checkpoints", "tmp"})
      make_folder(folder() / part);
    const fs::path in_use = folder() / "lock";
    in_use_ = std::make_unique<OpenFile>(in_use, O_RDWR | O_CREAT);
    lock(*in_use_, in_use, LOCK_SH);
    claim_temporary_folder();
    remove_outlived_checkpoints();
  } catch (const std::runtime_error& error) {
    throw ConfigError(error.what());
  }
}

Store::~Store() {
  if (unsynced_) ::syncfs(in_use_->descriptor());
  std::error_code ignored;  // the next Store removes what is left
  fs::remove_all(temporary_, ignored);
}

void Store::claim_temporary_folder() {
  const fs::path tmp = folder() / "tmp";
  const OpenFile turn(tmp / "lock", O_RDWR | O_CREAT);  // nobody removes a folder made but not yet locked
  lock(turn, tmp / "lock", LOCK_EX);
  remove_leftovers(tmp);
  // The process number may be taken: by another Store, or by a process of another machine.
  for (unsigned i = 0;; ++i) {
    temporary_ = tmp / fmt::format("{}.{}", ::getpid(), i);
    if (::mkdir(temporary_.c_str(), 0777) == 0) break;
    if (errno != EEXIST) fail("make the folder", temporary_, std::strerror(errno));
  }
  claim_ = std::make_unique<OpenFile>(temporary_, O_RDONLY | O_DIRECTORY);
  lock(*claim_, temporary_, LOCK_EX);
}

/// A process may have been killed between acknowledging a result and removing its checkpoint. One that is
/// newer than the record is of a node that was being computed again.
void Store::remove_outlived_checkpoints() const {
  std::error_code ignored;  // what cannot be removed does no harm
  for (fs::directory_iterator entry(folder() / "checkpoints", ignored), end; entry != end;
       entry.increment(ignored)) {
    const std::string key = entry->path().filename().string();
    FileStamp saved, acknowledged;
    if (stamp_file(entry->path().native(), saved) && stamp_file(record(key).native(), acknowledged) &&
        saved.modified_ns <= acknowledged.modified_ns && find(key))
      fs::remove(entry->path(), ignored);
  }
}

fs::path Store::temporary(const std::string& name) {
  return temporary_ / fmt::format("{}.{}", name, count_++);
}

fs::path Store::begin(const std::string& key) {
  const fs::path made = temporary(key);
  make_folder(made);
  return made;
}

void Store::abandon(const fs::path& made) {
  coppice::remove_all(made);
}

StoredFile Store::keep(const fs::path& file, const std::string& name) {
  StoredFile kept{.name = name, .size = stamp_of(file).size, .hash = file_hash(file)};
  const fs::path place = object(kept.hash);
  make_folder(place.parent_path());
  make_read_only(file);
  FileStamp there;
  const bool damaged = stamp_file(place.native(), there) && file_hash(place) != kept.hash;
  if (damaged || !link_unless_there(file, place)) rename_file(file, place);
  kept.modified_ns = stamp_of(place).modified_ns;
  return kept;
}

/// True for the caller that has to bring everything to the disk now.
bool Store::sync_is_due() {
  std::int64_t last = synced_ns_;
  const std::int64_t now = steady_ns();
  if (last != 0 && now - last < kBurst_ns) return false;
  return synced_ns_.compare_exchange_strong(last, now);
}

void Store::acknowledge(const ResultRecord& result, bool durably) {
  const fs::path written = temporary("record");
  {
    const OpenFile output(written, O_WRONLY | O_CREAT | O_EXCL);
    output.write(record_text(result));
    if (durably) output.sync();
  }
  const fs::path place = record(result.key);
  make_folder(place.parent_path());
  rename_file(written, place);
  if (durably) sync_folder(place.parent_path());
}

ResultRecord Store::commit(const fs::path& made, ResultRecord result) {
  result.files.clear();
  for (const std::string& name : files_below(made)) {
    if (name != kTimingFile) {
      result.files.push_back(keep(made / name, name));
    } else {
      make_folder(timing(result.key).parent_path());
      make_read_only(made / name);
      rename_file(made / name, timing(result.key));
    }
  }
  const bool durably = sync_is_due();
  if (durably) {
    unsynced_ = false;
    sync_file_system(*in_use_, folder());
  }
  acknowledge(result, durably);
  if (!durably) unsynced_ = true;
  coppice::remove_all(checkpoint(result.key));
  coppice::remove_all(made);
  return result;
}

void Store::save_checkpoint(const std::string& key, std::string_view bytes) {
  const fs::path written = temporary("checkpoint");  // not beside it, where nobody would remove it
  write_file(written, bytes);
  rename_file(written, checkpoint(key));
}

void Store::remove(const std::string& key) {
  coppice::remove_all(record(key));
  coppice::remove_all(timing(key));
}

}  // namespace coppice
