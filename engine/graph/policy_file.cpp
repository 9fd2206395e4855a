#include <fmt/format.h>
#include <xxhash.h>

#include <memory>
#include <stdexcept>

#include "engine/graph/artifacts.h"
#include "engine/data/file_system.h"
#include "engine/vocabulary/bytes.h"

namespace coppice {
namespace {

// docs/policy-files.md describes the format. The magic number's bytes are chosen as PNG's: a transfer that
// strips the eighth bit or changes line ends destroys it.
constexpr std::string_view kMagic(
    "\x89"
    "CPP\r\n\x1a\n",
    8);
constexpr std::uint32_t kFormatVersion = 1;

void append_axes(std::string& out, const Space& axes) {
  append_number(out, static_cast<std::uint32_t>(axes.size()));
  for (const Axis& axis : axes) {
    append_text(out, axis.name);
    append_text(out, axis.unit);
    append_number(out, axis.low);
    append_number(out, axis.high);
    append_number(out, static_cast<std::uint8_t>(axis.circular));
  }
}

Space read_axes(ByteReader& bytes) {
  Space axes;
  const auto count = bytes.number<std::uint32_t>("the number of axes");
  for (std::uint32_t i = 0; i < count; ++i) {
    Axis& axis = axes.emplace_back();
    axis.name = bytes.text("an axis's name");
    axis.unit = bytes.text("an axis's unit");
    axis.low = bytes.number<double>("an axis's limit");
    axis.high = bytes.number<double>("an axis's limit");
    axis.circular = bytes.number<std::uint8_t>("an axis's kind") != 0;
  }
  return axes;
}

void append_spaces(std::string& out, const Spaces& spaces) {
  append_axes(out, spaces.states);
  append_number(out, static_cast<std::uint32_t>(spaces.actions.size()));
  for (const ActionBox& box : spaces.actions) {
    append_text(out, box.name);
    append_axes(out, box.axes);
  }
}

Spaces read_spaces(ByteReader& bytes) {
  Spaces spaces;
  spaces.states = read_axes(bytes);
  const auto count = bytes.number<std::uint32_t>("the number of actions");
  for (std::uint32_t i = 0; i < count; ++i) {
    std::string name = bytes.text("an action's name");
    spaces.actions.push_back({std::move(name), read_axes(bytes)});
  }
  if (spaces != Spaces()) spaces.check();
  return spaces;
}

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& message) {
  const auto source = std::make_shared<SourceFile>(SourceFile{file.string(), {}});
  throw ConfigError({Diagnostic{{source, 0, 0, 1, nullptr}, message, {}, {}}});
}

/// What follows the checksum.
PolicyFile read_content(ByteReader& bytes, const std::filesystem::path& file) {
  PolicyFile content;
  content.writer = bytes.text("the writer's name");
  content.provenance = bytes.text("the provenance key");
  content.spaces = read_spaces(bytes);
  auto xml =
      std::make_shared<SourceFile>(SourceFile{file.string() + " (component)", bytes.text("the component")});
  content.component = parse_xml(xml);
  content.arrays = Archive::from_bytes(bytes.take(bytes.number<std::uint64_t>("the arrays"), "the arrays"));
  if (bytes.left() > 0) throw std::runtime_error(fmt::format("{} bytes follow the arrays", bytes.left()));
  return content;
}

}  // namespace

void write_policy_file(const std::filesystem::path& file, const PolicyFile& content) {
  std::string body;
  append_text(body, content.writer);
  append_text(body, content.provenance);
  append_spaces(body, content.spaces);
  append_text(body, to_xml(content.component));
  const std::string arrays = content.arrays.bytes();
  append_number<std::uint64_t>(body, arrays.size());
  body += arrays;

  std::string checked;  // what the checksum is of
  append_number<std::uint64_t>(checked, body.size());
  checked += body;
  std::string bytes(kMagic);
  append_number(bytes, kFormatVersion);
  append_number<std::uint64_t>(bytes, XXH3_64bits(checked.data(), checked.size()));
  bytes += checked;
  write_file(file, bytes, true);
}

PolicyFile read_policy_file(const std::filesystem::path& file) {
  std::string all;
  try {
    all = read_file(file);
  } catch (const std::runtime_error& unreadable) {
    throw ConfigError(unreadable.what());
  }
  if (!std::string_view(all).starts_with(kMagic)) fail(file, "this is not a policy file");
  ByteReader bytes(std::string_view(all).substr(kMagic.size()));
  try {
    const auto version = bytes.number<std::uint32_t>("the format version");
    if (version > kFormatVersion) {
      fail(file,
           fmt::format("the policy file has format version {}; this program reads versions up to {}: a newer "
                       "program wrote it",
                       version, kFormatVersion));
    }
    if (version == 0) fail(file, "the policy file is damaged: it has format version 0");
    const auto checksum = bytes.number<std::uint64_t>("the checksum");
    const std::string_view checked = std::string_view(all).substr(all.size() - bytes.left());
    const auto size = bytes.number<std::uint64_t>("the size");
    if (size > bytes.left()) {
      fail(file, fmt::format("the policy file is truncated: {} bytes are missing", size - bytes.left()));
    }
    if (XXH3_64bits(checked.data(), checked.size()) != checksum) {
      fail(file, "the policy file is damaged: its checksum does not fit its content");
    }
    return read_content(bytes, file);
  } catch (const ConfigError&) {
    throw;
  } catch (const std::exception& wrong) {
    fail(file, fmt::format("the policy file is truncated or damaged: {}", wrong.what()));
  }
}

MadePolicy make_policy(const PolicyFile& file) {
  Diagnostics diagnostics;
  MadePolicy made = make<Policy>(file.component, diagnostics);
  diagnostics.throw_if_any();
  Archive arrays = file.arrays;
  try {
    made.object->load(arrays);
  } catch (const std::exception& wrong) {
    diagnostics.error(file.component.place, fmt::format("<{}> cannot be made of its arrays: {}",
                                                        file.component.name, wrong.what()));
    diagnostics.throw_if_any();
  }
  return made;
}

}  // namespace coppice
