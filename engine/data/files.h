#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace coppice {

/// Writes a file. Throws std::runtime_error with the file and the system's reason when that fails.
void write_file(const std::filesystem::path& file, std::string_view bytes);

/// Writes a file that is either whole or not there (or as it was), whenever the process or the machine stops:
/// a temporary name, fsync, rename, fsync of the folder. Throws as write_file; the temporary file is then
/// gone.
void write_file_atomically(const std::filesystem::path& file, std::string_view bytes);

/// The bytes of a file. Throws ConfigError with the file and the system's reason when it cannot be read.
std::string read_file(const std::filesystem::path& file);

}  // namespace coppice
