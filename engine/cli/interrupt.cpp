#include "engine/cli/interrupt.h"

#include <unistd.h>

#include <csignal>

#include "engine/cli/exit_status.h"

namespace coppice::cli {
namespace {

std::atomic<bool> requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "the signal handler may not lock");

void on_signal(int) {
  if (!requested.exchange(true)) return;
  // Below the status area, whose lines stay: a handler can neither wait for nor redraw them.
  [[maybe_unused]] const ssize_t ignored = ::write(STDERR_FILENO, "\n", 1);
  ::_exit(kInterrupted);
}

}  // namespace

const std::atomic<bool>& interrupt_requested() {
  return requested;
}

void watch_interrupts() {
  struct sigaction action {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

}  // namespace coppice::cli
