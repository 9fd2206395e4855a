#include "engine/graph/artifacts.h"
#include "engine/graph/component_file.h"

namespace coppice {
namespace {

// The magic number's bytes are chosen as PNG's: a transfer that strips the eighth bit or changes line ends
// destroys it.
constexpr FileKind kPolicyFileKind = {"policy", std::string_view("\x89"
                                                                 "CPP\r\n\x1a\n",
                                                                 8)};

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

}  // namespace

void write_policy_file(const std::filesystem::path& file, const PolicyFile& content) {
  std::string body;
  append_text(body, content.writer.empty() ? writer_text() : content.writer);
  append_text(body, content.provenance);
  append_spaces(body, content.spaces);
  append_component(body, content.component, content.arrays);
  write_component_file(file, kPolicyFileKind, body);
}

PolicyFile parse_policy_file(std::string_view bytes, const std::filesystem::path& file) {
  PolicyFile content;
  parse_component_file(bytes, file, kPolicyFileKind, [&](ByteReader& reader) {
    content.writer = reader.text("the writer's name");
    content.provenance = reader.text("the provenance key");
    content.spaces = read_spaces(reader);
    read_component(reader, file, content.component, content.arrays);
  });
  return content;
}

PolicyFile read_policy_file(const std::filesystem::path& file) {
  return parse_policy_file(component_file_bytes(file), file);
}

MadePolicy make_policy(const PolicyFile& file) {
  return make_with_arrays<Policy>(file.component, file.arrays);
}

}  // namespace coppice
