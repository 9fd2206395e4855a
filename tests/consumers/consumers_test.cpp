// Exports read by programs that make test does not need: a compiler and an emulator for another processor,
// Graphviz, ONNX Runtime and Node.js.

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/header_program.h"

namespace coppice {
namespace {

namespace fs = std::filesystem;

bool installed(const std::string& program) {
  return shell("command -v " + program).status == 0;
}

/// Its compilers fuse multiplications and additions unless told otherwise: nothing tells them here.
TEST(Header, ActsAsThePolicyOnAarch64) {
  ASSERT_TRUE(installed("aarch64-linux-gnu-g++") && installed("qemu-aarch64"))
      << "scripts/install_packages.sh test-all";
  for (const TestPolicy& policy : test_policies())
    expect_same_actions(policy, "aarch64-linux-gnu-g++ -static -O3", "qemu-aarch64", 100'000);
}

TEST(Header, CompilesWithClang) {
  ASSERT_TRUE(installed("clang++")) << "scripts/install_packages.sh test-all";
  for (const TestPolicy& policy : test_policies())
    expect_same_actions(policy, "clang++ -O3 -march=native -ffp-contract=fast", "", 10'000);
}

TEST(DotExport, IsDrawnByGraphviz) {
  ASSERT_TRUE(installed("dot")) << "scripts/install_packages.sh test-all";
  std::vector<TestPolicy> policies = test_policies();
  policies.push_back(configured("names", "<constant/>"));
  policies.back().file.spaces.actions[0].axes[0].name = "\"\\<b>\n";
  for (const TestPolicy& policy : policies) {
    const TemporaryFolder folder;
    folder.write("policy.dot", exported(policy, "dot"));
    const Ended drawn = shell("dot -Tsvg policy.dot", folder.path());
    EXPECT_EQ(drawn.status, 0) << policy.name << drawn.err;
    EXPECT_FALSE(contains(drawn.err, "Error") || contains(drawn.err, "syntax")) << drawn.err;
    EXPECT_TRUE(contains(drawn.out, "<polygon")) << policy.name;
  }
}

template <class T>
std::string bytes(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

/// ONNX files in ONNX Runtime, JSON files in Node.js; what they have to say lies beside them.
TEST(Exports, AreTheSamePolicyInOnnxRuntimeAndNode) {
  ASSERT_TRUE(installed("node") && installed("npm")) << "scripts/install_packages.sh test-all";
  const TemporaryFolder folder;
  for (const TestPolicy& policy : test_policies()) {
    std::vector<double> states = test_states(policy, 5'000);
    std::vector<float> singles;
    for (double& state : states) {
      if (std::fabs(state) > 1e6) state = 0.5;  // sums that overflow in single precision only
      singles.push_back(static_cast<float>(state));
      state = static_cast<double>(singles.back());
    }
    folder.write(policy.name + ".json", exported(policy, "json"));
    folder.write(policy.name + ".states", bytes(singles));
    folder.write(policy.name + ".actions", bytes(actions_of(policy, states)));
    if (!policy.name.starts_with("trimmed") && !policy.name.starts_with("oblique"))
      folder.write(policy.name + ".onnx", exported(policy, "onnx"));
  }
  const fs::path work = fs::path(runner_program()).parent_path() / "onnx";
  const Ended checked = shell("'" + (source_folder() / "tests/onnx/onnx_test.sh").string() + "' '" +
                              folder.path().string() + "' '" + work.string() + "'");
  EXPECT_EQ(checked.status, 0) << checked.out << checked.err;
  EXPECT_TRUE(contains(checked.out, "13 in Node.js, 8 in ONNX Runtime")) << checked.out;
}

}  // namespace
}  // namespace coppice
