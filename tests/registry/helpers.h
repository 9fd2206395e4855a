#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "registry/source.h"

namespace coppice::test {

inline std::shared_ptr<const SourceFile> text_file(std::string text, std::string path = "a.xml") {
  return std::make_shared<SourceFile>(SourceFile{std::move(path), std::move(text)});
}

inline Element parse(std::string text, std::string path = "a.xml") {
  return parse_xml(text_file(std::move(text), std::move(path)));
}

/// The mistakes that parsing a text reports; none when it is good.
inline std::vector<Diagnostic> mistakes_of(std::string text) {
  try {
    parse(std::move(text));
    return {};
  } catch (const ConfigError& error) {
    return error.diagnostics();
  }
}

inline std::string text_of(const std::vector<Diagnostic>& diagnostics) {
  std::string text;
  for (const Diagnostic& diagnostic : diagnostics) text += to_text(diagnostic);
  return text;
}

/// An empty folder that goes away with the object.
class TemporaryFolder {
 public:
  explicit TemporaryFolder(const std::string& name)
      : path_(std::filesystem::temp_directory_path() / ("coppice_" + name + "_" + std::to_string(getpid()))) {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  /// Writes a file; returns its path.
  std::string write(const std::string& name, const std::string& bytes) const {
    std::ofstream(path_ / name, std::ios::binary) << bytes;
    return (path_ / name).string();
  }

 private:
  std::filesystem::path path_;
};

}  // namespace coppice::test
