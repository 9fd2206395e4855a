#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace coppice {

// Files with messages that name them. Everything throws std::runtime_error "cannot <do> <file>: <the system's
// reason>".

/// An open file descriptor.
class OpenFile {
 public:
  OpenFile(std::filesystem::path path, int flags, unsigned mode = 0644);
  ~OpenFile();
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  /// Reads up to `size` bytes; 0 at the end.
  std::size_t read(char* buffer, std::size_t size) const;
  void write(std::string_view bytes) const;
  void sync() const;
  int descriptor() const { return descriptor_; }
  /// Takes the lock of the whole file, which ends with the process; false when another process holds it.
  bool try_lock(bool shared = false) const;

 private:
  std::filesystem::path path_;
  int descriptor_;
};

/// What stat tells about a file, for noticing changes.
struct FileStamp {
  std::uint64_t size = 0;
  std::int64_t modified_ns = 0;
  friend bool operator==(const FileStamp&, const FileStamp&) = default;
};

/// False when there is no such regular file.
bool stamp_file(const std::string& path, FileStamp& stamp);

std::string read_file(const std::filesystem::path& file);
/// Writes beside the file, then renames: readers see the old or the new content. With `durable`, also fsyncs
/// both.
void write_file(const std::filesystem::path& file, std::string_view bytes, bool durable = false);
void sync_file(const std::filesystem::path& file);
void sync_folder(const std::filesystem::path& folder);
void make_folder(const std::filesystem::path& folder);
void rename_file(const std::filesystem::path& from, const std::filesystem::path& to);
/// Hard link, or a copy where links are impossible; replaces what stands there.
void link_file(const std::filesystem::path& from, const std::filesystem::path& to);
void make_read_only(const std::filesystem::path& file);
/// Removes a file or a folder with its content; nothing happens when there is none.
void remove_all(const std::filesystem::path& path);

/// A name for a file or folder: letters, digits and "_-+." stay, other bytes and a leading point become %XX;
/// different texts get different names.
std::string safe_name(std::string_view text);
/// The name, or, where it is longer than file systems like, its start and a hash of it.
std::string short_name(std::string name);

}  // namespace coppice
