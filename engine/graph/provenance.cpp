#include "engine/graph/provenance.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <gnu/libc-version.h>
#include <sleef.h>
#include <sqlite3.h>
#include <sys/utsname.h>
#include <xxhash.h>

#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string_view>
#include <thread>

#include "engine/data/file_system.h"
#include "engine/graph/build_info.h"

namespace coppice {
namespace {

using Json = nlohmann::ordered_json;

/// Raised when the meaning of a field changes.
constexpr int kProvenanceFormat = 1;

/// The value of the first line "name<separator>value" of a text file; "unknown" when there is none.
std::string look_up(const char* file, std::string_view name, char separator) {
  std::ifstream input(file);
  for (std::string line; std::getline(input, line);) {
    const std::size_t end = line.find(separator);
    if (!line.starts_with(name) || end == std::string::npos) continue;
    const std::size_t first = line.find_first_not_of(" \t\"", end + 1);
    const std::size_t last = line.find_last_not_of(" \t\"");
    if (first != std::string::npos && last >= first) return line.substr(first, last - first + 1);
  }
  return "unknown";
}

/// 10203 is 1.2.3.
std::string version_of(int number) {
  return fmt::format("{}.{}.{}", number / 10000, number / 100 % 100, number % 100);
}

}  // namespace

std::vector<std::pair<std::string, std::string>> environment() {
  const BuildInfo& build = build_info();
  utsname system{};
  ::uname(&system);
  return {
      {"coppice", std::string(build.version)},
      {"commit", std::string(build.commit)},
      {"compiler", std::string(build.compiler)},
      {"flags", std::string(build.flags)},
      {"eigen", std::string(build.eigen)},
      {"fmt", version_of(FMT_VERSION)},
      {"glibc", ::gnu_get_libc_version()},
      {"nlohmann_json", fmt::format("{}.{}.{}", NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR,
                                    NLOHMANN_JSON_VERSION_PATCH)},
      {"sleef", fmt::format("{}.{}.{}", SLEEF_VERSION_MAJOR, SLEEF_VERSION_MINOR, SLEEF_VERSION_PATCHLEVEL)},
      {"sqlite", ::sqlite3_libversion()},
      {"tinyxml2", std::string(build.tinyxml2)},
      {"xxhash", version_of(static_cast<int>(::XXH_versionNumber()))},
      {"processor", look_up("/proc/cpuinfo", "model name", ':')},
      {"cores", std::to_string(std::thread::hardware_concurrency())},
      {"host", system.nodename},
      {"system", look_up("/etc/os-release", "PRETTY_NAME", '=')},
      {"kernel", fmt::format("{} {} {}", system.sysname, system.release, system.machine)},
  };
}

void write_provenance(const std::filesystem::path& file, const Provenance& provenance) {
  const ExperimentConfig& experiment = provenance.plan->experiment;
  Json overrides = Json::object(), machine = Json::object(), inputs = Json::array();
  for (const Override& given : experiment.overrides) overrides[given.name] = given.value;
  for (const auto& [name, value] : environment()) machine[name] = value;
  for (const InputFile& input : provenance.plan->files)
    inputs.push_back({{"path", input.path}, {"hash", input.hash}});
  const Json json = {{"format", kProvenanceFormat},       {"experiment", experiment.name},
                     {"config", experiment.path},         {"command", provenance.command},
                     {"overrides", std::move(overrides)}, {"arguments", experiment.arguments},
                     {"seed", experiment.seed},           {"threads", provenance.threads},
                     {"started", provenance.started},     {"finished", provenance.finished},
                     {"outcome", provenance.outcome},     {"inputs", std::move(inputs)},
                     {"environment", std::move(machine)}};
  write_file(file, json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n');
}

std::string timestamp() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return timestamp(std::chrono::duration_cast<std::chrono::nanoseconds>(now).count());
}

std::string timestamp(std::int64_t since_1970_ns) {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  const std::int64_t ms = since_1970_ns % kSecond_ns / 1'000'000;
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z", fmt::gmtime(since_1970_ns / kSecond_ns), ms);
}

}  // namespace coppice
