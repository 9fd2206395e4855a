#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "engine/cli/console.h"
#include "engine/graph/run.h"

namespace coppice::cli {

/// How a run is shown while it goes on: auto (terminal or plain), plain (a line for each finished node, few
/// enough to read), json (an object per line) or none; all on stderr. `stop` is the flag that Ctrl-C sets.
std::unique_ptr<RunListener> make_progress(const std::string& mode, Console& console,
                                           const std::atomic<bool>& stop);

// One for each way; see make_progress.
std::unique_ptr<RunListener> terminal_progress(Console& console, const std::atomic<bool>& stop);
std::unique_ptr<RunListener> plain_progress(Console& console);
std::unique_ptr<RunListener> json_progress(Console& console);

/// A failed node and its message in full.
std::string failure_text(const Console& console, const NodeReport& report);

}  // namespace coppice::cli
