#pragma once

#include <string>
#include <string_view>

#include "registry/error.h"

namespace coppice::cli {

/// Thrown when nobody reads standard output any more (`runner list | head -1`); main ends quietly.
struct OutputClosed {};

/// The two streams: data goes to stdout, talk to stderr.
class Console {
 public:
  /// `color` is auto, always or never; auto: on a terminal that can, unless NO_COLOR is set (no-color.org).
  void set_color(std::string_view color);

  /// Writes data to stdout. Throws OutputClosed, or std::runtime_error with the system's reason.
  void out(std::string_view text);
  /// Flushes stdout; throws as out does.
  void flush();
  /// As out and flush, for data beside the work of a command: where nobody reads it, nothing is said; where
  /// it cannot be written, the reason is said, and the exit status remains that of the work.
  void offer(std::string_view text);
  /// Writes talk to stderr, at once; failures are ignored, for there is nobody left to tell.
  void say(std::string_view text);
  /// Says every mistake and, when there are several, their number.
  void say(const ConfigError& error);

  bool stdout_is_terminal() const;
  bool stderr_is_terminal() const;
  /// Columns to wrap talk and help at: the terminal's, at most 100; 80 when there is none.
  int width() const;

  enum class Style { bold, red, green, yellow, cyan, dim };
  /// The text in the style when stderr shows colours, else the text.
  std::string styled(Style style, std::string_view text) const;

 private:
  bool color_ = false;
};

}  // namespace coppice::cli
