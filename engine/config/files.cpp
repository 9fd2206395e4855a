#include "engine/config/files.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <filesystem>
#include <set>

namespace coppice::config {
namespace {

std::string hash_of(const std::string& text) {
  XXH128_canonical_t canonical;
  XXH128_canonicalFromHash(&canonical, XXH3_128bits(text.data(), text.size()));
  std::string hexadecimal;
  for (const unsigned char byte : canonical.digest) hexadecimal += fmt::format("{:02x}", byte);
  return hexadecimal;
}

/// The absolute path without links.
std::string identity_of(const std::string& path) {
  std::error_code failure;
  const std::filesystem::path canonical = std::filesystem::weakly_canonical(path, failure);
  return failure ? path : canonical.string();
}

void collect_definitions(const Element& element, std::vector<const Element*>& found) {
  if (element.name == "arg" || element.name == "let") found.push_back(&element);
  for (const Element& child : element.children) {
    if (element.name != "include") collect_definitions(child, found);  // its <arg> only passes a value
  }
}

/// The names that an element and those inside it may define; false where they cannot be known.
bool collect_names(const Element& element, std::vector<std::string>& names) {
  const bool defines = element.name == "arg" || element.name == "let" || element.name == "param";
  if (defines) names.emplace_back(element.get("name"));
  if (defines && names.back().find('$') != std::string::npos) return false;
  if (element.name == "point") {
    for (const Attribute& column : element.attributes) names.push_back(column.name);
  }
  return std::all_of(element.children.begin(), element.children.end(),
                     [&](const Element& child) { return collect_names(child, names); });
}

/// Whether every file that the element, or one inside it, includes is among `files`.
bool includes_only(const Element& element, const std::string& including, const std::set<std::string>& files) {
  if (element.name == "include" &&
      !files.contains(identity_of(path_beside(including, std::string(element.get("file"))))))
    return false;
  return std::all_of(element.children.begin(), element.children.end(),
                     [&](const Element& child) { return includes_only(child, including, files); });
}

}  // namespace

const LoadedFile& Files::load(const std::string& path) {
  const std::string identity = identity_of(path);
  if (const auto known = files_.find(identity); known != files_.end()) return *known->second;
  return add(read_source(path));
}

const LoadedFile& Files::add(std::shared_ptr<const SourceFile> source) {
  auto file = std::make_unique<LoadedFile>();
  file->identity = identity_of(source->path);
  file->root = parse_xml(source, file->mistakes);
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

std::optional<std::vector<std::string>> Files::every_name() const {
  std::set<std::string> identities;
  for (const auto& [identity, file] : files_) identities.insert(identity);
  std::vector<std::string> names;
  for (const auto& [identity, file] : files_) {
    const bool known =
        collect_names(file->root, names) && includes_only(file->root, file->source->path, identities);
    if (!known) return std::nullopt;
  }
  return names;
}

std::string path_beside(const std::string& including, const std::string& named) {
  const std::filesystem::path folder = std::filesystem::path(including).parent_path();
  return (folder / named).lexically_normal().string();
}

}  // namespace coppice::config
