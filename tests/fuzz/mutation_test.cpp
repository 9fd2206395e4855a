// Mutations of all shipped and of all broken configs, and of a policy file, by fixed seeds. Whatever the
// bytes are, reading them ends, and the only thing that may be thrown is a ConfigError with a message.

#include <gtest/gtest.h>
#include <xxhash.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <random>
#include <stdexcept>

#include "engine/graph/artifacts.h"
#include "engine/graph/plan.h"
#include "engine/graph/run.h"
#include "tests/support/places.h"
#include "tests/support/temporary_folder.h"

namespace coppice {
namespace {

namespace fs = std::filesystem;

/// Changes texts at random places; the same seed makes the same changes.
class Mutator {
 public:
  Mutator(unsigned seed, std::vector<std::string> words) : random_(seed), words_(std::move(words)) {}

  std::size_t below(std::size_t n) { return n == 0 ? 0 : random_() % n; }

  std::string mutated(std::string text) {
    for (std::size_t count = 1 + below(3); count > 0; --count) mutate(text);
    return text;
  }

 private:
  void mutate(std::string& text) {
    const std::size_t at = below(text.size() + 1), length = std::min(below(30), text.size() - at);
    switch (below(10)) {
      case 0:
        if (at < text.size()) text[at] = static_cast<char>(text[at] ^ (1 << below(8)));
        break;
      case 1:
        if (at < text.size()) text[at] = static_cast<char>(below(256));
        break;
      case 2:
        text.erase(at, length);
        break;
      case 3:
        text.insert(at, text.substr(below(text.size() + 1), length));
        break;
      case 4:
        text.resize(at);
        break;
      case 5:
      case 6:
      case 7:
        mutate_value(text, at);
        break;
      default:
        text.replace(at, below(2) == 0 ? 0 : length, words_[below(words_.size())]);
    }
  }

  /// Another value of the attribute that follows: XML stays XML, and later stages see it.
  void mutate_value(std::string& text, std::size_t at) {
    const std::size_t quote = text.find("=\"", at);
    if (quote == std::string::npos) return;
    const std::size_t begin = quote + 2, end = std::min(text.find('"', begin), text.size());
    const std::string& word = words_[below(words_.size())];
    const std::size_t from = begin + below(end - begin + 1);
    text.replace(from, below(2) == 0 ? end - from : 0, word);
  }

  std::mt19937 random_;  // its numbers, unlike those of the distributions, are the same everywhere
  std::vector<std::string> words_;
};

std::vector<std::string> config_words() {
  return {"${",
          "}",
          "$(arg x)",
          "\"",
          "<",
          ">",
          "/>",
          "</",
          "&",
          "&#0;",
          "&#x41;",
          "<!--",
          "-->",
          "<![CDATA[",
          "]]>",
          "<!DOCTYPE a>",
          "<?xml?>",
          "nan",
          "inf",
          "-1",
          "1e308",
          "1e-320",
          "9223372036854775808",
          "0",
          "1e18",
          ",",
          ",,",
          "'",
          "\xff",
          "\xc3",
          "\xef\xbb\xbf",
          std::string(1, '\0'),
          " over=\"sizes\"",
          " replicates=\"3\"",
          " if=\"${1}\"",
          " file=\"/dev/zero\"",
          " file=\".\"",
          "<group>",
          "</group>",
          "<include file=\".\"/>",
          "<call macro=\"policy_forest\"/>",
          "<insert block=\"a\"/>",
          "range(0, 1, 1e-9)",
          "sqrt(-1)",
          "1/0",
          "^99999",
          "20 deg",
          "3 parsec",
          "not ",
          "(((((((((",
          "pick(scale, ci=1)",
          "\xf0\x9f\x8c\xb3",
          "\r\n",
          "\t"};
}

struct Text {
  fs::path file;  ///< where relative paths in it start from
  std::string bytes;
};

std::vector<Text> configs_below(const std::string& folder) {
  std::vector<Text> found;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(source_folder() / folder)) {
    if (entry.path().extension() == ".xml")
      found.push_back({entry.path(), TemporaryFolder::read(entry.path())});
  }
  std::sort(found.begin(), found.end(), [](const Text& a, const Text& b) { return a.file < b.file; });
  return found;
}

/// True when the config is accepted. A refusal has to say something; anything else that is thrown fails.
bool accepts(const fs::path& file, const std::string& bytes) {
  try {
    Diagnostics diagnostics;
    const auto source = std::make_shared<const SourceFile>(SourceFile{file.string(), bytes});
    ExperimentConfig experiment = expand(source, {}, diagnostics);
    diagnostics.throw_if_any();
    make_plan(std::move(experiment));
    return true;
  } catch (const ConfigError& error) {
    EXPECT_FALSE(error.diagnostics().empty());
    EXPECT_NE(std::string(error.what()).find("error: "), std::string::npos) << error.what();
    return false;
  } catch (const std::exception& error) {
    ADD_FAILURE() << error.what() << "\nis no ConfigError; the config is\n" << bytes;
    return false;
  }
}

TEST(Mutations, OfConfigsAreAcceptedOrRefused) {
  const std::vector<Text> shipped = configs_below("configs"), broken = configs_below("tests/configs/broken");
  ASSERT_GE(shipped.size(), 5U);
  ASSERT_GE(broken.size(), 60U);
  Mutator mutator(20171110, config_words());
  std::size_t accepted = 0;
  constexpr std::size_t kCount = 30'000;
  for (std::size_t i = 0; i < kCount && !testing::Test::HasFailure(); ++i) {
    const Text& text = i % 3 == 0 ? broken[i / 3 % broken.size()] : shipped[i % shipped.size()];
    accepted += accepts(text.file, mutator.mutated(text.bytes)) ? 1 : 0;
  }
  // Mutations are mild enough that some configs stay valid, and strong enough that most do not.
  EXPECT_GT(accepted, kCount / 100);
  EXPECT_LT(accepted, kCount / 2);
}

/// Forests of some kind, learned on the spot.
std::string learned(const std::string& attributes) {
  const TemporaryFolder folder;
  const std::string config =
      "<experiment coppice=\"1\" seed=\"5\"><problem id=\"p\"><double_integrator/></problem><policy "
      "id=\"any\">"
      "<random/></policy><collect id=\"c\" problem=\"p\" policy=\"any\" episodes=\"3\" horizon=\"20\"/>"
      "<train id=\"t\" problem=\"p\" samples=\"c\"><fpf iterations=\"2\" policy_samples=\"100\"><q_value>"
      "<extra_trees trees=\"2\"/></q_value><policy><extra_trees trees=\"3\" " +
      attributes + "/></policy></fpf></train></experiment>";
  RunOptions options;
  options.out = folder / "out";
  options.threads = 1;
  EXPECT_EQ(run({make_plan(expand(folder.write("e.xml", config).string(), {}))}, options).exit_status(), 0);
  return TemporaryFolder::read(folder / "out/e/nodes/t/policy.policy");
}

/// True when the file is accepted; its policy can act then.
bool accepts_policy(const std::string& bytes) {
  try {
    const PolicyFile file = parse_policy_file(bytes, "fuzz.policy");
    const MadePolicy policy = make_policy(file);
    if (file.spaces.state_size() == 0) return true;
    policy.object->prepare(file.spaces, nullptr);
    const std::vector<double> state(file.spaces.state_size(), 0.5);
    std::vector<double> memory(policy->memory_size());
    Action action;
    policy->act(state, memory, Draws(1, "", 0), action);
    return true;
  } catch (const ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("fuzz.policy"), std::string::npos) << error.what();
  } catch (const std::invalid_argument& error) {  // the policy does not fit its own spaces
    EXPECT_STRNE(error.what(), "");
  } catch (const std::exception& error) {
    ADD_FAILURE() << error.what() << " is neither a ConfigError nor std::invalid_argument";
  }
  return false;
}

/// Size and checksum as they would be if the program had written this content.
std::string consistent(std::string bytes) {
  constexpr std::size_t kChecksum = 12, kSize = 20, kContent = 28;
  if (bytes.size() < kContent) return bytes;
  const std::uint64_t size = bytes.size() - kContent;
  std::memcpy(bytes.data() + kSize, &size, sizeof size);
  const std::uint64_t checksum = XXH3_64bits(bytes.data() + kSize, bytes.size() - kSize);
  std::memcpy(bytes.data() + kChecksum, &checksum, sizeof checksum);
  return bytes;
}

// For each kind more than 5 10^4 mutations.
class PolicyMutations : public testing::TestWithParam<const char*> {};

TEST_P(PolicyMutations, AreRefused) {
  const std::string whole = learned(GetParam());
  ASSERT_TRUE(accepts_policy(whole));
  Mutator mutator(20171111, {std::string(8, '\xff'), std::string(8, '\0'), "policy"});
  for (std::size_t i = 0; i < 20'000 && !testing::Test::HasFailure(); ++i) {
    const std::string bytes = mutator.mutated(whole);
    EXPECT_EQ(accepts_policy(bytes), bytes == whole);
  }
  for (std::size_t length = 0; length < whole.size() && !testing::Test::HasFailure(); ++length) {
    EXPECT_FALSE(accepts_policy(whole.substr(0, length)));
  }
}

/// No bit is without meaning: all are tried.
TEST_P(PolicyMutations, OfAnyBitAreRefused) {
  const std::string whole = learned(GetParam());
  std::string bytes = whole;
  for (std::size_t bit = 0; bit < 8 * whole.size() && !testing::Test::HasFailure(); ++bit) {
    bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ (1 << bit % 8));
    EXPECT_FALSE(accepts_policy(bytes)) << "bit " << bit;
    bytes[bit / 8] = whole[bit / 8];
  }
}

/// What is read and written again is the same file, to the bit.
TEST_P(PolicyMutations, AreTheOnlyChanges) {
  const std::string whole = learned(GetParam());
  const TemporaryFolder folder;
  PolicyFile file = parse_policy_file(whole, "fuzz.policy");
  write_policy_file(folder / "first.policy", file);
  EXPECT_EQ(TemporaryFolder::read(folder / "first.policy"), whole);
  const MadePolicy policy = make_policy(file);
  file.arrays = Archive();
  policy->save(file.arrays);
  write_policy_file(folder / "second.policy", file);
  EXPECT_EQ(TemporaryFolder::read(folder / "second.policy"), whole);
}

/// Behind the checksum: what a faulty or hostile writer could have made.
TEST_P(PolicyMutations, ThatAreConsistentAreRefusedOrCanAct) {
  const std::string whole = learned(GetParam());
  ASSERT_EQ(consistent(whole), whole);
  Mutator mutator(20171112,
                  {std::string(8, '\xff'), std::string(8, '\0'), std::string("\1\0\0\0", 4), "\"/>", "pwl"});
  std::size_t accepted = 0;
  constexpr std::size_t kCount = 20'000;
  for (std::size_t i = 0; i < kCount && !testing::Test::HasFailure(); ++i) {
    accepted += accepts_policy(consistent(mutator.mutated(whole))) ? 1 : 0;
  }
  EXPECT_GT(accepted, kCount / 50);  // another number in a leaf, say
  EXPECT_LT(accepted, kCount * 9 / 10);
}

INSTANTIATE_TEST_SUITE_P(Forests, PolicyMutations,
                         testing::Values("leaves=\"pwc\"", "leaves=\"pwl\"",
                                         "splits=\"oblique\" directions=\"5\""));

}  // namespace
}  // namespace coppice
