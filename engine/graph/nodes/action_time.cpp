#include "engine/graph/nodes/action_time.h"

#include <ctime>
#include <vector>

#include "engine/statistics/estimates.h"

namespace coppice {
namespace {

constexpr int kRounds = 5;
constexpr double kRound = 2e-4;  // s

}  // namespace

double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double action_time(const Policy& policy, std::span<const double> states, std::size_t state_size,
                   const Draws& draws) {
  const std::size_t steps = states.size() / state_size - 1;  // no action was taken in the last state
  std::vector<double> memory(policy.memory_size());
  Action action;
  std::vector<double> rounds;
  std::size_t step = 0;
  for (int round = 0; round < kRounds; ++round) {
    const double begin = thread_seconds();
    double passed = 0;
    int actions = 0;
    for (int block = 1; passed < kRound; block *= 2) {
      for (int i = 0; i < block; ++i, step = (step + 1) % steps) {
        if (step == 0) policy.reset(memory);
        policy.act(states.subspan(step * state_size, state_size), memory,
                   draws.step(static_cast<std::uint32_t>(step)), action);
      }
      actions += block;
      passed = thread_seconds() - begin;
    }
    rounds.push_back(passed / actions);
    if (passed > kRounds * kRound) break;  // a slow policy: one round is enough
  }
  return median(rounds);
}

}  // namespace coppice
