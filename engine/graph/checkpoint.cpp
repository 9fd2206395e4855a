#include "engine/graph/checkpoint.h"

#include <stdexcept>
#include <string_view>

#include "engine/data/file_system.h"
#include "engine/data/hash.h"
#include "engine/vocabulary/bytes.h"

namespace coppice {
namespace {

constexpr std::string_view kMagic = "coppice checkpoint 2\n";

}  // namespace

std::string checkpoint_bytes(const Checkpoint& checkpoint) {
  std::string content;
  append_number(content, checkpoint.work.wall_s);
  append_number(content, checkpoint.work.cpu_s);
  append_number(content, static_cast<std::uint32_t>(checkpoint.work.counts.size()));
  for (const auto& [name, amount] : checkpoint.work.counts) {
    append_text(content, name);
    append_number(content, amount);
  }
  append_number(content, static_cast<std::uint32_t>(checkpoint.work.measures.size()));
  for (const auto& [name, value] : checkpoint.work.measures) {
    append_text(content, name);
    append_number(content, value);
  }
  content += checkpoint.state.bytes();
  std::string bytes(kMagic);
  append_text(bytes, content_hash(content));
  return bytes + content;
}

std::optional<Checkpoint> read_checkpoint(const std::filesystem::path& file) {
  FileStamp stamp;
  if (!stamp_file(file, stamp)) return std::nullopt;
  try {
    const std::string all = read_file(file);
    ByteReader bytes(all);
    if (bytes.take(kMagic.size(), "the magic number") != kMagic) return std::nullopt;
    const std::string hash = bytes.text("the checksum");
    const std::string_view content = bytes.take(bytes.left(), "the content");
    if (content_hash(content) != hash) return std::nullopt;
    ByteReader rest(content);
    Checkpoint checkpoint;
    checkpoint.work.wall_s = rest.number<double>("wall_s");
    checkpoint.work.cpu_s = rest.number<double>("cpu_s");
    for (auto left = rest.number<std::uint32_t>("the counts"); left > 0; --left) {
      const std::string name = rest.text("a count's name");
      checkpoint.work.counts[name] = rest.number<std::int64_t>("a count");
    }
    for (auto left = rest.number<std::uint32_t>("the measures"); left > 0; --left) {
      const std::string name = rest.text("a measure's name");
      checkpoint.work.measures[name] = rest.number<double>("a measure");
    }
    checkpoint.state = Archive::from_bytes(rest.take(rest.left(), "the state"));
    return checkpoint;
  } catch (const std::runtime_error&) {
    return std::nullopt;
  }
}

}  // namespace coppice
