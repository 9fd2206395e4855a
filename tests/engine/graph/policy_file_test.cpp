#include <gtest/gtest.h>
#include <xxhash.h>

#include <cstring>
#include <stdexcept>

#include "engine/graph/artifacts.h"
#include "engine/vocabulary/random.h"
#include "tests/support/temporary_folder.h"

namespace coppice {
namespace {

/// A learned policy: acts by a table whose rows it looks up.
class LookUp : public Policy {
 public:
  double scale = 1;
  std::vector<double> table;

  void prepare(const Spaces&, const Simulator*) override {}
  void act(std::span<const double>, std::span<double>, const Draws&, Action& action) const override {
    action.id = 0;
    action.values.resize(1);
    action.values[0] = scale * table.at(0);
  }
  void save(Archive& archive) const override { archive.put("table", table); }
  void load(Archive& archive) override {
    table = archive.get<std::vector<double>>("table");
    if (table.empty()) throw std::runtime_error("the table is empty");
  }
  static Parameters<LookUp> parameters() {
    return Parameters<LookUp>().add("scale", &LookUp::scale, "", "Factor of all values.");
  }
};

const Component<Policy, LookUp> kLookUp("test_look_up", "Acts by a table.", "no publication");

constexpr std::size_t kChecksumOffset = 12;

PolicyFile sample() {
  PolicyFile content;
  content.writer = "coppice 1.2.3";
  content.provenance = "0123abc";
  content.spaces = {{{"angle", "rad", -3.5, 3.5, true}}, {{"push", {{"force", "N", -1, 1}}}, {"wait", {}}}};
  content.component.name = "test_look_up";
  content.component.set("scale", "2.5");
  content.arrays.put("table", std::vector<double>{1.5, -0.25});
  return content;
}

std::string bytes_of(const PolicyFile& content) {
  const TemporaryFolder folder;
  write_policy_file(folder / "p.policy", content);
  return TemporaryFolder::read(folder / "p.policy");
}

/// What is wrong with a file of these bytes; empty when nothing is. Everything but a ConfigError fails the
/// test.
std::string error_of(const std::string& bytes) {
  try {
    make_policy(parse_policy_file(bytes, "x.policy"));
  } catch (const ConfigError& error) {
    EXPECT_STRNE(error.what(), "");
    return error.what();
  }
  return "";
}

void renew_checksum(std::string& bytes) {
  const std::uint64_t checksum =
      XXH3_64bits(bytes.data() + kChecksumOffset + 8, bytes.size() - kChecksumOffset - 8);
  std::memcpy(bytes.data() + kChecksumOffset, &checksum, 8);
}

TEST(PolicyFile, ReadsBackWhatWasWritten) {
  const TemporaryFolder folder;
  write_policy_file(folder / "p.policy", sample());
  const PolicyFile back = read_policy_file(folder / "p.policy");
  EXPECT_EQ(back.writer, "coppice 1.2.3");
  EXPECT_EQ(back.provenance, "0123abc");
  EXPECT_EQ(back.spaces, sample().spaces);
  EXPECT_EQ(to_xml(back.component), to_xml(sample().component));
  EXPECT_EQ(back.arrays.bytes(), sample().arrays.bytes());
  EXPECT_EQ(bytes_of(back), bytes_of(sample()));
}

TEST(PolicyFile, MakesThePolicyAgain) {
  const MadePolicy made = make_policy(sample());
  Action action;
  made->act({}, {}, Draws(1, "", 0), action);
  EXPECT_EQ(action.values[0], 2.5 * 1.5);
  EXPECT_EQ(made.resolved.get("scale"), "2.5");
}

// Byte by byte as docs/policy-files.md says.
TEST(PolicyFile, LayoutIsAsDocumented) {
  PolicyFile content;
  content.writer = "w";
  content.provenance = "";
  content.spaces = {{{"x", "m", 0, 1, true}}, {{"go", {}}}};
  content.component.name = "c";
  const std::string xml = to_xml(content.component);
  std::string body;
  const auto add = [&body](std::string_view piece) { body += piece; };
  using namespace std::string_literals;
  using namespace std::string_view_literals;
  add("\1\0\0\0w\0\0\0\0"sv);  // writer, provenance
  add("\1\0\0\0"
      "\1\0\0\0x"
      "\1\0\0\0m"sv);  // one axis: name, unit
  add("\0\0\0\0\0\0\0\0"
      "\0\0\0\0\0\0\xF0\x3F"
      "\1"sv);  // 0, 1, circular
  add("\1\0\0\0"
      "\2\0\0\0go"
      "\0\0\0\0"sv);                                                  // one action without axes
  add(std::string{static_cast<char>(xml.size())} + "\0\0\0"s + xml);  // component
  add("\x08\0\0\0\0\0\0\0"
      "\0\0\0\0\0\0\0\0"sv);  // arrays: 8 bytes, none
  const std::string bytes = bytes_of(content);
  ASSERT_EQ(bytes.size(), 28 + body.size());
  EXPECT_EQ(bytes.substr(0, 12),
            "\x89"
            "CPP\r\n\x1a\n\1\0\0\0"sv);
  EXPECT_EQ(bytes.substr(20, 8), std::string{static_cast<char>(body.size())} + std::string(7, '\0'));
  EXPECT_EQ(bytes.substr(28), body);
  std::string renewed = bytes;
  renew_checksum(renewed);
  EXPECT_EQ(renewed, bytes);
}

TEST(PolicyFile, NamesItsWriterWhenNobodyDid) {
  PolicyFile content = sample();
  content.writer.clear();
  const TemporaryFolder folder;
  write_policy_file(folder / "p.policy", content);
  EXPECT_TRUE(read_policy_file(folder / "p.policy").writer.starts_with("coppice "));
}

TEST(PolicyFile, WithoutAProblemHasNoSpaces) {
  PolicyFile content = sample();
  content.spaces = {};
  const TemporaryFolder folder;
  write_policy_file(folder / "p.policy", content);
  EXPECT_EQ(read_policy_file(folder / "p.policy").spaces, Spaces());
}

TEST(PolicyFile, ForeignFilesAreRefused) {
  const TemporaryFolder folder;
  for (const std::string& foreign :
       {std::string(),
        std::string("\x89"
                    "CP"),
        std::string("<experiment/>"), std::string("\x89PNG\r\n\x1a\n", 8), std::string(100, '\0')}) {
    EXPECT_NE(error_of(foreign).find("x.policy: error: this is not a policy file"), std::string::npos);
  }
  EXPECT_THROW(read_policy_file(folder / "none.policy"), ConfigError);
  EXPECT_THROW(read_policy_file(folder.path()), ConfigError);
}

TEST(PolicyFile, NewerFormatsAreRefusedByName) {
  std::string bytes = bytes_of(sample());
  bytes[8] = 2;
  EXPECT_NE(error_of(bytes).find("format version 2, which a newer program wrote"), std::string::npos);
}

TEST(PolicyFile, EveryTruncationIsRefused) {
  const std::string bytes = bytes_of(sample());
  for (std::size_t n = 8; n < bytes.size(); ++n) {
    EXPECT_NE(error_of(bytes.substr(0, n)).find("truncated"), std::string::npos) << n;
  }
}

TEST(PolicyFile, EveryFlippedBitIsFound) {
  const std::string bytes = bytes_of(sample());
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    std::string flipped = bytes;
    flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ 1 << bit % 8);
    EXPECT_NE(error_of(flipped), "") << bit;
  }
  EXPECT_NE(error_of(bytes + "x"), "");
}

// Damage that the checksum does not show: each file is read, or refused with a message.
TEST(PolicyFile, MadeUpContentIsReadOrRefusedButNeverMore) {
  const std::string bytes = bytes_of(sample());
  Stream stream = Draws(1, "policy_file", 0).stream("mutation");
  int refused = 0;
  for (int i = 0; i < 12000; ++i) {
    std::string damaged = bytes;
    for (std::uint64_t k = stream.below(3) + 1; k > 0; --k) {
      const std::size_t at = 20 + stream.below(damaged.size() - 20);
      switch (stream.below(4)) {
        case 0:
          damaged[at] = static_cast<char>(stream.below(256));
          break;
        case 1:
          damaged[at] = static_cast<char>(0xFF);
          break;
        case 2:
          damaged.erase(at, stream.below(8));
          break;
        default:
          damaged.insert(at, stream.below(8), static_cast<char>(stream.below(256)));
      }
      if (damaged.size() < 32) damaged = bytes;
    }
    const std::uint64_t size = damaged.size() - 28;
    if (stream.below(2) == 0) std::memcpy(damaged.data() + 20, &size, 8);
    renew_checksum(damaged);
    refused += error_of(damaged) != "";
  }
  EXPECT_GT(refused, 6000);
  EXPECT_LT(refused, 12000);  // some damage is only another number
}

TEST(PolicyFile, ArraysThatMakeNoPolicyAreTheFilesMistake) {
  PolicyFile content = sample();
  content.arrays = {};
  EXPECT_THROW(make_policy(content), ConfigError);
  content.arrays.put("table", std::vector<double>{});
  try {
    make_policy(content);
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_NE(
        std::string(error.what()).find("<test_look_up> cannot be made of its arrays: the table is empty"),
        std::string::npos);
  }
}

TEST(PolicyFile, UnknownComponentsAndParametersAreNamed) {
  PolicyFile content = sample();
  content.component.set("scael", "1");
  EXPECT_THROW(make_policy(content), ConfigError);
  content = sample();
  content.component.name = "test_look_down";
  EXPECT_THROW(make_policy(content), ConfigError);
}

TEST(PolicyFile, LeavesNothingBehindWhenItCannotBeWritten) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "p.policy");
  folder.write("p.policy/inside", "x");
  EXPECT_THROW(write_policy_file(folder / "p.policy", sample()), std::runtime_error);
  EXPECT_THROW(write_policy_file(folder / "none" / "p.policy", sample()), std::runtime_error);
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.path())) ++files;
  EXPECT_EQ(files, 1u);
}

TEST(FunctionFile, ReadsBackWhatWasWritten) {
  const TemporaryFolder folder;
  FunctionFile content;
  content.provenance = "key";
  content.inputs = {"s_x", "s_y"};
  content.output = "value";
  content.component.name = "anything";
  content.arrays.put("a", std::vector<double>{1});
  write_function_file(folder / "f.function", content);
  const FunctionFile back = read_function_file(folder / "f.function");
  EXPECT_EQ(back.inputs, content.inputs);
  EXPECT_EQ(back.output, "value");
  EXPECT_EQ(back.provenance, "key");
  EXPECT_EQ(back.component.name, "anything");
  EXPECT_EQ(back.arrays.bytes(), content.arrays.bytes());
}

TEST(FunctionFile, IsNoPolicyFile) {
  const TemporaryFolder folder;
  FunctionFile content;
  content.component.name = "anything";
  write_function_file(folder / "f.function", content);
  EXPECT_THROW(read_policy_file(folder / "f.function"), ConfigError);
}

}  // namespace
}  // namespace coppice
