#include <fcntl.h>
#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "engine/cli/command.h"
#include "engine/cli/complete.h"
#include "engine/cli/console.h"
#include "engine/cli/exit_status.h"
#include "engine/cli/help.h"
#include "engine/cli/parse.h"
#include "engine/cli/version.h"
#include "engine/graph/node.h"
#include "registry/component.h"

namespace coppice::cli {
namespace {

int serve(const CommandLine& line, Console& console) {
  console.set_color(color_choice(line));
  const Request request = parse(line);
  const std::size_t width = static_cast<std::size_t>(console.width());
  if (request.version) {
    console.out(version_text());
  } else if (request.help) {
    console.out(request.command != nullptr ? help(*request.command, width) : overview(width, request.family));
  } else if (request.command == nullptr) {
    console.say(overview(width, request.family));
    return kBadUsage;
  } else {
    return request.command->run(line, request.given, console);
  }
  return kDone;
}

/// The one place where errors become messages and exit statuses.
int guarded(std::vector<std::string> arguments, Console& console) {
  try {
    Catalogue::instance().verify();
    if (!arguments.empty() &&
        arguments.front() == "__complete") {  // any words may follow: they are not parsed
      console.out(complete({arguments.begin() + 1, arguments.end()}));
      console.flush();
      return kDone;
    }
    const int status = serve(CommandLine(std::move(arguments)), console);
    console.flush();
    return status;
  } catch (const OutputClosed&) {
    return kDone;
  } catch (const ConfigError& error) {
    console.say(error);
    return kBadUsage;
  } catch (const Interrupted&) {
    return kInterrupted;
  } catch (const std::bad_alloc&) {
    console.say(console.styled(Console::Style::red, "error: ") + "ran out of memory\n");
    return kFailed;
  } catch (const std::runtime_error& error) {
    console.say(console.styled(Console::Style::red, "error: ") + error.what() + '\n');
    return kFailed;
  } catch (const std::exception& error) {
    console.say(
        console.styled(Console::Style::red, "internal error: ") + error.what() +
        "\nThis is a mistake of the program, not yours; please report it with the command and its config.\n");
    return kInternalError;
  }
}

/// Opens standard input, output and errors where the caller closed them: a file opened later would get their
/// numbers, and what is said would be written into it. The wrong way round, so that using them still fails.
void occupy_standard_descriptors() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(descriptor, F_GETFD) >= 0 || errno != EBADF) continue;
    ::open("/dev/null", descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY);  // gets the lowest free number
  }
}

/// A plan of ten thousand nodes is millions of small objects: with large pages, and freed ones not merged
/// again and again, it is made in two thirds of the time. Reserves addresses, not memory; a node with a limit
/// of its memory, which counts addresses, goes without.
void use_large_pages(const std::vector<std::string>& arguments) {
  if (!arguments.empty() && arguments.front() == "node") return;
  constexpr std::uintptr_t kReserved = std::uintptr_t{256} << 20, kPage = std::uintptr_t{2} << 20;
  ::mallopt(M_MXFAST, 0);
  ::mallopt(M_TOP_PAD, kReserved);
  void* const kept = std::malloc(kPage / 32);  // what extends the heap
  const std::uintptr_t begin = (reinterpret_cast<std::uintptr_t>(kept) + kPage - 1) / kPage * kPage;
  const std::uintptr_t end = reinterpret_cast<std::uintptr_t>(::sbrk(0)) / kPage * kPage;
  if (kept != nullptr && begin < end) ::madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
  std::free(kept);
}

}  // namespace
}  // namespace coppice::cli

int main(int argc, char** argv) {
  std::vector<std::string> arguments(argv + 1, argv + argc);
  coppice::cli::use_large_pages(arguments);
  coppice::cli::occupy_standard_descriptors();
  std::signal(SIGPIPE, SIG_IGN);  // a closed pipe is seen where it is written to
  coppice::cli::Console console;
  console.set_color("auto");
  return coppice::cli::guarded(std::move(arguments), console);
}
