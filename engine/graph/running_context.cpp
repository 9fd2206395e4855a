#include "engine/graph/running_context.h"

#include <fmt/format.h>

#include "engine/data/table_file.h"

namespace coppice {

RunningContext::RunningContext(const Plan& plan, std::size_t node, const std::filesystem::path& run_folder,
                               std::filesystem::path folder, Store& store, TaskParallel& parallel)
    : PlannedContext(plan, node, run_folder),
      folder_(std::move(folder)),
      store_(store),
      key_(plan.nodes[node].key),
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
  std::optional<Checkpoint> found = read_checkpoint(store_.checkpoint(key_));
  if (!found) return std::nullopt;
  before_ = std::move(found->work);
  return std::move(found->state);
}

void RunningContext::save_checkpoint(const Archive& archive) {
  store_.save_checkpoint(key_, checkpoint_bytes({work(), archive}));
}

WorkDone RunningContext::work() const {
  WorkDone work = before_;
  work.wall_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  work.cpu_s += parallel_.cpu_s();
  const std::lock_guard<std::mutex> guard(mutex_);
  for (const auto& [name, amount] : counts_) work.counts[name] += amount;
  for (const auto& [name, value] : measures_) work.measures[name] = value;
  return work;
}

void RunningContext::write_timing() const {
  using Type = ColumnInfo::Type;
  const WorkDone done = work();
  Table table;
  table.reproducible = false;
  std::vector<Cell> row;
  const auto add = [&](std::string name, Type type, std::string unit, Cell value, std::string doc) {
    table.columns.push_back({std::move(name), type, std::move(unit), std::move(doc)});
    row.push_back(std::move(value));
  };
  add("wall_s", Type::number, "s", done.wall_s, "Wall time of the node.");
  add("cpu_s", Type::number, "s", done.cpu_s, "CPU time of the node, of all its threads.");
  for (const auto& [name, amount] : done.counts)
    add(name, Type::integer, "", amount, fmt::format("Number of {}.", name));
  for (const auto& [name, amount] : done.counts) {
    add(name + "_per_s", Type::number, "1/s", static_cast<double>(amount) / done.wall_s,
        fmt::format("Number of {} divided by wall_s.", name));
  }
  for (const auto& [name, value] : done.measures)
    add(name + "_s", Type::number, "s", value, fmt::format("CPU time of one {}.", name));
  table.rows.push_back(std::move(row));
  write_table(folder_ / kTimingFile, table);
}

}  // namespace coppice
