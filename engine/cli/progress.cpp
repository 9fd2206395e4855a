#include "engine/cli/progress.h"

#include <fmt/format.h>

#include <cstdlib>
#include <string_view>

#include "engine/cli/layout.h"

namespace coppice::cli {
namespace {

class NoProgress : public RunListener {
 public:
  explicit NoProgress(Console& console) : console_(console) {}
  void failed(const NodeReport& report, const RunTotals&) override {
    console_.say(failure_text(console_, report));
  }

 private:
  Console& console_;
};

/// One line for each finished node; of many nodes only one a second.
class PlainProgress : public RunListener {
 public:
  explicit PlainProgress(Console& console) : console_(console) {}

  void begin(const RunTotals& totals) override { interval_s_ = totals.to_run > kFew ? 1 : 0; }

  void finished(const NodeReport& report, const RunTotals& totals) override {
    const std::size_t done = totals.finished + totals.failed + totals.skipped;
    if (totals.elapsed_s < next_s_ && done < totals.to_run) return;
    next_s_ = totals.elapsed_s + interval_s_;
    const std::string left = totals.remaining_s && done < totals.to_run
                                 ? ", about " + duration_text(*totals.remaining_s) + " left"
                                 : "";
    console_.say(fmt::format("[{}/{}] {} {} ({}{})\n", done, totals.to_run, report.experiment,
                             report.node->name, duration_text(report.wall_s), left));
  }
  void failed(const NodeReport& report, const RunTotals&) override {
    console_.say(failure_text(console_, report));
  }
  void skipped(const NodeReport& report, const RunTotals&) override {
    console_.say(fmt::format("skipped: {} {}: {}\n", report.experiment, report.node->name, report.message));
  }
  void interrupted(const NodeReport& report, const RunTotals&) override {
    console_.say(fmt::format("interrupted: {} {}\n", report.experiment, report.node->name));
  }

 private:
  static constexpr std::size_t kFew = 200;
  Console& console_;
  double interval_s_ = 0;
  double next_s_ = 0;
};

}  // namespace

std::string failure_text(const Console& console, const NodeReport& report) {
  return fmt::format("{}{} {}: {}\n", console.styled(Console::Style::red, "failed: "), report.experiment,
                     report.node->name, report.message);
}

std::unique_ptr<RunListener> plain_progress(Console& console) {
  return std::make_unique<PlainProgress>(console);
}

std::unique_ptr<RunListener> make_progress(const std::string& mode, Console& console,
                                           const std::atomic<bool>& stop) {
  if (mode == "none") return std::make_unique<NoProgress>(console);
  if (mode == "json") return json_progress(console);
  const char* terminal = std::getenv("TERM");
  const bool can_move = terminal != nullptr && std::string_view(terminal) != "dumb";
  if (mode == "auto" && console.stderr_is_terminal() && can_move) return terminal_progress(console, stop);
  return plain_progress(console);
}

}  // namespace coppice::cli
