#include "engine/graph/key.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "engine/graph/node.h"

namespace coppice {
namespace {

/// Parameters that every node has and that do not change what it computes; seed_label has a line of its own.
bool is_node_option(std::string_view name) {
  static constexpr std::array<std::string_view, 9> kOptions = {
      "id", "over", "at", "replicates", "seed_label", "doc", "time_limit", "memory_limit", "threads"};
  return std::find(kOptions.begin(), kOptions.end(), name) != kOptions.end();
}

/// The sub-components that fill a slot of a resolved element.
std::vector<const Element*> fillers(const Element& resolved, const SlotInfo& slot) {
  std::vector<const Element*> found;
  for (const Element& child : resolved.children) {
    if (slot.direct) {
      if (Catalogue::instance().find(slot.interface, child.name) != nullptr) found.push_back(&child);
    } else if (child.name == slot.name) {
      for (const Element& part : child.children) found.push_back(&part);
    }
  }
  return found;
}

const ComponentInfo& info_of(std::string_view interface, const Element& resolved) {
  const ComponentInfo* info = Catalogue::instance().find(interface, resolved.name);
  if (info == nullptr)
    throw std::logic_error("no component <" + resolved.name + ">, although it was resolved");
  return *info;
}

}  // namespace

const std::string& FileHashes::of(const std::string& path) {
  auto found = hashes_.find(path);
  if (found == hashes_.end()) found = hashes_.emplace(path, file_hash(path)).first;
  return found->second;
}

std::vector<InputFile> FileHashes::all() const {
  std::vector<InputFile> files;
  for (const auto& [path, hash] : hashes_) files.push_back({path, hash});
  return files;
}

void add_line(std::string& text, std::string_view name, std::string_view value) {
  text.append(name).append(" = ");
  for (const char c : value) {
    if (c == '\\') {
      text += "\\\\";
    } else if (c == '\n') {
      text += "\\n";
    } else {
      text += c;
    }
  }
  text += '\n';
}

void add_component(std::string& text, const std::string& prefix, std::string_view interface,
                   const Element& resolved, FileHashes& files, Diagnostics& diagnostics) {
  const ComponentInfo& info = info_of(interface, resolved);
  const bool node = interface == Node::kInterface;
  add_line(text, prefix, fmt::format("{}/{}", info.name, info.version));
  std::string name;
  for (const ParameterInfo& parameter : info.parameters) {
    const bool reference = parameter.type == ValueType::reference || parameter.type == ValueType::references;
    if (reference || (node && is_node_option(parameter.name))) continue;
    const Attribute* given = resolved.find(parameter.name);
    if (given == nullptr) continue;
    name.assign(prefix).append(".").append(parameter.name);
    if (parameter.type != ValueType::file || given->value.empty()) {
      add_line(text, name, given->value);
      continue;
    }
    try {
      add_line(text, name, "content " + files.of(given->value));
    } catch (const std::runtime_error& unreadable) {
      const Place& place = given->value_place.file ? given->value_place : resolved.place;
      diagnostics.error(place, fmt::format("{}=\"{}\": {}", parameter.name, given->value, unreadable.what()));
    }
  }
  for (const SlotInfo& slot : info.slots) {
    const std::vector<const Element*> parts = fillers(resolved, slot);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const std::string place =
          slot.many ? fmt::format("{}.{}.{}", prefix, slot.name, i) : prefix + "." + slot.name;
      add_component(text, place, slot.interface, *parts[i], files, diagnostics);
    }
  }
}

std::string with_prefix(std::string_view text, std::string_view from, std::string_view to) {
  std::string result;
  result.reserve(text.size() + text.size() / 4);
  while (!text.empty()) {
    const std::size_t end = text.find('\n') + 1;
    result.append(to).append(text.substr(from.size(), end - from.size()));
    text.remove_prefix(end);
  }
  return result;
}

std::vector<std::pair<std::string, std::string>> key_lines(std::string_view text) {
  std::vector<std::pair<std::string, std::string>> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    const std::size_t equals = line.find(" = ");
    if (equals != std::string_view::npos) lines.emplace_back(line.substr(0, equals), line.substr(equals + 3));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

}  // namespace coppice
