// A short trace of each problem.

#include <gtest/gtest.h>

#include "engine/vocabulary/problem.h"
#include "tests/support/golden.h"
#include "tests/support/temporary_folder.h"

namespace coppice {
namespace {

/// Three episodes of random actions.
Table trace(const Problem& problem) {
  const Sub<Policy> policy = make_from_xml<Policy>("<random/>");
  policy.object->prepare(problem.spaces(), nullptr);
  DatasetRecorder recorder(problem.spaces(), 3);
  Simulation simulation;
  simulation.policy = policy.object.get();
  simulation.rollouts = 3;
  simulation.horizon = 12;
  simulation.recorder = &recorder;
  Serial serial;
  problem.episodes(simulation, Draws(2017, "golden", 0), serial);
  const TemporaryFolder folder;
  write_dataset(folder / "trace.csv", recorder.dataset());
  return read_table(folder / "trace.csv");
}

class ProblemGoldens : public testing::TestWithParam<std::string> {};

TEST_P(ProblemGoldens, TraceIsTheRecordedOne) {
  const Sub<Problem> problem = make_for_golden<Problem>(GetParam());
  expect_golden("problem", GetParam(), trace(*problem), versions_of(problem));
}

INSTANTIATE_TEST_SUITE_P(All, ProblemGoldens, testing::ValuesIn(Catalogue::instance().names("problem")),
                         component_name);

}  // namespace
}  // namespace coppice
