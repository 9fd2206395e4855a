#include "engine/graph/compute.h"

#include <fmt/format.h>

#include <array>
#include <new>
#include <stdexcept>

#include "engine/graph/child.h"
#include "engine/graph/run_folder.h"
#include "registry/text.h"

namespace coppice {
namespace {

/// Copies the files of a folder to another one, in place of what was there.
void keep(const std::filesystem::path& from, const std::filesystem::path& to) {
  coppice::remove_all(to);
  make_folder(to);
  for (const auto& file : std::filesystem::directory_iterator(from)) {
    write_file(to / file.path().filename(), read_file(file.path()));
  }
}

}  // namespace

ResultRecord compute_node(const Plan& plan, std::size_t index, const std::filesystem::path& run_folder,
                          Store& store, TaskParallel& parallel,
                          const std::function<void(const RunningContext*)>& watch) {
  const PlannedNode& node = plan.nodes[index];
  const std::filesystem::path folder = store.begin(node.key);
  RunningContext context(plan, index, run_folder, folder, store, parallel);
  try {
    watch(&context);
    node.node->run(context);
    context.write_timing();
  } catch (const Unfinished& failure) {
    watch(nullptr);
    const std::filesystem::path kept = run_folder / kFailedFolder / node.folder;
    keep(folder, kept);
    store.abandon(folder);
    throw std::runtime_error(
        fmt::format("{}\nwhat it wrote until then is in {}", failure.what(), kept.string()));
  } catch (...) {
    watch(nullptr);
    store.abandon(folder);
    throw;
  }
  watch(nullptr);
  const WorkDone work = context.work();
  ResultRecord record;
  record.key = node.key;
  record.kind = node.kind;
  record.component = node.component;
  record.family = node.family;
  record.key_text = plan.key_text(index);
  record.wall_s = work.wall_s;
  record.cpu_s = work.cpu_s;
  return store.commit(folder, std::move(record));
}

namespace {

/// What the program said, without its name in front.
std::string last_words(const ChildEnd& end) {
  std::string_view text = trim(end.errors);
  const std::size_t error = text.find("error: ");
  if (error != std::string_view::npos) text.remove_prefix(error + std::string_view("error: ").size());
  return std::string(text);
}

}  // namespace

ResultRecord compute_in_process(const PlannedNode& node, const Limits& limits,
                                const std::filesystem::path& run_folder, const Store& store,
                                const ChildProgram& program, const std::atomic<bool>& stop) {
  const double limit = limits.time;
  double allowed = limit;
  const std::optional<Checkpoint> before = read_checkpoint(store.checkpoint(node.key));
  if (limit > 0 && before) allowed = std::max(limit - before->work.wall_s, 0.001);
  const ChildEnd end = run_child(program.runner,
                                 {"node", std::filesystem::absolute(run_folder).string(), node.key, "-j",
                                  std::to_string(program.threads), "--memory-limit",
                                  std::to_string(static_cast<std::uint64_t>(limits.memory))},
                                 allowed, stop);
  if (end.how == ChildEnd::How::interrupted) throw Interrupted();
  std::optional<ResultRecord> record = store.find(node.key);
  if (record) return std::move(*record);
  const std::string used =
      fmt::format("{:.3g} s of CPU time and {} of memory", end.cpu_s, memory_text(end.peak_memory));
  if (end.how == ChildEnd::How::out_of_time) {
    const double all = end.wall_s + (limit - allowed);
    throw std::runtime_error(
        fmt::format("stopped at its time_limit of {:g} s, after {:.3g} s; it used {}", limit, all, used));
  }
  if (end.how == ChildEnd::How::signalled) {
    throw std::runtime_error(fmt::format("killed by signal {}; it used {}", end.code, used));
  }
  const std::string words = last_words(end);
  throw std::runtime_error(words.empty() ? fmt::format("ended with status {}; it used {}", end.code, used)
                                         : words);
}

std::string memory_text(double bytes) {
  static constexpr std::array<const char*, 4> kUnits = {"kB", "MB", "GB", "TB"};
  double value = bytes / 1000;
  std::size_t unit = 0;
  for (; value >= 1000 && unit + 1 < kUnits.size(); ++unit) value /= 1000;
  return fmt::format("{:.3g} {}", value, kUnits[unit]);
}

std::string failure_text() {
  try {
    throw;
  } catch (const ConfigError& error) {
    std::string text;
    for (const Diagnostic& diagnostic : error.diagnostics()) {
      text += (text.empty() ? "" : "\n") + to_text(diagnostic);
    }
    return text;
  } catch (const std::length_error&) {  // more than any memory: no vector can be that long
    return "needs more memory than any machine has";
  } catch (const std::bad_alloc&) {
    return fmt::format("ran out of memory; the program used {} at most", memory_text(peak_memory()));
  } catch (const std::exception& error) {
    return error.what();
  } catch (...) {
    return "threw something that is no std::exception";
  }
}

}  // namespace coppice
