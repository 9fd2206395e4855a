#include "engine/data/files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

#include "registry/error.h"

namespace coppice {
namespace {

std::string reason(int code) {
  return std::generic_category().message(code);
}

[[noreturn]] void fail_to_write(const std::filesystem::path& file, int code) {
  throw std::runtime_error(fmt::format("cannot write '{}': {}", file.string(), reason(code)));
}

/// An open file; closes itself.
class Descriptor {
 public:
  Descriptor(const std::filesystem::path& file, int flags)
      : number_(::open(file.c_str(), flags | O_CLOEXEC, 0644)) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  bool is_open() const { return number_ >= 0; }
  bool write(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t written = ::write(number_, bytes.data(), bytes.size());
      if (written < 0 && errno != EINTR) return false;
      if (written > 0) bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    return true;
  }
  bool sync() { return ::fsync(number_) == 0; }
  bool close() {
    const int number = std::exchange(number_, -1);
    return number < 0 || ::close(number) == 0;
  }
  ssize_t read(char* into, std::size_t size) { return ::read(number_, into, size); }

 private:
  int number_;
};

void write(const std::filesystem::path& file, std::string_view bytes, bool sync) {
  Descriptor out(file, O_WRONLY | O_CREAT | O_TRUNC);
  if (!out.is_open() || !out.write(bytes) || (sync && !out.sync()) || !out.close())
    fail_to_write(file, errno);
}

}  // namespace

void write_file(const std::filesystem::path& file, std::string_view bytes) {
  write(file, bytes, false);
}

void write_file_atomically(const std::filesystem::path& file, std::string_view bytes) {
  std::filesystem::path temporary = file;
  temporary += fmt::format(".{}.tmp", ::getpid());
  try {
    write(temporary, bytes, true);
    if (::rename(temporary.c_str(), file.c_str()) != 0) fail_to_write(file, errno);
  } catch (...) {
    ::unlink(temporary.c_str());
    throw;
  }
  const std::filesystem::path folder =
      file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
  if (Descriptor entries(folder, O_RDONLY | O_DIRECTORY); entries.is_open()) entries.sync();
}

std::string read_file(const std::filesystem::path& file) {
  const auto fail = [&file](int code) {
    throw ConfigError(fmt::format("cannot read '{}': {}", file.string(), reason(code)));
  };
  Descriptor in(file, O_RDONLY);
  if (!in.is_open()) fail(errno);
  std::string bytes;
  std::array<char, 1 << 16> buffer;
  for (;;) {
    const ssize_t count = in.read(buffer.data(), buffer.size());
    if (count == 0) return bytes;
    if (count < 0 && errno != EINTR) fail(errno);
    if (count > 0) bytes.append(buffer.data(), static_cast<std::size_t>(count));
  }
}

}  // namespace coppice
