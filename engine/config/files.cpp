#include "engine/config/files.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <filesystem>

namespace coppice::config {
namespace {

std::string hash_of(const std::string& text) {
  XXH128_canonical_t canonical;
  XXH128_canonicalFromHash(&canonical, XXH3_128bits(text.data(), text.size()));
  std::string hexadecimal;
  for (const unsigned char byte : canonical.digest) hexadecimal += fmt::format("{:02x}", byte);
  return hexadecimal;
}

void collect_definitions(const Element& element, std::vector<const Element*>& found) {
  if (element.name == "arg" || element.name == "let") found.push_back(&element);
  for (const Element& child : element.children) {
    if (element.name != "include") collect_definitions(child, found);  // its <arg> only passes a value
  }
}

}  // namespace

const LoadedFile& Files::load(const std::string& path) {
  std::error_code failure;
  const std::filesystem::path canonical = std::filesystem::weakly_canonical(path, failure);
  const std::string identity = failure ? path : canonical.string();
  if (const auto known = files_.find(identity); known != files_.end()) return *known->second;
  return add(read_source(path));
}

const LoadedFile& Files::add(std::shared_ptr<const SourceFile> source) {
  std::error_code failure;
  const std::filesystem::path canonical = std::filesystem::weakly_canonical(source->path, failure);
  auto file = std::make_unique<LoadedFile>();
  file->identity = failure ? source->path : canonical.string();
  file->root = parse_xml(source);
  read_.push_back({source->path, hash_of(source->text)});
  file->source = std::move(source);
  const std::string identity = file->identity;
  return *files_.insert_or_assign(identity, std::move(file)).first->second;
}

std::vector<const Element*> Files::definitions() const {
  std::vector<const Element*> found;
  for (const auto& [identity, file] : files_) collect_definitions(file->root, found);
  return found;
}

std::string path_beside(const std::string& including, const std::string& named) {
  const std::filesystem::path folder = std::filesystem::path(including).parent_path();
  return (folder / named).lexically_normal().string();
}

}  // namespace coppice::config
