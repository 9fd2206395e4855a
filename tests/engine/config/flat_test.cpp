// A flat config is a config that means the same.

#include <gtest/gtest.h>

#include "engine/vocabulary/random.h"
#include "registry/xml_writer.h"
#include "tests/engine/config/config_testing.h"

namespace coppice::config_testing {
namespace {

std::string attribute_text(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    escaped += c == '&'   ? "&amp;"
               : c == '<' ? "&lt;"
               : c == '"' ? "&quot;"
               : c == '$' ? "$$"
                          : std::string(1, c);
  }
  return escaped;
}

/// Labels of what the language gives a meaning to: quotes, brackets, commas, blanks, '=' and '${'.
std::string random_label(Stream& stream) {
  constexpr std::string_view kCharacters = " a1'=,()[]{}&<\"-.;";
  std::string label;
  const std::uint64_t length = 1 + stream.below(8);
  for (std::uint64_t i = 0; i < length; ++i) label += kCharacters[stream.below(kCharacters.size())];
  return label;
}

TEST(Flat, KeepsWhateverTheSweepsHold) {
  Stream stream = Draws(2017, "flat", 0).stream("labels");
  for (int trial = 0; trial < 2000; ++trial) {
    const std::string label = random_label(stream);
    SCOPED_TRACE("label '" + label + "'");
    const Outcome first = expand_document(document(
        "<sweep id=\"s\"><list><point label=\"" + attribute_text(label) +
        "\" g=\"1\"/><point label=\"b\" g=\"2\"/></list></sweep>\n<x id=\"x\" over=\"s\" g=\"${g}\"/>"));
    ASSERT_TRUE(first.errors.empty()) << first.text();
    const std::string flat_text = flat(first.config);
    const Outcome second = expand_document(flat_text);
    ASSERT_TRUE(second.errors.empty()) << second.text() << flat_text;
    ASSERT_EQ(second.config.nodes.size(), 2U);
    EXPECT_EQ(second.config.nodes[0].point, first.config.nodes[0].point);
    EXPECT_EQ(second.config.nodes[0].point[0].second, label);
    EXPECT_EQ(flat(second.config), flat_text);
  }
}

}  // namespace
}  // namespace coppice::config_testing
