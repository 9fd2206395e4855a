#include "registry/describe.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "registry/source.h"
#include "tests/registry/drawing.h"
#include "tests/registry/helpers.h"

namespace coppice {
namespace {

const Catalogue& catalogue() {
  return Catalogue::instance();
}

TEST(Describe, ShowsEverythingDeclared) {
  EXPECT_EQ(describe_text(catalogue(), *catalogue().find("test_drawing", "sheet")),
            "sheet (test_drawing)\n"
            "  A sheet.\n"
            "  Source: Doe, 2001\n"
            "\n"
            "Parameters\n"
            "  id: text, required\n"
            "      Its name.\n"
            "  framed: true or false, default false\n"
            "      Whether it has a frame.\n"
            "\n"
            "Elements inside\n"
            "  a test_shape\n"
            "      What is on it. (a test_shape, required)\n"
            "      one of box, circle, heap\n"
            "  <pen>\n"
            "      What it is drawn with. (a test_pen)\n"
            "      one of brush, pencil\n"
            "\n"
            "Example\n"
            "  <sheet id=\"my_id\" framed=\"false\">\n"
            "    <box/>\n"
            "  </sheet>\n");
}

TEST(Describe, WrapsToTheWidth) {
  ComponentInfo info = *catalogue().find("test_shape", "box");
  info.doc = "A long sentence that goes on and on, further than the terminal of the user is wide.";
  const std::string text = describe_text(catalogue(), info, 40);
  EXPECT_NE(text.find("  A long sentence that goes on and on,\n  further than"), std::string::npos) << text;
}

TEST(Describe, JsonHoldsTheSame) {
  const nlohmann::ordered_json box = describe_json(catalogue(), *catalogue().find("test_shape", "box"));
  EXPECT_EQ(box["version"], 3);
  EXPECT_EQ(box["parameters"][0]["name"], "width");
  EXPECT_EQ(box["parameters"][0]["unit"], "m");
  EXPECT_EQ(box["parameters"][0]["above"], 0);
  EXPECT_EQ(box["parameters"][0]["default"], "2");
  EXPECT_FALSE(box["parameters"][0].contains("at_most"));
  const nlohmann::ordered_json heap = describe_json(catalogue(), *catalogue().find("test_shape", "heap"));
  EXPECT_EQ(heap["elements"][0]["many"], true);
  EXPECT_EQ(heap["elements"][1]["default"], "pencil");
}

/// Every component of this program that needs no file: its example reads without a mistake.
TEST(Describe, ExamplesAreValid) {
  for (const std::string& interface : catalogue().interfaces()) {
    for (const ComponentInfo* info : catalogue().all(interface)) {
      const bool needs_file = std::any_of(
          info->parameters.begin(), info->parameters.end(),
          [](const auto& parameter) { return parameter.required && parameter.type == ValueType::file; });
      if (needs_file) continue;
      const std::string text = to_xml(example_of(catalogue(), *info));
      Diagnostics diagnostics;
      Element resolved;
      EXPECT_NE(info->make(test::parse(text), &resolved, diagnostics), nullptr)
          << text << test::text_of(diagnostics.all());
    }
  }
}

TEST(Describe, ExampleValuesRespectBounds) {
  ComponentInfo info;
  info.interface = "test_pen";
  info.name = "marker";
  const auto add = [&](const char* name, ValueType type, Bounds bounds) {
    ParameterInfo parameter;
    parameter.name = name;
    parameter.type = type;
    parameter.bounds = bounds;
    parameter.required = true;
    info.parameters.push_back(parameter);
  };
  add("a", ValueType::number, above(3));
  add("b", ValueType::number, {.low = 0, .high = 1, .low_open = true, .high_open = true});
  add("c", ValueType::integer, at_least(2));
  add("d", ValueType::number, {.high = 5, .high_open = true});
  add("e", ValueType::boolean, {});
  add("f", ValueType::file, {});
  add("g", ValueType::reference, {});
  info.parameters.back().artifact = "policy";
  EXPECT_EQ(to_xml(example_of(catalogue(), info)),
            "<marker a=\"4\" b=\"0.5\" c=\"2\" d=\"4\" e=\"true\" f=\"f.csv\" g=\"my_policy\"/>\n");
}

TEST(Describe, CommonParametersAreThoseOfAll) {
  Catalogue few;
  for (const char* name : {"a", "b", "c"}) {
    ComponentInfo info;
    info.interface = "thing";
    info.name = name;
    ParameterInfo shared, own;
    shared.name = "id";
    own.name = name;
    info.parameters = {shared, own};
    EXPECT_TRUE(common_parameters(few, "thing").empty());
    few.add(info);
  }
  EXPECT_EQ(common_parameters(few, "thing"), std::vector<std::string>{"id"});
}

}  // namespace
}  // namespace coppice
