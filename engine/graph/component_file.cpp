#include "engine/graph/component_file.h"

#include <xxhash.h>

#include <memory>
#include <stdexcept>

#include "engine/data/file_system.h"
#include "engine/graph/build_info.h"

namespace coppice {
namespace {

constexpr std::uint32_t kFormatVersion = 1;

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& message) {
  const auto source = std::make_shared<SourceFile>(SourceFile{file.string(), {}});
  throw ConfigError({Diagnostic{{source, 0, 0, 1, nullptr}, message, {}, {}}});
}

/// The content, after all checks that need no understanding of it.
ByteReader checked_content(const std::filesystem::path& file, const FileKind& kind, std::string_view all) {
  ByteReader bytes(all.substr(kind.magic.size()));
  const auto version = bytes.number<std::uint32_t>("the format version");
  if (version > kFormatVersion) {
    fail(file, fmt::format(
                   "the {} file has format version {}, which a newer program wrote; this one reads up to {}",
                   kind.name, version, kFormatVersion));
  }
  if (version == 0) fail(file, fmt::format("the {} file is damaged: its format version is 0", kind.name));
  const auto checksum = bytes.number<std::uint64_t>("the checksum");
  const std::string_view checked = all.substr(all.size() - bytes.left());
  const auto size = bytes.number<std::uint64_t>("the size");
  if (size > bytes.left()) {
    fail(file, fmt::format("the {} file is truncated: {} bytes are missing", kind.name, size - bytes.left()));
  }
  if (XXH3_64bits(checked.data(), checked.size()) != checksum) {
    fail(file, fmt::format("the {} file is damaged: its checksum does not fit its content", kind.name));
  }
  return bytes;
}

}  // namespace

void write_component_file(const std::filesystem::path& file, const FileKind& kind, std::string_view content) {
  std::string checked;  // what the checksum is of
  append_number<std::uint64_t>(checked, content.size());
  checked += content;
  std::string bytes(kind.magic);
  append_number(bytes, kFormatVersion);
  append_number<std::uint64_t>(bytes, XXH3_64bits(checked.data(), checked.size()));
  bytes += checked;
  write_file(file, bytes, true);
}

void parse_component_file(std::string_view bytes, const std::filesystem::path& file, const FileKind& kind,
                          const std::function<void(ByteReader&)>& read) {
  if (!bytes.starts_with(kind.magic)) fail(file, fmt::format("this is not a {} file", kind.name));
  try {
    ByteReader content = checked_content(file, kind, bytes);
    read(content);
    if (content.left() > 0) throw std::runtime_error(fmt::format("{} bytes are left over", content.left()));
  } catch (const ConfigError&) {
    throw;
  } catch (const std::exception& wrong) {
    fail(file, fmt::format("the {} file is truncated or damaged: {}", kind.name, wrong.what()));
  }
}

std::string component_file_bytes(const std::filesystem::path& file) {
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(file, ignored);
  if (std::filesystem::is_directory(status)) fail(file, "this is a folder, not a file");
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    fail(file, "this is a pipe or a device, not a file");  // it may never end
  try {
    return read_file(file);
  } catch (const std::runtime_error& unreadable) {
    throw ConfigError(unreadable.what());
  }
}

std::string writer_text() {
  return std::string("coppice ").append(build_info().version);
}

void append_component(std::string& out, const Element& component, const Archive& arrays) {
  append_text(out, to_xml(component));
  const std::string bytes = arrays.bytes();
  append_number<std::uint64_t>(out, bytes.size());
  out += bytes;
}

void read_component(ByteReader& bytes, const std::filesystem::path& file, Element& component,
                    Archive& arrays) {
  SourceFile xml{file.string() + " (component)", bytes.text("the component")};
  component = parse_xml(std::make_shared<const SourceFile>(std::move(xml)));
  arrays = Archive::from_bytes(bytes.take(bytes.number<std::uint64_t>("the arrays"), "the arrays"));
}

}  // namespace coppice
