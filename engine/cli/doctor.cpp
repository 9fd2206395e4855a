#include <fmt/format.h>
#include <sched.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <sstream>

#include "engine/cli/command.h"
#include "engine/cli/console.h"
#include "engine/cli/exit_status.h"
#include "engine/cli/layout.h"
#include "engine/data/file_system.h"
#include "engine/graph/provenance.h"
#include "engine/vocabulary/elementary.h"
#include "engine/vocabulary/random.h"

namespace coppice::cli {
namespace {

namespace fs = std::filesystem;

enum class Health { good, absent, bad };

/// What was looked at, and what was found.
struct Finding {
  std::string what;
  Health health = Health::good;
  std::string text;
};

/// A number of the generator and one of the elementary functions, as every machine must compute them.
Finding numbers() {
  const double draw = Draws(2017, "doctor", 0).uniform(Purpose("check"), 0, 1);
  const double value = elementary::exp(elementary::sin(draw));
  const bool good = draw == 0x1.3c452f404144p-6 && value == 0x1.04fd4a48ab5ebp+0;
  return {"numbers", good ? Health::good : Health::bad,
          good ? "as on every machine" : fmt::format("not as on other machines: {:a}, {:a}", draw, value)};
}

/// Results are written and locked: tries both in a folder that is taken away again.
Finding folder(const std::string& out) {
  const fs::path wanted = fs::absolute(out);
  fs::path there = wanted;
  while (!fs::exists(there) && there.has_relative_path()) there = there.parent_path();
  const fs::path probe = there / fmt::format(".coppice-doctor-{}", ::getpid());
  try {
    make_folder(probe);
    write_file(probe / "file", "x", true);
    link_file(probe / "file", probe / "link");
    const bool linked = fs::hard_link_count(probe / "file") == 2;
    const bool locked = OpenFile(probe / "file", 2).try_lock();
    coppice::remove_all(probe);
    if (!locked) return {"results", Health::bad, out + ": files cannot be locked there"};
    const double free_gb = 1e-9 * static_cast<double>(fs::space(there).available);
    return {"results", Health::good,
            fmt::format("{} can be written, {:.0f} GB are free{}", out, free_gb,
                        linked ? "" : "; without hard links, so that results are copied")};
  } catch (const std::runtime_error& error) {
    std::error_code ignored;
    fs::remove_all(probe, ignored);
    return {"results", Health::bad, error.what()};
  }
}

Finding cores() {
  cpu_set_t set;
  if (::sched_getaffinity(0, sizeof set, &set) != 0) return {"cores", Health::absent, "unknown"};
  return {"cores", Health::good, fmt::format("{} may be used", CPU_COUNT(&set))};
}

/// Times in records are the clock's; durations are measured with the steady one.
Finding clocks() {
  using std::chrono::steady_clock;
  const steady_clock::time_point start = steady_clock::now();
  steady_clock::time_point next = start;
  while (next == start) next = steady_clock::now();
  const double tick_s = std::chrono::duration<double>(next - start).count();
  const std::string now = timestamp();
  const bool good = now > "2026" && tick_s < 1e-3;
  return {"clock", good ? Health::good : Health::bad, fmt::format("{}, ticks of {:.1g} s", now, tick_s)};
}

/// A program that is not needed, but of use.
Finding program(const std::string& name, const std::string& use) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    const fs::path file = fs::path(folder) / name;
    if (::access(file.c_str(), X_OK) == 0)
      return {name, Health::good, fmt::format("{} ({})", file.string(), use)};
  }
  return {name, Health::absent, "not installed; it " + use};
}

struct Doctor {
  std::string out = "out";

  static Arguments<Doctor> arguments() {
    return Arguments<Doctor>().option("--out", "DIR", &Doctor::out, "Folder where results would go.",
                                      Completes::folder);
  }

  int run(const CommandLine&, Console& console) const {
    std::vector<std::vector<std::string>> rows;
    for (const auto& [name, value] : environment()) rows.push_back({"", name, value});
    bool healthy = true;
    for (const Finding& finding : {numbers(), folder(out), cores(), clocks(),
                                   program("xmllint", "checks configs against runner schema"),
                                   program("dot", "draws the graphs of runner plan --dot")}) {
      constexpr const char* kNames[] = {"ok", "-", "BAD"};
      rows.push_back({kNames[static_cast<std::size_t>(finding.health)], finding.what, finding.text});
      healthy = healthy && finding.health != Health::bad;
    }
    console.out(aligned(rows));
    return healthy ? kDone : kFailed;
  }
};

const Command<Doctor> kDoctor(
    {.name = "doctor",
     .group = Group::project,
     .doc = "Shows what the program was made with, and checks that it can work here.",
     .details = "Exit status 1 when something is BAD: numbers that differ from other machines', a folder of "
                "results that cannot be written, a clock that stands. What is marked - is not needed.",
     .examples = {{"runner doctor", "Checks the machine, and out/."}}});

}  // namespace
}  // namespace coppice::cli
