#include <gtest/gtest.h>

#include <set>
#include <sstream>

#include "tests/support/header_program.h"

namespace coppice {
namespace {

TEST(Header, ActsAsThePolicyToTheBit) {
  for (const TestPolicy& policy : test_policies())
    expect_same_actions(policy, compiler_program() + " -O2", "", 100'000);
}

/// Fused multiply-adds, where the processor has them, and no optimization.
TEST(Header, KeepsItsBitsWhateverTheCompilerIsAllowed) {
  for (const TestPolicy& policy : test_policies()) {
    if (policy.name != "pwl" && policy.name != "linear") continue;
    expect_same_actions(policy, compiler_program() + " -O3 -march=native -ffp-contract=fast", "", 100'000);
    expect_same_actions(policy, compiler_program() + " -O0", "", 10'000);
  }
}

/// 2000 constant leaves: less than 64 KiB, and no call but of what never allocates.
TEST(Header, IsSmallAndCallsNoAllocation) {
  TestPolicy policy = fitted("small", "<extra_trees trees=\"25\" n_min=\"19\"/>", 1000);
  const MadePolicy made = make_policy(policy.file);
  made.object->prepare(policy.file.spaces, nullptr);
  std::size_t leaves = 0;
  const PolicyModel model = made->exported();
  for (const auto& output : std::get<ForestModel>(model.function).outputs) {
    for (const ForestModel::Tree& tree : output.trees) leaves += tree.leaves();
  }
  ASSERT_GE(leaves, 2000U);
  const TemporaryFolder folder;
  folder.write("small.h", exported(policy, "cpp"));
  folder.write("robot.cpp",
               "#include \"small.h\"\nvoid robot(const double*, double*);\n"
               "void robot(const double* s, double* a) { small::act(s, a); }\n");
  const Ended built = shell(
      compiler_program() + kHeaderWarnings + " -O2 -c robot.cpp && size robot.o | tail -1 && nm -u robot.o",
      folder.path());
  ASSERT_EQ(built.status, 0) << built.err;
  const std::vector<std::string> rows = lines(built.out);
  std::istringstream sizes(rows.at(0));
  std::size_t text = 0, data = 0, bss = 0;
  sizes >> text >> data >> bss;
  EXPECT_GT(text + data + bss, 8 * leaves);
  EXPECT_LT(text + data + bss, 64U * 1024) << leaves << " leaves";
  const std::set<std::string> allowed = {"floor",
                                         "memcpy",
                                         "memset",
                                         "memmove",
                                         "_GLOBAL_OFFSET_TABLE_",
                                         "__gxx_personality_v0"};  // the last is clang's, and not called
  for (std::size_t i = 1; i < rows.size(); ++i)
    EXPECT_TRUE(allowed.contains(rows[i].substr(rows[i].rfind(' ') + 1))) << rows[i];
  RecordProperty("bytes", static_cast<int>(text + data + bss));
}

TEST(Header, SaysWhatItIs) {
  const std::string header = exported(test_policies().front(), "cpp");
  for (const std::string part :
       {"coppice test", "0123456789abcdef", "namespace pwc", "double position = 0;  ///< m, from -1 to 1",
        "double double_ = 0;  ///< from -inf to inf", "double tilt_angle = 0;  ///< rad", "circular",
        "double forward = 0;  ///< m/s, from -0.5 to 0.75", "action 0 (walk)"}) {
    EXPECT_TRUE(contains(header, part)) << part;
  }
}

TEST(Header, RefusesFastMath) {
  const TemporaryFolder folder;
  folder.write("p.h", exported(test_policies().back(), "cpp"));
  const Ended built =
      shell(compiler_program() + " -std=c++17 -ffast-math -fsyntax-only -x c++ p.h", folder.path());
  EXPECT_NE(built.status, 0);
  EXPECT_TRUE(contains(built.err, "without -ffast-math")) << built.err;
}

/// Names that are none in C++, and texts that would break out of comments and literals.
TEST(Header, TakesAnyAxisName) {
  TestPolicy policy = configured("names", "<constant/>");
  policy.file.provenance = "a\\";
  policy.file.writer = "a\nint broken;\\";
  policy.file.spaces = {{{"1st", "\"m\\", 0, 1},
                         {"1st!", "", 0, 1},
                         {"1st?", "", 0, 1},
                         {"", "", 0, 0},
                         {"act", "", 0, 0},
                         {"m\xc3\xa9", "", 0, 1}},
                        {{"go\n*/", {{"class", "", 0, 1}, {"class_", "", 0, 1}, {"act", "", -1, -0.5}}}}};
  policy.file.spaces.states[3].name = "__";
  expect_same_actions(policy, compiler_program(), "", 100);
  policy.file.spaces.actions[0].axes.clear();
  const TemporaryFolder folder;
  folder.write("names.h", exported(policy, "cpp"));
  folder.write("robot.cpp", "#include \"names.h\"\nint main() { (void)names::act(names::State()); }\n");
  const Ended built = shell(compiler_program() + kHeaderWarnings + " robot.cpp", folder.path());
  EXPECT_EQ(built.status, 0) << built.err;
}

}  // namespace
}  // namespace coppice
