#include "engine/cli/console.h"

#include <fmt/format.h>
#include <stdio_ext.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

namespace coppice::cli {
namespace {

bool terminal_shows_colors() {
  const char* no_color = std::getenv("NO_COLOR");
  const char* terminal = std::getenv("TERM");
  if (no_color != nullptr && *no_color != '\0') return false;
  return isatty(STDERR_FILENO) != 0 && terminal != nullptr && std::strcmp(terminal, "dumb") != 0;
}

[[noreturn]] void output_failed() {
  if (errno == EPIPE) throw OutputClosed{};
  throw std::runtime_error(fmt::format("cannot write to standard output: {}", std::strerror(errno)));
}

/// A diagnostic's text, its parts coloured as compilers do.
std::string colored(const Console& console, const std::string& text) {
  const std::size_t end = text.find('\n');
  std::string first = text.substr(0, end);
  const std::size_t word = first.find("error: ");
  if (word == std::string::npos) return text;
  first = console.styled(Console::Style::bold, first.substr(0, word)) +
          console.styled(Console::Style::red, "error: ") +
          console.styled(Console::Style::bold, first.substr(word + 7));
  if (end == std::string::npos) return first;
  std::string rest = text.substr(end);
  const std::size_t caret = rest.find("| ");
  const std::size_t mark = caret == std::string::npos ? caret : rest.find('^', rest.find('\n', caret));
  if (mark != std::string::npos) {
    const std::size_t stop = std::min(rest.find('\n', mark), rest.size());
    rest = rest.substr(0, mark) + console.styled(Console::Style::green, rest.substr(mark, stop - mark)) +
           rest.substr(stop);
  }
  return first + rest;
}

}  // namespace

void Console::set_color(std::string_view color) {
  color_ = color == "always" || (color == "auto" && terminal_shows_colors());
}

void Console::out(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size()) output_failed();
}

void Console::flush() {
  if (std::fflush(stdout) != 0) output_failed();
}

void Console::offer(std::string_view text) {
  try {
    out(text);
    flush();
    return;
  } catch (const OutputClosed&) {
  } catch (const std::runtime_error& error) {
    say(styled(Style::yellow, "warning: ") + error.what() + '\n');
  }
  ::__fpurge(stdout);  // else it would be tried again
}

void Console::say(std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(STDERR_FILENO, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
}

void Console::say(const ConfigError& error) {
  std::string all;
  for (const Diagnostic& diagnostic : error.diagnostics()) {
    all += colored(*this, to_text(diagnostic));
    if (!all.ends_with('\n')) all += '\n';
  }
  const std::size_t count = error.diagnostics().size();
  const bool all_kept = count < Diagnostics::kMost;
  if (count > 1) all += fmt::format("{} errors{}\n", count, all_kept ? "" : ", and there may be more");
  say(all);
}

bool Console::stdout_is_terminal() const {
  return isatty(STDOUT_FILENO) != 0;
}
bool Console::stderr_is_terminal() const {
  return isatty(STDERR_FILENO) != 0;
}

int Console::width() const {
  winsize size{};
  const bool known =
      ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 || ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0;
  return known && size.ws_col > 0 ? std::clamp<int>(size.ws_col, 20, 100) : 80;
}

std::string Console::styled(Style style, std::string_view text) const {
  if (!color_) return std::string(text);
  static constexpr int kCodes[] = {1, 31, 32, 33, 36, 2};
  return fmt::format("\x1b[{}m{}\x1b[0m", kCodes[static_cast<int>(style)], text);
}

}  // namespace coppice::cli
