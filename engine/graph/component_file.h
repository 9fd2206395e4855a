#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "engine/vocabulary/archive.h"
#include "engine/vocabulary/bytes.h"
#include "registry/component.h"

namespace coppice {

// The frame that policy and function files share (docs/policy-files.md): magic number, format version,
// checksum, size, content; and the parts that both contents have.

struct FileKind {
  std::string_view name;   ///< "policy", in messages
  std::string_view magic;  ///< 8 bytes
};

/// Writes the file durably; it is whole or not there. Throws std::runtime_error.
void write_component_file(const std::filesystem::path& file, const FileKind& kind, std::string_view content);

/// Checks the frame of a file's bytes and lets `read` take the whole content, turning its std::exceptions
/// into ConfigErrors. Throws ConfigError naming the file and what is wrong with it.
void parse_component_file(std::string_view bytes, const std::filesystem::path& file, const FileKind& kind,
                          const std::function<void(ByteReader&)>& read);

/// The bytes of a file; throws ConfigError where it cannot be read.
std::string component_file_bytes(const std::filesystem::path& file);

/// The program's name and version.
std::string writer_text();

void append_component(std::string& out, const Element& component, const Archive& arrays);
/// `file` is named in the places of the component.
void read_component(ByteReader& bytes, const std::filesystem::path& file, Element& component,
                    Archive& arrays);

/// Makes a component of its element and lets it load its arrays. Throws ConfigError.
template <class Interface>
Sub<Interface> make_with_arrays(const Element& component, Archive arrays) {
  Diagnostics diagnostics;
  Sub<Interface> made = make<Interface>(component, diagnostics);
  diagnostics.throw_if_any();
  try {
    made.object->load(arrays);
  } catch (const std::exception& wrong) {
    diagnostics.error(component.place,
                      fmt::format("<{}> cannot be made of its arrays: {}", component.name, wrong.what()));
    diagnostics.throw_if_any();
  }
  return made;
}

}  // namespace coppice
