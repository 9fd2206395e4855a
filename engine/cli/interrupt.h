#pragma once

#include <atomic>

namespace coppice::cli {

/// Set by the first Ctrl-C (SIGINT, SIGTERM) after watch_interrupts(): what runs should save its state and
/// end. The second ends the process at once with kInterrupted; nothing acknowledged is lost.
const std::atomic<bool>& interrupt_requested();

void watch_interrupts();

}  // namespace coppice::cli
