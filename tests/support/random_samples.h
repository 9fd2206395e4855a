#pragma once

#include "engine/vocabulary/solver.h"
#include "tests/support/make.h"

namespace coppice {

/// Transitions of random actions on the double integrator, for solvers to learn from.
struct RandomSamples {
  Sub<Problem> problem = make_from_xml<Problem>("<double_integrator/>");
  Sub<Policy> policy = make_from_xml<Policy>("<random/>");
  Dataset dataset;
  Draws draws;

  explicit RandomSamples(const Draws& given) : draws(given) {
    policy.object->prepare(problem->spaces(), nullptr);
    DatasetRecorder recorder(problem->spaces(), 15);
    Simulation simulation;
    simulation.policy = policy.object.get();
    simulation.rollouts = 15;
    simulation.horizon = 20;
    simulation.recorder = &recorder;
    Serial serial;
    problem->episodes(simulation, draws, serial);
    dataset = recorder.dataset();
  }
  TrainingInputs inputs() const {
    TrainingInputs inputs;
    inputs.problem = problem.object.get();
    inputs.samples = &dataset;
    inputs.draws = draws;
    return inputs;
  }
};

}  // namespace coppice
