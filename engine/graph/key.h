#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "engine/config/experiment.h"
#include "engine/data/hash.h"
#include "registry/component.h"

namespace coppice {

// The key of a node is the XXH3-128 of its key text: lines "name = value", one for everything that decides
// the result and nothing else. Names are declared identifiers joined by points, values are escaped to one
// line, so that different content never gives equal texts. Not in it: path, id, sweep point, time, threads,
// limits.

/// Raised when the meaning of the key text changes: every result is then computed anew.
inline constexpr int kKeyFormat = 1;

/// Content hashes of the files that parameters name; each is read once.
class FileHashes {
 public:
  /// Throws std::runtime_error with the file and the system's reason.
  const std::string& of(const std::string& path);
  std::vector<InputFile> all() const;  ///< sorted by path

 private:
  std::map<std::string, std::string, std::less<>> hashes_;
};

/// Adds the line "name = value".
void add_line(std::string& text, std::string_view name, std::string_view value);

/// Adds the lines of a resolved component: "prefix = fqi/2", then "prefix.iterations = 20" and so on,
/// sub-components below their slot. Parameters that are references are left out, those of a node also where
/// they do not change its result (id, doc, limits). A file gives its content's hash. Unreadable files go to
/// `diagnostics`.
void add_component(std::string& text, const std::string& prefix, std::string_view interface,
                   const Element& resolved, FileHashes& files, Diagnostics& diagnostics);

/// Lines of `text` with "from" replaced by "to" at the start of each name.
std::string with_prefix(std::string_view text, std::string_view from, std::string_view to);

/// A key text in its lines, for comparing.
std::vector<std::pair<std::string, std::string>> key_lines(std::string_view text);

}  // namespace coppice
