// Hot loops do not use the heap: steps of problems, actions of policies, predictions of functions.

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "engine/vocabulary/problem.h"
#include "tests/support/example.h"
#include "tests/support/make.h"

namespace {
std::atomic<std::size_t> allocations{0};
}

// Not inlined: g++ would see a free of what it takes for the library's new.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size > 0 ? size : 1)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++allocations;
  return std::malloc(size > 0 ? size : 1);
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace coppice {
namespace {

template <class Work>
std::size_t allocations_of(const Work& work) {
  const std::size_t before = allocations;
  work();
  return allocations - before;
}

const Draws kAllocationDraws(1, "allocation", 0);

class AllocationOfProblems : public testing::TestWithParam<std::string> {};

TEST_P(AllocationOfProblems, DoesNotGrowWithTheNumberOfSteps) {
  const Sub<Problem> problem = make_example<Problem>(GetParam());
  const Sub<Policy> policy = make_from_xml<Policy>("<random/>");
  policy.object->prepare(problem->spaces(), nullptr);
  Serial serial;
  const auto run = [&](int horizon) {
    Simulation simulation;
    simulation.policy = policy.object.get();
    simulation.rollouts = 50;
    simulation.horizon = horizon;
    return allocations_of([&] { problem->episodes(simulation, kAllocationDraws, serial); });
  };
  EXPECT_EQ(run(1), run(40));
}

INSTANTIATE_TEST_SUITE_P(All, AllocationOfProblems, testing::ValuesIn(Catalogue::instance().names("problem")),
                         component_name);

class AllocationOfPolicies : public testing::TestWithParam<std::string> {};

TEST_P(AllocationOfPolicies, IsNoneForAnAction) {
  const ComponentInfo& info = *Catalogue::instance().find("policy", GetParam());
  for (const SlotInfo& slot : info.slots) {
    if (slot.interface == "function") GTEST_SKIP() << "has no arrays yet; its functions are tested below";
  }
  const Sub<Problem> problem = make_from_xml<Problem>("<double_integrator/>");
  const Sub<Policy> policy = make_example<Policy>(GetParam());
  policy.object->prepare(problem->spaces(), problem->simulator());
  std::vector<double> state(2), memory(policy->memory_size());
  policy->reset(memory);
  Action action;
  EXPECT_EQ(allocations_of([&] {
              for (std::uint64_t i = 0; i < 100; ++i)
                policy->act(state, memory, kAllocationDraws.scenario(i), action);
            }),
            0u);
}

INSTANTIATE_TEST_SUITE_P(All, AllocationOfPolicies, testing::ValuesIn(Catalogue::instance().names("policy")),
                         component_name);

class AllocationOfApproximators : public testing::TestWithParam<std::string> {};

TEST_P(AllocationOfApproximators, IsNoneForAPrediction) {
  Matrix x(200, 3), y(200, 2);
  for (std::size_t i = 0; i < x.rows(); ++i) {
    for (std::uint32_t c = 0; c < 3; ++c) x(i, c) = kAllocationDraws.scenario(i).uniform("x", -1, 1, c);
    y(i, 0) = x(i, 0) * x(i, 1);
    y(i, 1) = x(i, 2);
  }
  Serial serial;
  const MadeFunction function =
      make_example<Approximator>(GetParam())->fit({x, y, {}}, kAllocationDraws, serial);
  std::vector<double> in(3), out(2);
  EXPECT_EQ(allocations_of([&] {
              for (std::size_t i = 0; i < x.rows(); ++i) {
                x.row(i, in);
                function->predict(in, out);
              }
            }),
            0u);
}

INSTANTIATE_TEST_SUITE_P(All, AllocationOfApproximators,
                         testing::ValuesIn(Catalogue::instance().names("approximator")), component_name);

}  // namespace
}  // namespace coppice
