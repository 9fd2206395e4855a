#include <gtest/gtest.h>

#include <filesystem>
#include <ostream>

#include "tests/cli/runs.h"
#include "tests/support/places.h"

namespace coppice {
namespace {

namespace fs = std::filesystem;

/// A shipped config, made small by arguments. (The thesis's take longer: tests/chaos/kill_test.sh has one.)
struct Shipped {
  std::string file;       ///< below configs/
  std::string arguments;  ///< besides the file's own
  std::string name;       ///< of the experiment
};

void PrintTo(const Shipped& shipped, std::ostream* out) {
  *out << shipped.file;
}

class Bytes : public RunsInAFolder, public testing::WithParamInterface<Shipped> {
 protected:
  static std::string command() {
    return (source_folder() / "configs" / GetParam().file).string() + " " + GetParam().arguments;
  }
  void calm(const std::string& options) const {
    const Ended ended = run(command() + " --progress none " + options);
    ASSERT_EQ(ended.status, 0) << ended.err;
  }
  /// What must be reproducible: policies, searches and tables.
  std::map<std::string, std::string> reproducible(const std::string& out) const {
    const auto files = results(folder_ / out / GetParam().name);
    std::size_t found = 0;
    for (const auto& [name, bytes] : files) {
      found += name.ends_with(".policy") || name.ends_with("/search.csv") ? 1 : 0;
    }
    EXPECT_GE(found, 1U);
    return files;
  }
};

TEST_P(Bytes, DependNeitherOnThreadsNorOnTheFolder) {
  calm("-j 1 --out one");
  calm("-j 2 --out elsewhere/two");
  const auto one = reproducible("one");
  EXPECT_GE(one.size(), 10U);
  EXPECT_EQ(one, reproducible("elsewhere/two"));
}

TEST_P(Bytes, DependOnTheSeed) {  // else the other tests would compare nothing
  calm("--out one");
  calm("--out two --seed 123");
  EXPECT_NE(reproducible("one"), reproducible("two"));
}

TEST_P(Bytes, SurviveKills) {
  calm("-j 2 --out calm");
  // Each attempt gets somewhat more time than the one before.
  const Ended ended = script(
      "kills=0; for wait in 0.03 0.06 0.1 0.15 0.2 0.25 0.3 0.4 0.5 0.6; do\n"
      "$RUNNER " +
      command() +
      " -j 2 --out killed --progress none & pid=$!\n"
      "sleep $wait; kill -9 $pid 2>/dev/null && kills=$((kills + 1)); wait $pid\n"
      "done > /dev/null 2>&1\necho $kills");
  EXPECT_GE(std::stoi(ended.out), 2) << "it was never killed: nothing is tested";
  calm("-j 1 --out killed");
  EXPECT_EQ(reproducible("killed"), reproducible("calm"));
}

INSTANTIATE_TEST_SUITE_P(Configs, Bytes,
                         testing::Values(Shipped{"quickstart.xml", "replicates:=2", "quickstart"},
                                         Shipped{"sweeps/forest_size.xml", "scale:=ci replicates:=1",
                                                 "forest_size"},
                                         Shipped{"sweeps/optimizers.xml", "scale:=ci", "optimizers"}));

}  // namespace
}  // namespace coppice
