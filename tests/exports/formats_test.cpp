#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>
#include <regex>

#include "reports/exports/onnx_graph.h"
#include "reports/exports/protobuf.h"
#include "tests/cli/process.h"
#include "tests/support/exported.h"

namespace coppice {
namespace {

using Json = nlohmann::json;

double limit(const Json& value, double without) {
  return value.is_null() ? without : value.get<double>();
}

/// As docs/exports.md says it.
double inside(double value, const Json& axis) {
  const double low = limit(axis.at("low"), -HUGE_VAL), high = limit(axis.at("high"), HUGE_VAL);
  if (std::isnan(value))
    return std::isfinite(low) && std::isfinite(high) ? low / 2 + high / 2 : std::clamp(0.0, low, high);
  if (value >= low && value <= high) return value;
  if (axis.at("circular").get<bool>() && std::isfinite(value) && low < high)
    value -= (high - low) * std::floor((value - low) / (high - low));
  return std::clamp(value, low, high);
}

double linear(const double* bias_and_slopes, const double* x, std::size_t inputs) {
  double sum = bias_and_slopes[0];
  for (std::size_t i = 0; i < inputs; ++i) sum += bias_and_slopes[1 + i] * x[i];
  return sum;
}

/// The inputs, then the directions.
std::vector<double> features(const Json& function, const double* x) {
  const auto inputs = function.at("inputs").get<std::size_t>();
  std::vector<double> all(x, x + inputs);
  if (!function.contains("directions")) return all;
  const auto rows = function.at("directions").get<std::vector<double>>();
  for (std::size_t at = 0; at < rows.size(); at += inputs + 1) all.push_back(linear(&rows[at], x, inputs));
  return all;
}

std::size_t leaf_of(const Json& tree, const double* x) {
  std::size_t node = 0;
  while (tree.at("child")[node] != 0) {
    // A threshold is in single precision: a double is above it just where its rounded-up self is.
    const bool above = x[tree.at("index")[node].get<std::size_t>()] > tree.at("value")[node].get<double>();
    node = tree.at("child")[node].get<std::size_t>() + (above ? 1 : 0);
  }
  return node;
}

double trimmed_mean(const std::vector<double>& values, std::size_t cut) {
  const double all = std::accumulate(values.begin(), values.end(), 0.0);
  const auto left = static_cast<double>(values.size() - 2 * cut);
  if (std::isnan(all)) return all;
  if (cut == 0) return all / left;
  std::vector<double> sorted = values;
  std::sort(sorted.begin(), sorted.end());
  const double low = sorted[cut - 1], high = sorted[values.size() - cut];
  if (low == high) return low;
  double sum = 0;
  for (const double value : cut > 6 ? sorted : values) sum += value > low && value < high ? value : 0;
  const auto count = [&](const auto& counts) {
    return static_cast<double>(std::count_if(values.begin(), values.end(), counts)) -
           static_cast<double>(cut);
  };
  const double lows = count([&](double value) { return value <= low; });
  const double highs = count([&](double value) { return value >= high; });
  return (sum + lows * low + highs * high) / left;
}

double forest(const Json& function, const Json& output, const double* x) {
  const bool is_linear = function.at("leaves") == "linear";
  const auto inputs = function.at("inputs").get<std::size_t>();
  const auto trees = static_cast<double>(output.at("trees").size());
  std::vector<double> values, lows, highs;
  const std::vector<double> split_by = features(function, x);
  for (const Json& tree : output.at("trees")) {
    const std::size_t leaf = leaf_of(tree, split_by.data());
    if (!is_linear) {
      values.push_back(tree.at("value")[leaf]);
      continue;
    }
    const std::vector<double> models = tree.at("models");
    const double* row = &models[tree.at("index")[leaf].get<std::size_t>() * (inputs + 3)];
    values.push_back(linear(row, x, inputs));
    lows.push_back(row[inputs + 1]);
    highs.push_back(row[inputs + 2]);
  }
  double sum = 0;
  if (!function.at("trimmed").is_null()) {
    for (std::size_t i = 0; i < lows.size(); ++i) values[i] = std::clamp(values[i], lows[i], highs[i]);
    const double mean = trimmed_mean(values, function.at("trimmed").get<std::size_t>());
    return is_linear ? mean : output.at("offset").get<double>() + output.at("scale").get<double>() * mean;
  } else {
    double low = 0, high = 0;
    for (const double value : values) sum += value;
    for (const double value : lows) low += value;
    for (const double value : highs) high += value;
    if (is_linear) sum = std::clamp(sum, low, high);
  }
  if (is_linear) return sum / trees;
  return output.at("offset").get<double>() + output.at("scale").get<double>() * (sum / trees);
}

double value_of(const Json& function, std::size_t output, const double* x) {
  if (function.at("kind") == "constant") return function.at("values")[output];
  if (function.at("kind") == "forest") return forest(function, function.at("outputs")[output], x);
  const std::vector<double> slopes = function.at("slopes");
  const std::size_t inputs = slopes.size() / function.at("bias").size();
  const bool last = function.at("bias_last");
  const double bias = function.at("bias")[output];
  double sum = last ? 0 : bias;
  for (std::size_t i = 0; i < inputs; ++i) sum += slopes[output * inputs + i] * x[i];
  return last ? bias + sum : sum;
}

TEST(JsonExport, HoldsTheWholeFunction) {
  for (const TestPolicy& policy : test_policies()) {
    const Json json = Json::parse(exported(policy, "json"));
    EXPECT_EQ(json.at("format"), "coppice policy");
    EXPECT_EQ(json.at("states").size(), 3U);
    const std::vector<double> states = test_states(policy, 300);
    const std::vector<double> expected = actions_of(policy, states);
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const std::size_t output = i % policy.outputs();
      const double value =
          value_of(json.at("function"), output, &states[i / policy.outputs() * policy.inputs()]);
      const double action = inside(value, json.at("action").at("axes")[output]);
      ASSERT_EQ(std::bit_cast<std::uint64_t>(action), std::bit_cast<std::uint64_t>(expected[i]))
          << policy.name << ": " << action << " for " << expected[i];
    }
  }
}

TEST(DotExport, DrawsSmallTreesWhole) {
  const std::string dot = exported(fitted("small", "<regression_tree n_min=\"100\"/>", 500), "dot");
  const Json json = Json::parse(exported(fitted("small", "<regression_tree n_min=\"100\"/>", 500), "json"));
  std::size_t splits = 0;
  for (const Json& output : json.at("function").at("outputs")) {
    for (const Json& child : output.at("trees")[0].at("child")) splits += child != 0;
  }
  ASSERT_GT(splits, 0U);
  const std::regex edge("-> \\w+ \\[label=yes\\]");
  EXPECT_EQ(std::distance(std::sregex_iterator(dot.begin(), dot.end(), edge), {}),
            static_cast<std::ptrdiff_t>(splits));
  EXPECT_TRUE(contains(dot, "position <= "));
  EXPECT_FALSE(contains(dot, "are drawn"));
}

TEST(DotExport, SaysWhatOfLargeForestsItLeavesOut) {
  const std::string dot = exported(test_policies().front(), "dot");
  EXPECT_TRUE(contains(dot, "levels are drawn")) << dot.substr(0, 300);
  EXPECT_TRUE(std::regex_search(dot, std::regex("\\.\\.\\. \\d+ leaves")));
  EXPECT_LT(dot.size(), 100'000U);
}

/// The examples of protobuf.dev/programming-guides/encoding.
TEST(Protobuf, EncodesAsItsSpecificationShows) {
  EXPECT_EQ(ProtobufMessage().integer(1, 150).bytes(), "\x08\x96\x01");
  EXPECT_EQ(ProtobufMessage().text(2, "testing").bytes(), "\x12\x07testing");
  EXPECT_EQ(ProtobufMessage().message(3, ProtobufMessage().integer(1, 150)).bytes(), "\x1a\x03\x08\x96\x01");
  EXPECT_EQ(ProtobufMessage().integers(6, std::vector<std::int64_t>{3, 270, 86942}).bytes(),
            "\x32\x06\x03\x8e\x02\x9e\xa7\x05");
  EXPECT_EQ(ProtobufMessage().integer(1, -2).bytes(), "\x08\xfe\xff\xff\xff\xff\xff\xff\xff\xff\x01");
  EXPECT_EQ(ProtobufMessage().real(1, 1.0F).bytes(), std::string("\x0d\x00\x00\x80\x3f", 5));
  EXPECT_EQ(ProtobufMessage().reals(1, std::vector<float>{1.0F}).bytes(),
            std::string("\x0a\x04\x00\x00\x80\x3f", 6));
  EXPECT_EQ(ProtobufMessage().text(20, "").bytes(), std::string("\xa2\x01\x00", 3));  // a tag of two bytes
}

std::string refusal(const TestPolicy& policy, const std::string& format) {
  try {
    exported(policy, format);
  } catch (const std::invalid_argument& refused) {
    return refused.what();
  }
  return "";
}

TEST(Exports, SayWhatTheyCannotExpress) {
  TestPolicy random = configured("r", "<random/>");
  random.file.spaces = {{{"x", "m", 0, 1}}, {{"go", {{"speed", "m/s", 0, 1}}}, {"wait", {}}}};
  EXPECT_EQ(refusal(random, "cpp"), "<random> cannot be exported: it draws its actions at random");
  TestPolicy still = configured("s", "<constant action=\"1\"/>");
  still.file.spaces = random.file.spaces;
  EXPECT_EQ(refusal(still, "cpp"), "");
  EXPECT_EQ(refusal(still, "json"), "");
  EXPECT_TRUE(contains(refusal(still, "onnx"), "action 'wait' has no parameters"));
  EXPECT_TRUE(contains(refusal(still, "dot"), "nothing to draw"));
  EXPECT_TRUE(
      contains(refusal(fitted("t", "<extra_trees trees=\"3\" aggregation=\"trimmed_mean\"/>"), "onnx"),
               "cannot express their trimmed mean"));
  EXPECT_TRUE(contains(refusal(fitted("o", "<extra_trees trees=\"3\" splits=\"oblique\"/>"), "onnx"),
                       "cannot express oblique splits"));
  EXPECT_EQ(refusal(still, "jsn"), "there is no export format 'jsn'; did you mean 'json'?");
  still.name = "double";
  EXPECT_TRUE(contains(refusal(still, "cpp"), "a meaning of its own in C++"));
  for (const std::string name : {"", "Onboard", "a b", "2nd", "a__b", "x/y"}) {
    still.name = name;
    EXPECT_TRUE(contains(refusal(still, "cpp"), "small letters")) << name;
  }
}

TEST(Exports, OfEqualPoliciesAreEqual) {
  const TestPolicy policy = fitted("p", "<extra_trees trees=\"2\"/>", 100);
  for (const std::string& format : Catalogue::instance().names("exporter"))
    EXPECT_EQ(exported(policy, format), exported(policy, format));
}

}  // namespace
}  // namespace coppice
