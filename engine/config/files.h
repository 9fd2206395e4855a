#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/config/experiment.h"
#include "registry/source.h"

namespace coppice::config {

/// A config file as parsed; stays where it is in memory.
struct LoadedFile {
  std::shared_ptr<const SourceFile> source;
  std::string identity;  ///< the absolute path without links: tells whether two names mean the same file
  Element root;
  std::vector<Diagnostic> mistakes;  ///< against XML, after which the rest was clear
};

/// Every file that an expansion reads, each once.
class Files {
 public:
  /// Throws ConfigError when the file cannot be read or is not XML.
  const LoadedFile& load(const std::string& path);
  /// A text that is in memory already.
  const LoadedFile& add(std::shared_ptr<const SourceFile> source);

  /// In the order of reading, with the hash of their text (line ends as LF).
  const std::vector<InputFile>& read() const { return read_; }

  /// The <arg> and <let> elements of all files.
  std::vector<const Element*> definitions() const;
  /// Every name that the files define, for whatever values of their arguments: also those of sweep columns.
  /// Nothing where a column's name is worked out, or a file that is named was not read.
  std::optional<std::vector<std::string>> every_name() const;

 private:
  std::map<std::string, std::unique_ptr<const LoadedFile>> files_;  // by identity
  std::vector<InputFile> read_;
};

/// The path of a file that `including` names, as shown in messages.
std::string path_beside(const std::string& including, const std::string& named);

}  // namespace coppice::config
