#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <memory>

#include "engine/vocabulary/solver.h"
#include "tests/support/make.h"

namespace coppice::testing {

/// A walk along the places 0, 1, 2 to the exit at 3: each step costs 1, the exit is worth 10 and ends the
/// episode. An action moves by at most one place; discount 0.9. By hand: the best values are 10 at place 2,
/// -1 + 0.9 * 10 = 8 at 1 and -1 + 0.9 * 8 = 6.2 at 0.
struct Corridor {
  double discount = 0.9;
  int horizon = 20;

  using State = Vec<1>;
  Space states() const { return {{"place", "", 0, 3}}; }
  std::vector<ActionBox> actions() const { return {{"walk", {{"by", "", -1, 1}}}}; }
  State start(const Draws&) const { return {0.0}; }
  Transition<State> step(const State& state, ActionRef action, const Draws&) const {
    const double place = std::clamp(state[0] + action[0], 0.0, 3.0);
    const bool exit = place >= 3;
    return {.next = {place}, .reward = exit ? 10.0 : -1.0, .terminal = exit};
  }
};

inline std::shared_ptr<const Problem> corridor() {
  return std::make_shared<ModelProblem<Corridor>>(Corridor{}, "corridor");
}

/// Each of the moves -1, 0, 1 once in each place: a tree that is grown to the end is a table of values.
inline Dataset all_moves() {
  const auto problem = corridor();
  Dataset samples(problem->spaces(), 9);
  for (std::size_t i = 0; i < 9; ++i) {
    const double place = static_cast<double>(i / 3), by = static_cast<double>(i % 3) - 1;
    samples.states(i, 0) = place;
    samples.set_action(i, {0, {by}});
    bool terminal = false;
    std::array<double, 1> next{};
    problem->simulator()->step({&place, 1}, {0, {by}}, Draws(1, "", 0), next, samples.reward[i], terminal);
    // After the end a place of value that must not count.
    samples.next(i, 0) = terminal ? 2 : next[0];
    samples.terminal[i] = terminal ? 1 : 0;
  }
  return samples;
}

/// Q after some iterations of dynamic programming from 0, with targets below `least` raised to it.
class QTable {
 public:
  QTable(int iterations, double discount, double least = -1e300) {
    for (int n = 0; n < iterations; ++n) {
      std::array<double, 3> best{};
      for (int p = 0; p < 3 && n > 0; ++p) best[p] = *std::max_element(q_[p].begin(), q_[p].end());
      for (int p = 0; p < 3; ++p) {
        for (int by = -1; by <= 1; ++by) {
          const int next = std::max(p + by, 0);
          const double q = next == 3 ? 10.0 : -1 + discount * best[next];
          q_[p][by + 1] = std::max(q, least);
        }
      }
    }
  }
  double operator()(int place, int by) const { return q_[place][by + 1]; }

 private:
  std::array<std::array<double, 3>, 3> q_{};
};

inline double value_at(const Function& function, double place, double by) {
  double value = 0;
  function.predict(std::array{place, by}, {&value, 1});
  return value;
}

/// Makes and runs a solver's training on the corridor.
struct Lesson {
  std::shared_ptr<const Problem> problem = corridor();
  Dataset samples = all_moves();
  MadeFunction value{};
  Draws draws{2017, "corridor", 0};

  TrainingInputs inputs() const {
    TrainingInputs inputs;
    inputs.problem = problem.get();
    inputs.samples = &samples;
    inputs.value = value;
    inputs.draws = draws;
    return inputs;
  }
  TrainingResult learn(const std::string& xml) const {
    const Sub<Solver> solver = make_from_xml<Solver>(xml);
    const TrainingInputs given = inputs();
    const std::unique_ptr<Training> training = solver->start(given);
    Serial serial;
    while (training->advance(serial)) {
    }
    return training->result();
  }
  /// The text of the std::invalid_argument that start throws; "" when it does not.
  std::string refusal(const std::string& xml) const {
    const Sub<Solver> solver = make_from_xml<Solver>(xml);
    try {
      const TrainingInputs given = inputs();
      solver->start(given);
    } catch (const std::invalid_argument& refused) {
      return refused.what();
    }
    return "";
  }
};

template <class Made>
std::string bytes_of(const Made& made) {
  Archive archive;
  made->save(archive);
  return archive.bytes();
}

/// Learns with a restart after each unit of work in turn: results and progress must be those of a training
/// that was never interrupted.
inline void expect_resumable(const Lesson& lesson, const std::string& xml, std::size_t expected_units) {
  const Sub<Solver> solver = make_from_xml<Solver>(xml);
  const TrainingInputs inputs = lesson.inputs();
  Serial serial;
  std::string policy, value;
  std::vector<std::vector<std::pair<std::string, double>>> measures;
  for (std::size_t restart = 0; restart <= expected_units; ++restart) {  // the first has none
    std::unique_ptr<Training> training = solver->start(inputs);
    std::size_t units = 0;
    for (bool more = true; more; ++units) {
      if (restart > 0 && units == restart - 1) {
        Archive checkpoint;
        training->save(checkpoint);
        checkpoint = Archive::from_bytes(checkpoint.bytes());
        training = solver->start(inputs);
        training->load(checkpoint);
        EXPECT_EQ(training->progress().done, static_cast<std::int64_t>(units));
      }
      more = training->advance(serial);
      EXPECT_EQ(training->progress().done, static_cast<std::int64_t>(units + 1));
      EXPECT_EQ(training->progress().total, static_cast<std::int64_t>(expected_units));
      if (restart == 0) measures.push_back(training->progress().measures);
      EXPECT_EQ(training->progress().measures, measures.at(units)) << "restart before unit " << restart;
    }
    EXPECT_EQ(units, expected_units);
    EXPECT_FALSE(training->advance(serial)) << "nothing is left to do";
    const TrainingResult result = training->result();
    if (restart == 0) policy = bytes_of(result.policy), value = bytes_of(result.value);
    EXPECT_EQ(bytes_of(result.policy), policy) << "restart before unit " << restart;
    EXPECT_EQ(bytes_of(result.value), value) << "restart before unit " << restart;
  }
}

}  // namespace coppice::testing
