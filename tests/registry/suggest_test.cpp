#include "registry/suggest.h"

#include <gtest/gtest.h>

#include "tests/registry/helpers.h"
#include "tests/support/temporary_folder.h"

namespace coppice {
namespace {

const std::vector<std::string> kNames = {"population", "sigma",     "lateral_noise", "noise",
                                         "episodes",   "horizon",   "policy",        "HA",
                                         "ANHA",       "winner2016"};

struct Typo {
  const char* given;
  const char* meant;
};

class Nearest : public testing::TestWithParam<Typo> {};

TEST_P(Nearest, IsWhatWasMeant) {
  EXPECT_EQ(nearest(GetParam().given, kNames), GetParam().meant);
}

INSTANTIATE_TEST_SUITE_P(Typos, Nearest,
                         testing::Values(Typo{"populaton", "population"},    // left out
                                         Typo{"popuulation", "population"},  // doubled
                                         Typo{"popluation", "population"},   // swapped
                                         Typo{"pupolation", "population"},   // wrong
                                         Typo{"Population", "population"},   // case
                                         Typo{"lateral-noise", "lateral_noise"},
                                         Typo{"lateralnoise", "lateral_noise"}, Typo{"nois", "noise"},
                                         Typo{"polcy", "policy"}, Typo{"ha", "HA"}, Typo{"AHNA", "ANHA"},
                                         Typo{"sgimaa", "sigma"}, Typo{"winner2106", "winner2016"},
                                         Typo{"epi", "episodes"},  // abbreviated
                                         Typo{"horizons", "horizon"}));

INSTANTIATE_TEST_SUITE_P(Strangers, Nearest,
                         testing::Values(Typo{"gamma_discount", ""}, Typo{"x", ""}, Typo{"", ""},
                                         Typo{"xyzzy", ""}, Typo{"temperature", ""}));

TEST(Suggest, AnAmbiguousAbbreviationIsNone) {
  EXPECT_EQ(nearest("pol", {"policy", "polynomial"}), "");
}

TEST(Suggest, SaysTheNearestElseWhatIsValid) {
  EXPECT_EQ(suggestion("sigmas", kNames), "did you mean 'sigma'?");
  EXPECT_EQ(suggestion("q", {"a1", "b1"}), "valid: a1, b1");
  EXPECT_EQ(suggestion("q", {}), "");
}

TEST(Suggest, ShowsADozenNames) {
  std::vector<std::string> names;
  for (int i = 10; i < 30; ++i) names.push_back("name" + std::to_string(i));
  EXPECT_EQ(
      suggestion("q", names),
      "valid: name10, name11, name12, name13, name14, name15, name16, name17, name18, name19, name20, name21 "
      "and 8 more");
}

TEST(Suggest, FindsNearFiles) {
  const TemporaryFolder folder;
  folder.write("scale.xml", "x");
  EXPECT_EQ(nearest_file((folder.path() / "scales.xml").string()), "scale.xml");
  EXPECT_EQ(nearest_file((folder.path() / "nothing_like_it.csv").string()), "");
  EXPECT_EQ(nearest_file((folder.path() / "no" / "folder.xml").string()), "");
}

}  // namespace
}  // namespace coppice
