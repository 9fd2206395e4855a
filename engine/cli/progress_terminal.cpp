#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "engine/cli/layout.h"
#include "engine/cli/progress.h"

namespace coppice::cli {
namespace {

std::string bar(double fraction) {
  constexpr int kWidth = 12;
  const int full = std::clamp(static_cast<int>(fraction * kWidth), 0, kWidth);
  return '[' + std::string(static_cast<std::size_t>(full), '#') +
         std::string(static_cast<std::size_t>(kWidth - full), '.') + ']';
}

/// A status area at the bottom of the terminal, redrawn in place with one write; messages go above it.
class TerminalProgress : public RunListener {
 public:
  TerminalProgress(Console& console, const std::atomic<bool>& stop) : console_(console), stop_(stop) {}
  ~TerminalProgress() override { erase(); }

  void tick(const std::vector<NodeReport>& running, const RunTotals& totals) override {
    std::vector<std::string> lines = {totals_line(totals)};
    for (const NodeReport& report : running) {
      if (lines.size() > kRunningShown) break;
      lines.push_back(running_line(report));
    }
    if (running.size() > kRunningShown) {
      lines.push_back(fmt::format("  ... and {} more", running.size() - kRunningShown));
    }
    draw(lines);
  }
  void failed(const NodeReport& report, const RunTotals&) override {
    erase();
    console_.say(failure_text(console_, report));
  }
  void interrupted(const NodeReport& report, const RunTotals&) override {
    erase();
    console_.say(fmt::format("interrupted: {} {}\n", report.experiment, report.node->name));
  }
  void end(const RunTotals&) override { erase(); }

 private:
  std::string totals_line(const RunTotals& totals) const {
    const std::size_t done = totals.finished + totals.failed + totals.skipped;
    const double fraction =
        totals.to_run == 0 ? 1.0 : static_cast<double>(done) / static_cast<double>(totals.to_run);
    std::string text =
        fmt::format("{} {}/{} nodes, {} running", bar(fraction), done, totals.to_run, totals.running);
    if (totals.failed > 0) text += fmt::format(", {} failed", totals.failed);
    text += ", " + duration_text(totals.elapsed_s);
    if (totals.remaining_s) text += ", about " + duration_text(*totals.remaining_s) + " left";
    if (stop_) text += "; stopping, running nodes save their state (Ctrl-C again: at once)";
    return text;
  }
  static std::string running_line(const NodeReport& report) {
    std::string text =
        fmt::format("  {} {}  {}", report.experiment, report.node->name, duration_text(report.wall_s));
    if (report.total > 0) {
      text += fmt::format("  {:.0f} %",
                          100.0 * static_cast<double>(report.done) / static_cast<double>(report.total));
    }
    return text;
  }

  std::string to_first_line() const { return drawn_ > 1 ? fmt::format("\x1b[{}A\r", drawn_ - 1) : "\r"; }

  void draw(const std::vector<std::string>& lines) {
    const std::size_t width = static_cast<std::size_t>(console_.width()) - 1;
    std::string text;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      if (i > 0) text += '\n';
      text += shortened(lines[i], width);
      text += "\x1b[K";
    }
    if (text == shown_) return;
    console_.say(to_first_line() + text + "\x1b[J");
    shown_ = text;
    drawn_ = lines.size();
  }
  void erase() {
    if (drawn_ > 0) console_.say(to_first_line() + "\x1b[J");
    drawn_ = 0;
    shown_.clear();
  }

  static constexpr std::size_t kRunningShown = 8;
  Console& console_;
  const std::atomic<bool>& stop_;
  std::size_t drawn_ = 0;  ///< lines of the status area; the cursor stands at the end of the last
  std::string shown_;
};

}  // namespace

std::unique_ptr<RunListener> terminal_progress(Console& console, const std::atomic<bool>& stop) {
  return std::make_unique<TerminalProgress>(console, stop);
}

}  // namespace coppice::cli
