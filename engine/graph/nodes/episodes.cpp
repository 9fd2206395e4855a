#include "engine/graph/nodes/episodes.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace coppice {
namespace {

/// Passes episodes on under their scenario's number: batches count their rollouts from 0.
class ByScenario : public Recorder {
 public:
  explicit ByScenario(Recorder& recorder) : recorder_(recorder) {}
  void episode(std::size_t, std::uint64_t scenario, const Episode& episode) override {
    recorder_.episode(scenario, scenario, episode);
  }

 private:
  Recorder& recorder_;
};

template <class V>
void append(std::vector<V>& all, const std::vector<V>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

}  // namespace

void CheckpointClock::save(NodeContext& context, const Archive& archive) {
  const Clock::time_point begin = Clock::now();
  context.save_checkpoint(archive);
  last_ = Clock::now();
  pause_ = std::max<Clock::duration>(std::chrono::seconds(5), 20 * (last_ - begin));
}

EpisodeRun::EpisodeRun(const Problem& problem, const Simulation& simulation, NodeContext& context,
                       bool resumable)
    : problem_(problem), simulation_(simulation), context_(context), resumable_(resumable) {
  // Too many episodes fail now, not when all memory is full; what is not yet used costs nothing.
  returns_.total.reserve(simulation_.rollouts);
  returns_.discounted.reserve(simulation_.rollouts);
  returns_.steps.reserve(simulation_.rollouts);
  returns_.terminal.reserve(simulation_.rollouts);
  if (!resumable_) return;
  if (std::optional<Archive> saved = context_.checkpoint()) restore(std::move(*saved));
}

/// A checkpoint that cannot be read is no loss but of time.
void EpisodeRun::restore(Archive archive) try {
  const auto& total = archive.get<std::vector<double>>("total");
  const auto& discounted = archive.get<std::vector<double>>("discounted");
  const auto& steps = archive.get<std::vector<std::int32_t>>("steps");
  const auto& terminal = archive.get<std::vector<std::uint8_t>>("terminal");
  const std::size_t n = total.size();
  const bool whole = discounted.size() == n && steps.size() == n && terminal.size() == n;
  if (!whole || n > simulation_.rollouts) return;
  append(returns_.total, total);
  append(returns_.discounted, discounted);
  append(returns_.steps, steps);
  append(returns_.terminal, terminal);
} catch (const std::runtime_error&) {
}

Archive EpisodeRun::state() const {
  Archive archive;
  archive.put("total", returns_.total);
  archive.put("discounted", returns_.discounted);
  archive.put("steps", returns_.steps);
  archive.put("terminal", returns_.terminal);
  return archive;
}

void EpisodeRun::advance(std::size_t episodes, Parallel& parallel, Recorder* recorder) {
  std::optional<ByScenario> by_scenario;
  if (recorder != nullptr) by_scenario.emplace(*recorder);
  Simulation batch = simulation_;
  batch.first_scenario = done();
  batch.rollouts = std::min(episodes, simulation_.rollouts - done());
  batch.recorder = by_scenario ? &*by_scenario : nullptr;
  const Returns made = problem_.episodes(batch, context_.draws(), parallel);
  append(returns_.total, made.total);
  append(returns_.discounted, made.discounted);
  append(returns_.steps, made.steps);
  append(returns_.terminal, made.terminal);
  context_.progress(static_cast<std::int64_t>(done()), static_cast<std::int64_t>(simulation_.rollouts));
}

void EpisodeRun::finish() {
  CheckpointClock clock;
  std::size_t batch = context_.parallel().width();
  while (done() < simulation_.rollouts) {
    const bool stop = context_.parallel().stop_requested();
    if (resumable_ && (stop || clock.due())) clock.save(context_, state());
    if (stop) throw Interrupted();
    const auto begin = std::chrono::steady_clock::now();
    advance(batch, context_.parallel(), simulation_.recorder);
    if (std::chrono::steady_clock::now() - begin < std::chrono::milliseconds(200)) batch *= 2;
  }
}

void require_other_draws(const InputNode& policy, const NodeContext& judge) {
  if (std::find(policy.streams.begin(), policy.streams.end(), judge.stream()) == policy.streams.end()) return;
  throw std::invalid_argument(
      fmt::format("policy '{}' was made with the very draws ({}) that would judge it; give this node a "
                  "seed_label of its own",
                  policy.id, judge.stream()));
}

}  // namespace coppice
