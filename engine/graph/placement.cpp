#include "engine/graph/placement.h"

#include <fmt/format.h>

#include <charconv>
#include <stdexcept>
#include <string_view>

#include "engine/data/hash.h"

namespace coppice {
namespace {

constexpr std::string_view kHeader = "coppice placements 2 ";

/// The text up to `separator`, which is taken away with it; all of it when there is none.
std::string_view cut(std::string_view& text, char separator) {
  const std::size_t end = text.find(separator);
  const std::string_view part = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return part;
}

template <class Integer>
Integer parse(std::string_view text) {
  Integer value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) throw std::runtime_error("not a number");
  return value;
}

Placement parse_placement(std::string_view line) {
  Placement placement;
  placement.key = cut(line, '\t');
  placement.labels = cut(line, '\t');
  while (!line.empty()) {
    PlacedFile file;
    file.path = cut(line, '\t');
    file.stamp.size = parse<std::uint64_t>(cut(line, '\t'));
    file.stamp.modified_ns = parse<std::int64_t>(cut(line, '\t'));
    file.hash = cut(line, '\t');
    placement.files.push_back(std::move(file));
  }
  return placement;
}

}  // namespace

std::optional<Placements> read_placements(const std::filesystem::path& file) {
  try {
    const std::string text = read_file(file);
    std::string_view rest = text;
    const std::string_view header = cut(rest, '\n');
    if (!header.starts_with(kHeader) || header.substr(kHeader.size()) != content_hash(rest))
      return std::nullopt;
    Placements placements;
    while (!rest.empty()) {
      std::string_view line = cut(rest, '\n');
      const std::string_view folder = cut(line, '\t');
      placements.emplace_hint(placements.end(), folder, parse_placement(line));
    }
    return placements;
  } catch (const std::runtime_error&) {
    return std::nullopt;
  }
}

void write_placements(const std::filesystem::path& file, const Placements& placements) {
  std::string lines;
  for (const auto& [folder, placement] : placements) {
    lines.append(folder).append("\t").append(placement.key).append("\t").append(placement.labels);
    for (const PlacedFile& placed : placement.files) {
      const FileStamp& stamp = placed.stamp;
      lines += fmt::format("\t{}\t{}\t{}\t{}", placed.path, stamp.size, stamp.modified_ns, placed.hash);
    }
    lines += '\n';
  }
  write_file(file, fmt::format("{}{}\n{}", kHeader, content_hash(lines), lines), true);
}

}  // namespace coppice
