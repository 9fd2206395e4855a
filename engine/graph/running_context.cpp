#include "engine/graph/running_context.h"

#include "engine/data/csv.h"
#include "engine/data/file_system.h"

namespace coppice {

RunningContext::RunningContext(const Plan& plan, std::size_t node, const std::filesystem::path& run_folder,
                               std::filesystem::path folder, std::filesystem::path checkpoint,
                               TaskParallel& parallel)
    : PlannedContext(plan, node, run_folder),
      folder_(std::move(folder)),
      checkpoint_(std::move(checkpoint)),
      parallel_(parallel),
      start_(std::chrono::steady_clock::now()) {}

void RunningContext::count(std::string_view what, std::int64_t amount) {
  const std::lock_guard<std::mutex> guard(mutex_);
  const auto [known, is_new] = counts_.try_emplace(std::string(what), amount);
  if (!is_new) known->second += amount;
}

void RunningContext::measure(std::string_view what, double value) {
  const std::lock_guard<std::mutex> guard(mutex_);
  measures_.insert_or_assign(std::string(what), value);
}

void RunningContext::progress(std::int64_t done, std::int64_t total) {
  done_ = done;
  total_ = total;
}

std::optional<Archive> RunningContext::checkpoint() {
  std::optional<Checkpoint> found = read_checkpoint(checkpoint_);
  if (!found) return std::nullopt;
  before_ = std::move(found->work);
  return std::move(found->state);
}

void RunningContext::save_checkpoint(const Archive& archive) {
  write_checkpoint(checkpoint_, {work(), archive});
}

WorkDone RunningContext::work() const {
  WorkDone work = before_;
  work.wall_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  work.cpu_s += parallel_.cpu_s();
  const std::lock_guard<std::mutex> guard(mutex_);
  for (const auto& [name, amount] : counts_) work.counts[name] += amount;
  return work;
}

void RunningContext::write_timing() const {
  const WorkDone done = work();
  std::string names;
  std::string values;
  const auto add = [&](const std::string& name, double value) {
    append_csv(names += names.empty() ? "" : ",", name);
    append_csv(values += values.empty() ? "" : ",", value);
  };
  add("wall_s", done.wall_s);
  add("cpu_s", done.cpu_s);
  for (const auto& [name, amount] : done.counts) add(name, static_cast<double>(amount));
  for (const auto& [name, amount] : done.counts)
    add(name + "_per_s", static_cast<double>(amount) / done.wall_s);
  const std::lock_guard<std::mutex> guard(mutex_);
  for (const auto& [name, value] : measures_) add(name, value);
  write_file(folder_ / "timing.csv", names + "\n" + values + "\n");
}

}  // namespace coppice
