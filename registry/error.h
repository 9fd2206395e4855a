#pragma once

#include <cstddef>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace coppice {

/// A text that the user wrote: a config file, or the command line. Kept whole, so that messages can quote it.
struct SourceFile {
  std::string path;  ///< as shown in messages
  std::string text;

  /// Line `number` (from 1) without its line end; empty when there is none.
  std::string_view line(int number) const;
};

/// One step of how expansion reached a place: "included from" or "in macro 'm' called at".
struct TraceFrame {
  std::string what;
  std::shared_ptr<const SourceFile> file;
  int line = 0;
  std::shared_ptr<const TraceFrame> outer;  ///< the next step out, null at the file given by the user
};

/// Where something stands in the user's text. Lines and columns count from 1; 0 means unknown.
struct Place {
  std::shared_ptr<const SourceFile> file;
  int line = 0;
  int column = 0;  ///< in characters, whatever bytes they take; a tab is one
  int length = 1;  ///< characters to underline
  std::shared_ptr<const TraceFrame> trace;
};

/// One mistake of the user: where, what was given and which rule it breaks, what would be valid.
struct Diagnostic {
  Place place;
  std::string message;             ///< "<cma_es> has no parameter 'populaton'"
  std::string hint;                ///< "did you mean 'population' (integer >= 2)?"; may be empty
  std::vector<std::string> notes;  ///< further lines; may be empty
};

/// The diagnostic as the user reads it: file:line:column, quoted line, caret, hint, include and macro trace.
/// Ends with a line end.
std::string to_text(const Diagnostic& diagnostic);

/// The user's mistakes, all of them, sorted by file and place, each once. Only `main` catches it; exit
/// status 2. what() is their texts.
class ConfigError : public std::runtime_error {
 public:
  explicit ConfigError(std::vector<Diagnostic> diagnostics);
  explicit ConfigError(const std::string& message);  ///< a mistake without a place in a file
  const std::vector<Diagnostic>& diagnostics() const { return diagnostics_; }

 private:
  struct Ordered {};
  ConfigError(std::vector<Diagnostic> diagnostics, Ordered);

  std::vector<Diagnostic> diagnostics_;
};

/// Collects mistakes, so that one pass reports all of them. An identical mistake at the same place counts
/// once.
class Diagnostics {
 public:
  static constexpr std::size_t kMost = 1000;  ///< nobody reads on: later ones are counted, not kept

  void error(const Place& place, std::string message, std::string hint = {},
             std::vector<std::string> notes = {});
  void add(const ConfigError& error);
  /// Counts a mistake that was reported elsewhere, so that nothing is made of what it left incomplete.
  void already_reported() { ++reported_; }
  bool empty() const { return all_.empty(); }
  /// How often a mistake was reported, repetitions included: it grows with every call of error().
  std::size_t size() const { return reported_; }
  const std::vector<Diagnostic>& all() const { return all_; }
  /// Throws ConfigError with everything collected, if there is anything.
  void throw_if_any() const;

 private:
  std::vector<Diagnostic> all_;
  std::set<std::string> seen_;
  std::size_t reported_ = 0;
};

}  // namespace coppice
