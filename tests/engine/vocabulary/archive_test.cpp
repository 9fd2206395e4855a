#include "engine/vocabulary/archive.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "engine/vocabulary/random.h"

namespace coppice {
namespace {

Archive sample() {
  Archive archive;
  archive.put("double", std::vector<double>{1.5, -0.0, std::numeric_limits<double>::denorm_min()});
  archive.put("float", std::vector<float>{0.1f});
  archive.put("long", std::vector<std::int64_t>{-1, std::numeric_limits<std::int64_t>::max()});
  archive.put("int", std::vector<std::int32_t>{7});
  archive.put("byte", std::vector<std::uint8_t>{});
  archive.put("text", std::string("a\0b", 3));
  return archive;
}

template <class Call>
std::string message_of(const Call& call) {
  try {
    call();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(Archive, BytesReadBackToEqualContent) {
  const Archive back = Archive::from_bytes(sample().bytes());
  EXPECT_EQ(back.bytes(), sample().bytes());
  EXPECT_EQ(back.get<std::vector<float>>("float"), std::vector<float>{0.1f});
  EXPECT_EQ(back.get<std::vector<std::int64_t>>("long")[1], std::numeric_limits<std::int64_t>::max());
  EXPECT_TRUE(back.get<std::vector<std::uint8_t>>("byte").empty());
  EXPECT_EQ(back.get<std::string>("text"), std::string("a\0b", 3));
}

TEST(Archive, BytesDoNotDependOnTheOrderOfPutting) {
  Archive a, b;
  a.put("x", std::vector<double>{1});
  a.put("y", std::vector<double>{2});
  b.put("y", std::vector<double>{2});
  b.put("x", std::vector<double>{1});
  EXPECT_EQ(a.bytes(), b.bytes());
}

TEST(Archive, LayoutIsAsDocumented) {
  Archive archive;
  archive.put("ab", std::vector<std::int32_t>{0x01020304});
  const char expected[] =
      "\1\0\0\0\0\0\0\0"  // one array
      "\2\0\0\0ab"        // name
      "\3"                // int32
      "\1\0\0\0\0\0\0\0"  // one item
      "\4\3\2\1";
  EXPECT_EQ(archive.bytes(), std::string(expected, sizeof expected - 1));
}

TEST(Archive, ScopesPrefixNames) {
  Archive archive;
  {
    const Archive::Scope trees(archive, "trees");
    const Archive::Scope first(archive, "0");
    archive.put("split", std::vector<double>{1});
    EXPECT_TRUE(archive.has("split"));
  }
  EXPECT_FALSE(archive.has("split"));
  EXPECT_TRUE(archive.has("trees/0/split"));
}

TEST(Archive, MissingAndMistypedArraysAreNamed) {
  Archive archive = sample();
  EXPECT_EQ(message_of([&] { archive.get<std::string>("nothing"); }), "there is no array 'nothing'");
  EXPECT_EQ(message_of([&] { archive.get<std::vector<double>>("float"); }),
            "array 'float' has the type float32, another is expected");
  const Archive::Scope scope(archive, "deep");
  EXPECT_EQ(message_of([&] { archive.get<std::string>("text"); }), "there is no array 'deep/text'");
}

TEST(Archive, EveryTruncationIsRefused) {
  const std::string bytes = sample().bytes();
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    EXPECT_THROW(Archive::from_bytes(bytes.substr(0, n)), std::runtime_error) << n;
  }
  EXPECT_THROW(Archive::from_bytes(bytes + "x"), std::runtime_error);
}

TEST(Archive, DamagedBytesAreReadOrRefusedButNeverMore) {
  const std::string bytes = sample().bytes();
  Stream stream = Draws(1, "archive", 0).stream("mutation");
  for (int i = 0; i < 20000; ++i) {
    std::string damaged = bytes;
    for (std::uint64_t k = stream.below(3) + 1; k > 0; --k) {
      damaged[stream.below(damaged.size())] = static_cast<char>(stream.below(256));
    }
    try {
      EXPECT_EQ(Archive::from_bytes(damaged).bytes(), damaged);
    } catch (const std::runtime_error& refused) {
      EXPECT_STRNE(refused.what(), "");
    }
  }
}

}  // namespace
}  // namespace coppice
