#include "registry/text.h"

#include <gtest/gtest.h>

namespace coppice {
namespace {

TEST(Text, DecodesUtf8OfEveryLength) {
  EXPECT_EQ(decode_utf8("a", 0)->value, U'a');
  EXPECT_EQ(decode_utf8("\xC3\xA9", 0)->value, U'\u00E9');
  EXPECT_EQ(decode_utf8("\xE4\xB8\xAD", 0)->value, U'\u4E2D');
  EXPECT_EQ(decode_utf8("\xF0\x9F\x98\x80", 0)->value, U'\U0001F600');
  EXPECT_EQ(decode_utf8("\xF0\x9F\x98\x80", 0)->bytes, 4u);
}

TEST(Text, RefusesWhatIsNotUtf8) {
  for (const char* bytes : {"\x80", "\xC3", "\xC3(", "\xC0\xAF", "\xE0\x80\x80", "\xED\xA0\x80",
                            "\xF4\x90\x80\x80", "\xF8\x88\x80\x80\x80", "\xFF"}) {
    EXPECT_FALSE(decode_utf8(bytes, 0).has_value()) << bytes;
  }
}

TEST(Text, CountsCharactersNotBytes) {
  EXPECT_EQ(count_characters("h\xC3\xA9t\xE4\xB8\xAD"), 4u);
  EXPECT_EQ(count_characters("a\xFF\xFE"), 3u);
}

TEST(Text, KnowsTerminalWidths) {
  EXPECT_EQ(display_width(U'a'), 1);
  EXPECT_EQ(display_width(U'\u00E9'), 1);
  EXPECT_EQ(display_width(U'\u0301'), 0);
  EXPECT_EQ(display_width(U'\u4E2D'), 2);
}

TEST(Text, TrimsBothEnds) {
  EXPECT_EQ(trim(" \t a b\r\n"), "a b");
  EXPECT_EQ(trim(" \n"), "");
}

TEST(Text, SplitsListsAndKeepsEmptyItems) {
  EXPECT_EQ(split_list("20 deg, 30 deg"), (std::vector<std::string_view>{"20 deg", "30 deg"}));
  EXPECT_EQ(split_list("a,,b,"), (std::vector<std::string_view>{"a", "", "b", ""}));
  EXPECT_TRUE(split_list("  ").empty());
}

TEST(Text, JoinsItems) {
  EXPECT_EQ(join({"a", "b"}), "a, b");
  EXPECT_EQ(join({}), "");
}

}  // namespace
}  // namespace coppice
