#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "registry/error.h"

namespace coppice::cli {

/// What the user typed, as a text that messages can point into.
class CommandLine {
 public:
  /// `arguments` without the program's name.
  explicit CommandLine(std::vector<std::string> arguments);

  const std::vector<std::string>& arguments() const { return arguments_; }
  /// Where the argument stands that is `text`, or `--option=text`; the whole line when none is.
  Place place(std::string_view text) const;
  /// The mistake of one argument, ready to be thrown.
  ConfigError error(std::string_view argument, std::string message, std::string hint = {}) const;

 private:
  std::vector<std::string> arguments_;
  std::vector<int> columns_;  ///< of each argument in the file's only line
  std::shared_ptr<const SourceFile> file_;
};

}  // namespace coppice::cli
