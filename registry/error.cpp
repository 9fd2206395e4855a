#include "registry/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <tuple>
#include <utility>

#include "registry/text.h"

namespace coppice {
namespace {

const std::string& path_of(const Place& place) {
  static const std::string kNone;
  return place.file ? place.file->path : kNone;
}

/// What orders mistakes, and makes two of them the same; the way that expansion came (the trace) does not.
auto identity(const Diagnostic& diagnostic) {
  const Place& place = diagnostic.place;
  return std::tie(path_of(place), place.line, place.column, diagnostic.message);
}

void sort_and_deduplicate(std::vector<Diagnostic>& all) {
  std::stable_sort(all.begin(), all.end(),
                   [](const Diagnostic& a, const Diagnostic& b) { return identity(a) < identity(b); });
  all.erase(std::unique(all.begin(), all.end(),
                        [](const Diagnostic& a, const Diagnostic& b) { return identity(a) == identity(b); }),
            all.end());
}

/// The quoted line and, below it, the blanks that lead to the caret and the underlining.
struct Quote {
  std::string line, indent, underline;
};

/// Tabs stay tabs in both lines and wide characters count double, so that the caret stands below its
/// character on any terminal. A long line is cut to a window around the caret.
Quote quote(std::string_view line, const Place& place) {
  constexpr std::size_t kBefore = 100, kAfter = 60;
  const std::size_t caret = place.column > 0 ? static_cast<std::size_t>(place.column - 1) : 0;
  const std::size_t marked = caret + static_cast<std::size_t>(std::max(1, place.length));
  const std::size_t first = caret > kBefore ? caret - kBefore : 0;
  Quote made;
  if (first > 0) made.line = made.indent = "...";
  if (first > 0) made.indent = "   ";
  std::size_t index = 0, offset = 0;
  for (; index < first && offset < line.size(); ++index) {
    const bool ascii = (line[offset] & 0x80) == 0;  // most are: a line may have millions
    const std::optional<CodePoint> character = ascii ? std::nullopt : decode_utf8(line, offset);
    offset += character ? character->bytes : 1;
  }
  for (; offset < line.size(); ++index) {
    const std::optional<CodePoint> character = decode_utf8(line, offset);
    const std::size_t bytes = character ? character->bytes : 1;
    if (index > caret + kAfter) {
      made.line += "...";
      break;
    }
    const bool printable =
        character && (character->value >= 0x20 || character->value == '\t') && character->value != 0x7F;
    const int width = printable ? display_width(character->value) : 1;
    made.line += printable ? line.substr(offset, bytes) : "?";  // no control codes to the terminal
    if (index < caret) {
      made.indent +=
          line[offset] == '\t' ? std::string("\t") : std::string(static_cast<std::size_t>(width), ' ');
    } else if (index < marked) {
      made.underline.append(static_cast<std::size_t>(width), '~');
    }
    offset += bytes;
  }
  if (made.underline.empty()) made.underline = "~";
  made.underline.front() = '^';
  return made;
}

std::string trace_text(const TraceFrame* frame) {
  std::vector<std::string> steps;
  for (; frame != nullptr; frame = frame->outer.get()) {
    std::string step = frame->what;
    if (frame->file) step += " " + frame->file->path;
    if (frame->file && frame->line > 0) step += fmt::format(":{}", frame->line);
    steps.push_back(std::move(step));
  }
  return join(steps);
}

std::string all_texts(const std::vector<Diagnostic>& diagnostics) {
  std::string text;
  for (const Diagnostic& diagnostic : diagnostics) text += to_text(diagnostic);
  if (!text.empty()) text.pop_back();  // the last line end
  return text;
}

/// Texts that quote what was given stay readable when megabytes were given.
void shorten(std::string& text) {
  constexpr std::size_t kLongest = 2000, kHead = 600, kTail = 200;
  if (text.size() <= kLongest) return;
  const auto character = [&text](std::size_t at) {  // not in the middle of one
    while (at < text.size() && (text[at] & 0xC0) == 0x80) ++at;
    return at;
  };
  const std::size_t head = character(kHead), tail = character(text.size() - kTail);
  text =
      fmt::format("{} ... ({} bytes left out) ... {}", text.substr(0, head), tail - head, text.substr(tail));
}

/// A message without its numbers.
std::string form_of(std::string_view message) {
  std::string form;
  for (const char c : message) {
    if (std::string_view("0123456789+-.").find(c) == std::string_view::npos) form += c;
  }
  return form;
}

std::vector<Diagnostic> in_order(std::vector<Diagnostic> diagnostics) {
  for (Diagnostic& diagnostic : diagnostics) {
    shorten(diagnostic.message);
    shorten(diagnostic.hint);
  }
  sort_and_deduplicate(diagnostics);
  return diagnostics;
}

}  // namespace

std::string_view SourceFile::line(int number) const {
  std::size_t begin = 0;
  for (int i = 1; i < number; ++i) {
    const std::size_t end = text.find('\n', begin);
    if (end == std::string::npos) return {};
    begin = end + 1;
  }
  if (number < 1) return {};
  std::string_view found = std::string_view(text).substr(begin);
  found = found.substr(0, found.find('\n'));
  if (found.ends_with('\r')) found.remove_suffix(1);
  return found;
}

std::string to_text(const Diagnostic& diagnostic) {
  const Place& place = diagnostic.place;
  std::string text = path_of(place);
  if (place.file && place.line > 0) text += fmt::format(":{}", place.line);
  if (place.file && place.line > 0 && place.column > 0) text += fmt::format(":{}", place.column);
  if (place.file) text += ": ";
  text += "error: " + diagnostic.message + "\n";

  const std::string_view line = place.file ? place.file->line(place.line) : std::string_view();
  if (!line.empty()) {
    const Quote quoted = quote(line, place);
    text += fmt::format("{:>5} | {}\n", place.line, quoted.line);
    if (place.column > 0) {
      text += fmt::format("      | {}{}{}{}\n", quoted.indent, quoted.underline,
                          diagnostic.hint.empty() ? "" : " ", diagnostic.hint);
    }
  }
  if ((line.empty() || place.column <= 0) && !diagnostic.hint.empty())
    text += "   note: " + diagnostic.hint + "\n";
  for (const std::string& note : diagnostic.notes) text += "   note: " + note + "\n";
  if (place.trace) text += "   note: " + trace_text(place.trace.get()) + "\n";
  return text;
}

ConfigError::ConfigError(std::vector<Diagnostic> diagnostics)
    : ConfigError(in_order(std::move(diagnostics)), Ordered{}) {}

ConfigError::ConfigError(std::vector<Diagnostic> diagnostics, Ordered)
    : std::runtime_error(all_texts(diagnostics)), diagnostics_(std::move(diagnostics)) {}

ConfigError::ConfigError(const std::string& message)
    : ConfigError({Diagnostic{{}, message, {}, {}}}, Ordered{}) {}

void Diagnostics::error(const Place& place, std::string message, std::string hint,
                        std::vector<std::string> notes) {
  ++reported_;
  if (all_.size() >= kMost) return;
  shorten(message);
  shorten(hint);
  const std::string where = fmt::format("{}\n{}\n{}\n", path_of(place), place.line, place.column);
  if (!seen_.insert(where + message).second) return;
  // Of mistakes at one place that differ in numbers only, as one that the points of a sweep repeat does, the
  // first ten are said.
  const std::string form = where + "alike\n" + form_of(message);
  bool kept = place.line == 0;
  for (char i = '0'; i <= '9' && !kept; ++i) kept = seen_.insert(form + i).second;
  if (kept) {
    all_.push_back({place, std::move(message), std::move(hint), std::move(notes)});
  } else if (seen_.insert(form + "more").second) {
    const auto last = std::find_if(all_.rbegin(), all_.rend(), [&](const Diagnostic& earlier) {
      return path_of(earlier.place) == path_of(place) && earlier.place.line == place.line &&
             earlier.place.column == place.column && form_of(earlier.message) == form_of(message);
    });
    last->notes.emplace_back("and more like it here");
  }
}

void Diagnostics::add(const ConfigError& error) {
  for (const Diagnostic& diagnostic : error.diagnostics()) {
    this->error(diagnostic.place, diagnostic.message, diagnostic.hint, diagnostic.notes);
  }
}

void Diagnostics::throw_if_any() const {
  if (!all_.empty()) throw ConfigError(all_);
}

}  // namespace coppice
