#pragma once

#include <gtest/gtest.h>

#include <cstring>

#include "tests/cli/process.h"
#include "tests/support/exported.h"

namespace coppice {

/// Warnings that users may have switched on.
inline const std::string kHeaderWarnings =
    " -std=c++17 -Wall -Wextra -Werror -Wpedantic -Wshadow -Wconversion";

/// Compiles tests/exports/consumer.cpp with the exported header of the policy and compares its actions with
/// the policy's, bit for bit. `compile` is a compiler with options, `run` what stands before the program's
/// name.
inline void expect_same_actions(const TestPolicy& policy, const std::string& compile, const std::string& run,
                                std::size_t states_count) {
  SCOPED_TRACE(policy.name + ": " + compile);
  const TemporaryFolder folder;
  folder.write(policy.name + ".h", exported(policy, "cpp"));
  const Ended compiled = shell(compile + kHeaderWarnings + " -DPOLICY=" + policy.name + " '-DHEADER=\"" +
                                   (folder / (policy.name + ".h")).string() + "\"' -o consumer '" +
                                   (source_folder() / "tests/exports/consumer.cpp").string() + "'",
                               folder.path());
  ASSERT_EQ(compiled.status, 0) << compiled.err.substr(0, 3000);
  EXPECT_EQ(compiled.err, "");
  const std::vector<double> states = test_states(policy, states_count);
  const std::vector<double> expected = actions_of(policy, states);
  const Ended ended = shell(run + " ./consumer", folder.path(), bytes_of(states));
  ASSERT_EQ(ended.status, 0) << ended.err;
  ASSERT_EQ(ended.out.size(), expected.size() * sizeof(double));
  for (std::size_t i = 0; i < expected.size(); ++i) {
    double action = 0;
    std::memcpy(&action, ended.out.data() + i * sizeof action, sizeof action);
    ASSERT_EQ(std::bit_cast<std::uint64_t>(action), std::bit_cast<std::uint64_t>(expected[i]))
        << "state " << i / policy.outputs() << ", parameter " << i % policy.outputs() << ": " << action
        << " for " << expected[i];
  }
}

}  // namespace coppice
