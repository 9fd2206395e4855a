#include "engine/data/file_system.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <system_error>

#include "engine/data/hash.h"

namespace coppice {
namespace {

[[noreturn]] void fail(std::string_view action, const std::filesystem::path& file, int code) {
  throw std::runtime_error(fmt::format("cannot {} {}: {}", action, file.string(), std::strerror(code)));
}

void check(const std::error_code& code, std::string_view action, const std::filesystem::path& file) {
  if (code) fail(action, file, code.value());
}

/// A name that no other thread or process uses, beside `file`.
std::filesystem::path temporary_beside(const std::filesystem::path& file) {
  static std::atomic<unsigned> count{0};
  return file.parent_path() / fmt::format(".{}.{}.{}.tmp", file.filename().string(), ::getpid(), count++);
}

}  // namespace

OpenFile::OpenFile(std::filesystem::path path, int flags, unsigned mode)
    : path_(std::move(path)), descriptor_(::open(path_.c_str(), flags | O_CLOEXEC, mode)) {
  if (descriptor_ < 0) fail((flags & O_ACCMODE) == O_RDONLY ? "read" : "write", path_, errno);
}

OpenFile::~OpenFile() {
  ::close(descriptor_);
}

std::size_t OpenFile::read(char* buffer, std::size_t size) const {
  for (;;) {
    const ssize_t count = ::read(descriptor_, buffer, size);
    if (count >= 0) return static_cast<std::size_t>(count);
    if (errno != EINTR) fail("read", path_, errno);
  }
}

void OpenFile::write(std::string_view bytes) const {
  while (!bytes.empty()) {
    const ssize_t count = ::write(descriptor_, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail("write", path_, errno);
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
}

void OpenFile::sync() const {
  // Some file systems know no fsync (EINVAL): they are as safe as they can be.
  if (::fsync(descriptor_) != 0 && errno != EINVAL) fail("write", path_, errno);
}

bool OpenFile::try_lock(bool shared) const {
  for (;;) {
    if (::flock(descriptor_, (shared ? LOCK_SH : LOCK_EX) | LOCK_NB) == 0) return true;
    if (errno == EWOULDBLOCK) return false;
    if (errno != EINTR) fail("lock", path_, errno);
  }
}

bool stamp_file(const std::string& path, FileStamp& stamp) {
  struct stat info {};
  if (::stat(path.c_str(), &info) != 0 || !S_ISREG(info.st_mode)) return false;
  stamp.size = static_cast<std::uint64_t>(info.st_size);
  stamp.modified_ns = std::int64_t{info.st_mtim.tv_sec} * 1'000'000'000 + info.st_mtim.tv_nsec;
  return true;
}

std::string read_file(const std::filesystem::path& file) {
  const OpenFile input(file, O_RDONLY);
  std::string bytes;
  std::size_t used = 0;
  for (;;) {
    bytes.resize(used + std::max<std::size_t>(4096, used));
    const std::size_t count = input.read(bytes.data() + used, bytes.size() - used);
    used += count;
    if (count == 0) break;
  }
  bytes.resize(used);
  return bytes;
}

void write_file(const std::filesystem::path& file, std::string_view bytes, bool durable) {
  const std::filesystem::path temporary = temporary_beside(file);
  try {
    const OpenFile output(temporary, O_WRONLY | O_CREAT | O_TRUNC);
    output.write(bytes);
    if (durable) output.sync();
    rename_file(temporary, file);
  } catch (...) {
    ::unlink(temporary.c_str());
    throw;
  }
  if (durable) sync_folder(file.parent_path());
}

void sync_file(const std::filesystem::path& file) {
  OpenFile(file, O_RDONLY).sync();
}

void sync_folder(const std::filesystem::path& folder) {
  OpenFile(folder.empty() ? "." : folder, O_RDONLY | O_DIRECTORY).sync();
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code code;
  std::filesystem::create_directories(folder, code);
  check(code, "make the folder", folder);
}

void rename_file(const std::filesystem::path& from, const std::filesystem::path& to) {
  std::error_code code;
  std::filesystem::rename(from, to, code);
  check(code, "write", to);
}

void link_file(const std::filesystem::path& from, const std::filesystem::path& to) {
  const std::filesystem::path temporary = temporary_beside(to);
  std::error_code code;
  std::filesystem::create_hard_link(from, temporary, code);
  if (code) {
    code.clear();
    std::filesystem::copy_file(from, temporary, std::filesystem::copy_options::overwrite_existing, code);
    if (code) ::unlink(temporary.c_str());
    check(code, "write", to);
  }
  // Renaming one link of a file over another of the same file does nothing and leaves both.
  if (std::rename(temporary.c_str(), to.c_str()) != 0) fail("write", to, errno);
  ::unlink(temporary.c_str());
}

void make_read_only(const std::filesystem::path& file) {
  if (::chmod(file.c_str(), 0444) != 0) fail("write", file, errno);
}

void remove_all(const std::filesystem::path& path) {
  std::error_code code;
  std::filesystem::remove_all(path, code);
  check(code, "remove", path);
}

std::string safe_name(std::string_view text) {
  std::string name;
  for (const char c : text) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       std::string_view("_-+.").find(c) != std::string_view::npos;
    const bool hidden = c == '.' && name.empty();
    if (plain && !hidden) {
      name += c;
    } else {
      name += fmt::format("%{:02X}", static_cast<unsigned char>(c));
    }
  }
  return name;
}

std::string short_name(std::string name) {
  constexpr std::size_t kLongest = 160;
  if (name.size() <= kLongest) return name;
  return name.substr(0, kLongest - 33) + "~" + content_hash(name);
}

}  // namespace coppice
