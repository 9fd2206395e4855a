// Every component whose behaviour can be recorded has a golden, and every golden a component.

#include <gtest/gtest-spi.h>
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "tests/support/golden.h"
#include "tests/support/temporary_folder.h"

namespace coppice {
namespace {

bool is_recorded(const std::string& interface) {
  return interface != "node" && interface != "report" && interface != "exporter";  // have tests of their own
}

TEST(Goldens, EveryComponentHasOne) {
  if (std::getenv("COPPICE_UPDATE_GOLDENS") != nullptr) GTEST_SKIP() << "they are being written";
  for (const std::string& interface : Catalogue::instance().interfaces()) {
    if (!is_recorded(interface)) continue;
    for (const std::string& name : Catalogue::instance().names(interface)) {
      EXPECT_TRUE(std::filesystem::exists(golden_folder(interface) / (name + ".csv")))
          << interface << " <" << name << "> has no golden; COPPICE_UPDATE_GOLDENS=1 build/test_conformance "
          << "writes it (for a new interface, add a test that records it)";
    }
  }
}

/// What ForestGoldens records besides (learning_goldens_test.cpp).
const std::set<std::string> kOfForests = {"extra_trees.oblique", "forest.ascent"};

TEST(Goldens, AreOfComponentsOnly) {
  std::map<std::filesystem::path, std::string> folders;
  for (const std::string& interface : Catalogue::instance().interfaces()) {
    folders[golden_folder(interface)] = interface;
  }
  for (const auto& folder : std::filesystem::directory_iterator(golden_folder("problem").parent_path())) {
    ASSERT_TRUE(folders.contains(folder.path())) << folder.path() << " belongs to no interface";
    for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
      const std::filesystem::path kind = entry.path().extension();
      EXPECT_TRUE(kind == ".csv" || kind == ".xml") << entry.path();
      const std::string name = entry.path().stem().string();
      if (kOfForests.contains(name)) continue;
      EXPECT_NE(Catalogue::instance().find(folders[folder.path()], name), nullptr) << entry.path();
    }
  }
}

Table values(double value) {
  NamedValues values;
  values.add("value", value);
  return values.table();
}

/// Compares, or with `update` writes, in a folder of its own; the text of the failure, "" for none.
class Comparison {
 public:
  Comparison() { ::setenv("COPPICE_GOLDEN_DIR", folder_.path().c_str(), 1); }
  ~Comparison() {
    restore("COPPICE_GOLDEN_DIR", given_folder_);
    restore("COPPICE_UPDATE_GOLDENS", given_update_);
  }
  std::string operator()(double value, const std::string& versions, bool update) const {
    update ? ::setenv("COPPICE_UPDATE_GOLDENS", "1", 1) : ::unsetenv("COPPICE_UPDATE_GOLDENS");
    testing::TestPartResultArray results;
    {
      const testing::ScopedFakeTestPartResultReporter reporter(
          testing::ScopedFakeTestPartResultReporter::INTERCEPT_ONLY_CURRENT_THREAD, &results);
      expect_golden("thing", "example", values(value), versions);
    }
    return results.size() == 0 ? "" : results.GetTestPartResult(0).message();
  }

 private:
  static std::string given(const char* name) {
    const char* value = std::getenv(name);
    return value == nullptr ? "" : value;
  }
  static void restore(const char* name, const std::string& value) {
    value.empty() ? ::unsetenv(name) : ::setenv(name, value.c_str(), 1);
  }
  TemporaryFolder folder_;
  std::string given_folder_ = given("COPPICE_GOLDEN_DIR"), given_update_ = given("COPPICE_UPDATE_GOLDENS");
};

TEST(Goldens, ChangeOnlyWithTheVersion) {
  const auto says = [](const std::string& failure, const std::string& part) {
    return failure.find(part) != std::string::npos;
  };
  const Comparison compare;
  EXPECT_TRUE(says(compare(1, "1", false), "COPPICE_UPDATE_GOLDENS=1 build/test_conformance writes it"));
  EXPECT_EQ(compare(1, "1", true), "");
  EXPECT_EQ(compare(1 + 1e-12, "1", false), "") << "within the tolerance";
  EXPECT_TRUE(says(compare(2, "1", false), "row 1: value was 1, is 2"));
  EXPECT_TRUE(says(compare(2, "1", true), "raise the component's version"));
  EXPECT_TRUE(says(compare(1, "1; part 2", false), "of version 1, the component of 1; part 2"));
  EXPECT_EQ(compare(2, "1; part 2", true), "") << "a raised version allows it";
  EXPECT_EQ(compare(2, "1; part 2", false), "");
  EXPECT_TRUE(says(compare(1, "1; part 2", false), "value was 2, is 1"));
}

}  // namespace
}  // namespace coppice
