#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace coppice {

/// XXH3-128 as 32 hexadecimal digits.
std::string content_hash(std::string_view bytes);
/// The same of a file's content. Throws std::runtime_error with the file and the system's reason.
std::string file_hash(const std::filesystem::path& file);

}  // namespace coppice
