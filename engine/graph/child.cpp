#include "engine/graph/child.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <malloc.h>
#include <poll.h>
#include <spawn.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

#include "engine/data/file_system.h"
#include "engine/graph/seconds.h"

namespace coppice {
namespace {

using Clock = std::chrono::steady_clock;

constexpr const char* kParentVariable = "COPPICE_PARENT";
/// Seconds between interrupting and killing. What is over its limit gets a tenth of it more to save how far
/// it is.
double grace(bool late, double time_limit) {
  constexpr double kMost = 5.0, kLeast = 0.5;
  return late ? std::clamp(0.1 * time_limit, kLeast, kMost) : kMost;
}

/// The child's standard error, read by this process.
class Pipe {
 public:
  Pipe() {
    if (::pipe2(ends_.data(), O_CLOEXEC) != 0) {
      throw std::runtime_error(fmt::format("cannot start a process: {}", std::strerror(errno)));
    }
    ::fcntl(ends_[0], F_SETFL, O_NONBLOCK);
  }
  ~Pipe() {
    ::close(ends_[0]);
    close_writing();
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  int writing() const { return ends_[1]; }
  void close_writing() {
    if (ends_[1] >= 0) ::close(ends_[1]);
    ends_[1] = -1;
  }
  /// Waits up to 50 ms for text and takes it.
  void take(std::string& text) const {
    pollfd waiting{ends_[0], POLLIN, 0};
    ::poll(&waiting, 1, 50);
    std::array<char, 4096> buffer;
    for (ssize_t count; (count = ::read(ends_[0], buffer.data(), buffer.size())) > 0;) {
      text.append(buffer.data(), static_cast<std::size_t>(count));
    }
    constexpr std::size_t kKept = 1 << 16;
    if (text.size() > kKept) text.erase(0, text.size() - kKept);
    if ((waiting.revents & (POLLHUP | POLLERR)) != 0) ::usleep(10'000);  // closed: it is about to end
  }

 private:
  std::array<int, 2> ends_{-1, -1};
};

pid_t spawn(const std::filesystem::path& program, const std::vector<std::string>& arguments, int errors) {
  std::vector<std::string> texts = {program.string()};
  texts.insert(texts.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& text : texts) argv.push_back(text.data());
  argv.push_back(nullptr);
  std::string parent = fmt::format("{}={}", kParentVariable, ::getpid());
  std::vector<char*> environment = {parent.data()};
  for (char** variable = environ; *variable != nullptr; ++variable) {
    if (!std::string_view(*variable).starts_with(std::string(kParentVariable) + "="))
      environment.push_back(*variable);
  }
  environment.push_back(nullptr);

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, errors, STDERR_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  // A group of its own: Ctrl-C at the terminal reaches this process alone, which passes it on once.
  posix_spawnattr_setflags(&attributes,
                           POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  posix_spawnattr_setpgroup(&attributes, 0);
  sigset_t signals;
  sigemptyset(&signals);
  posix_spawnattr_setsigmask(&attributes, &signals);
  sigaddset(&signals, SIGINT);
  posix_spawnattr_setsigdefault(&attributes, &signals);
  pid_t child = 0;
  const int error =
      ::posix_spawn(&child, program.c_str(), &actions, &attributes, argv.data(), environment.data());
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) {
    throw std::runtime_error(fmt::format("cannot start {}: {}", program.string(), std::strerror(error)));
  }
  return child;
}

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

/// A line "<name>: 1234 kB" of /proc/self/status, in bytes.
double own_memory(std::string_view name) {
  const std::string status = read_file("/proc/self/status");
  const std::size_t line = status.find(std::string(name) + ":");
  if (line == std::string::npos) return 0;
  return 1024.0 * std::strtod(status.c_str() + line + name.size() + 1, nullptr);
}

}  // namespace

ChildEnd run_child(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                   double time_limit, const std::atomic<bool>& stop) {
  const Clock::time_point start = Clock::now();
  Pipe pipe;
  const pid_t child = spawn(program, arguments, pipe.writing());
  pipe.close_writing();
  ChildEnd end;
  int status = 0;
  rusage usage{};
  Clock::time_point asked{};
  double patience = 0;
  while (::wait4(child, &status, WNOHANG, &usage) == 0) {
    pipe.take(end.errors);
    if (end.how == ChildEnd::How::exited) {
      const bool late = time_limit > 0 && seconds_since(start) >= time_limit;
      if (!late && !stop) continue;
      end.how = late ? ChildEnd::How::out_of_time : ChildEnd::How::interrupted;
      asked = Clock::now();
      patience = grace(late, time_limit);
      ::kill(child, SIGINT);
    } else if (seconds_since(asked) > patience) {
      ::kill(child, SIGKILL);
    }
  }
  pipe.take(end.errors);
  end.wall_s = seconds_since(start);
  end.cpu_s = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  end.peak_memory = 1024.0 * static_cast<double>(usage.ru_maxrss);
  if (end.how == ChildEnd::How::exited && WIFSIGNALED(status)) end.how = ChildEnd::How::signalled;
  end.code = WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status);
  return end;
}

void die_with_parent() {
  const char* parent = std::getenv(kParentVariable);
  if (parent == nullptr || std::to_string(::getppid()) != parent) return;
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (std::to_string(::getppid()) != parent) std::raise(SIGKILL);  // it died just now
}

void limit_memory(double bytes) {
  ::mallopt(M_ARENA_MAX, 1);  // others would reserve 64 MB each, which count although they are not used
  const double reserved = own_memory("VmSize") - own_memory("VmRSS");
  rlimit limit{};
  ::getrlimit(RLIMIT_AS, &limit);
  limit.rlim_cur = std::min(static_cast<rlim_t>(reserved + bytes), limit.rlim_max);
  if (::setrlimit(RLIMIT_AS, &limit) != 0) {
    throw std::runtime_error(fmt::format("cannot limit the memory: {}", std::strerror(errno)));
  }
}

void release_memory_limit() {
  rlimit limit{};
  ::getrlimit(RLIMIT_AS, &limit);
  limit.rlim_cur = limit.rlim_max;
  ::setrlimit(RLIMIT_AS, &limit);
}

double peak_memory() {
  return own_memory("VmHWM");
}

}  // namespace coppice
