#include "registry/component.h"

#include <gtest/gtest.h>

#include "tests/registry/drawing.h"
#include "tests/registry/helpers.h"

namespace coppice {
namespace {

using test::parse;
using test::text_of;

template <class Interface>
Sub<Interface> made(const std::string& text, std::string* errors = nullptr) {
  Diagnostics diagnostics;
  Sub<Interface> sub = make<Interface>(parse(text), diagnostics);
  if (errors != nullptr) *errors = text_of(diagnostics.all());
  EXPECT_EQ(sub.object == nullptr, diagnostics.size() > 0);
  return sub;
}

std::string errors_of_shape(const std::string& text) {
  std::string errors;
  made<test::Shape>(text, &errors);
  return errors;
}

std::string errors_of_sheet(const std::string& text) {
  std::string errors;
  made<test::Drawing>(text, &errors);
  return errors;
}

TEST(Component, MakesTheObjectAndItsResolvedElement) {
  const Sub<test::Shape> box = made<test::Shape>("<box width=\"50 cm\"/>");
  EXPECT_EQ(box->area(), 1.5);
  EXPECT_EQ(to_xml(box.resolved), "<box width=\"0.5\" height=\"3\"/>\n");
}

TEST(Component, PlainStructsGoThroughTheAdapter) {
  EXPECT_EQ(made<test::Shape>("<circle radius=\"2\"/>")->area(), 12);
}

TEST(Component, MakesSubComponentsAndTheirDefaults) {
  const Sub<test::Shape> heap = made<test::Shape>("<heap><parts><box/><circle radius=\"1\"/></parts></heap>");
  EXPECT_EQ(heap->area(), 9);
  EXPECT_EQ(to_xml(heap.resolved),
            "<heap>\n  <parts>\n    <box width=\"2\" height=\"3\"/>\n    <circle radius=\"1\"/>\n  </parts>\n"
            "  <pen>\n    <pencil width=\"0.002\"/>\n  </pen>\n</heap>\n");
}

TEST(Component, ResolvedElementMakesTheSameAgain) {
  const Sub<test::Drawing> sheet = made<test::Drawing>(
      "<sheet id=\"a\"><pen><brush softness=\"10 %\"/></pen><heap><parts><box/></parts></heap></sheet>");
  const std::string text = to_xml(sheet.resolved);
  EXPECT_EQ(to_xml(made<test::Drawing>(text).resolved), text);
}

TEST(Component, PrintsWhatItWasMadeOf) {
  Diagnostics diagnostics;
  Element resolved;
  const Element element = parse("<heap><parts><box/></parts><pen><brush/></pen></heap>");
  Reader reader(element, &resolved, &diagnostics);
  const test::Heap heap = test::Heap::parameters().read(reader);
  EXPECT_EQ(to_xml(test::Heap::parameters().print(heap, "heap")), to_xml(resolved));
}

TEST(Component, BrokenRelationsAreLocated) {
  const std::string errors = errors_of_shape("<box width=\"31\"/>");
  EXPECT_EQ(errors.find("a.xml:1:2: error: <box>: width must be at most ten times the height"), 0u) << errors;
}

TEST(Component, ARepeatedMistakeStillMakesNothing) {
  Diagnostics diagnostics;
  const Element bad = parse("<box width=\"0\"/>");
  EXPECT_EQ(make<test::Shape>(bad, diagnostics).object, nullptr);
  EXPECT_EQ(make<test::Shape>(bad, diagnostics).object, nullptr);
  EXPECT_EQ(diagnostics.all().size(), 1u);
}

TEST(Component, WhatFailedBeforeIsNotReportedAgainAndMakesNothing) {
  Element element = parse("<circle radius=\"${nothing}\"/>");
  element.attributes[0].failed = true;
  Diagnostics diagnostics;
  EXPECT_EQ(make<test::Shape>(element, diagnostics).object, nullptr);
  EXPECT_TRUE(diagnostics.empty());
  Element sheet = parse("<sheet id=\"a\"/>");
  sheet.failed = true;
  EXPECT_EQ(make<test::Drawing>(sheet, diagnostics).object, nullptr);
  EXPECT_TRUE(diagnostics.empty());
}

TEST(Component, UnknownNamesGetTheNearestAndAllValidOnes) {
  const std::string errors = errors_of_shape("<boxx/>");
  EXPECT_NE(errors.find("a.xml:1:2: error: there is no test_shape 'boxx'"), std::string::npos) << errors;
  EXPECT_NE(errors.find("did you mean 'box'?"), std::string::npos) << errors;
  EXPECT_NE(errors.find("note: valid: box, circle, heap"), std::string::npos) << errors;
  EXPECT_NE(errors_of_shape("<zzzzzzz/>").find("^~~~~~~ valid: box, circle, heap"), std::string::npos);
}

TEST(Component, WrongInterfacesAreNamed) {
  const std::string errors = errors_of_shape("<pencil/>");
  EXPECT_NE(errors.find("'pencil' is a test_pen, not a test_shape"), std::string::npos) << errors;
}

TEST(Slots, ReportWhatIsMissing) {
  EXPECT_NE(errors_of_sheet("<sheet id=\"a\"/>").find("<sheet> needs a test_shape"), std::string::npos);
  EXPECT_NE(errors_of_sheet("<sheet id=\"a\"/>").find("valid for test_shape: box, circle, heap"),
            std::string::npos);
  EXPECT_NE(errors_of_shape("<heap/>").find("<heap> needs <parts>"), std::string::npos);
  EXPECT_NE(errors_of_shape("<heap><parts/></heap>").find("<parts> needs a test_shape"), std::string::npos);
  EXPECT_NE(errors_of_shape("<heap><parts><box/></parts><pen/></heap>").find("<pen> needs a test_pen"),
            std::string::npos);
}

TEST(Slots, ReportWhatIsTooMuch) {
  EXPECT_NE(
      errors_of_sheet("<sheet id=\"a\"><box/><box/></sheet>").find("<sheet> takes one test_shape, not 2"),
      std::string::npos);
  EXPECT_NE(
      errors_of_sheet("<sheet id=\"a\"><box/><pen><brush/><brush/></pen></sheet>").find("<pen> takes one"),
      std::string::npos);
  EXPECT_NE(errors_of_sheet("<sheet id=\"a\"><box/><pen><brush/></pen><pen><brush/></pen></sheet>")
                .find("<pen> stands twice"),
            std::string::npos);
  EXPECT_NE(errors_of_sheet("<sheet id=\"a\"><box/><pen softness=\"1\"><brush/></pen></sheet>")
                .find("<pen> takes no attributes"),
            std::string::npos);
}

TEST(Slots, ReportUnknownElementsOnce) {
  const std::string errors = errors_of_sheet("<sheet id=\"a\"><bx/></sheet>");
  EXPECT_NE(errors.find("<sheet> has no element <bx>"), std::string::npos) << errors;
  EXPECT_NE(errors.find("did you mean 'box'?"), std::string::npos) << errors;
  EXPECT_EQ(errors.find("needs a test_shape"), std::string::npos) << "the misspelt one is not missing too";
  EXPECT_NE(errors_of_shape("<box><box/></box>").find("it has no elements inside"), std::string::npos);
}

TEST(Slots, TellElementsFromAttributes) {
  EXPECT_NE(errors_of_sheet("<sheet id=\"a\"><box/><framed/></sheet>")
                .find("'framed' is an attribute: framed=\"...\""),
            std::string::npos);
  EXPECT_NE(errors_of_sheet("<sheet id=\"a\" pen=\"brush\"><box/></sheet>")
                .find("'pen' is an element: <pen><.../></pen>"),
            std::string::npos);
  EXPECT_NE(
      errors_of_sheet("<sheet id=\"a\"><box/><brush/></sheet>").find("did you mean <pen><brush/></pen>?"),
      std::string::npos);
}

TEST(Slots, ReportMistakesInsideSubComponents) {
  const std::string errors =
      errors_of_sheet("<sheet id=\"a\">\n <heap><parts><box widht=\"1\"/><cirkle/></parts></heap>\n</sheet>");
  EXPECT_NE(errors.find("a.xml:2:20: error: <box> has no parameter 'widht'"), std::string::npos) << errors;
  EXPECT_NE(errors.find("did you mean 'width' (number > 0 m, default 2 m)?"), std::string::npos) << errors;
  EXPECT_NE(errors.find("a.xml:2:32: error: there is no test_shape 'cirkle'"), std::string::npos) << errors;
}

TEST(Catalogue, ListsWhatIsRegistered) {
  const Catalogue& catalogue = Catalogue::instance();
  EXPECT_EQ(catalogue.names("test_shape"), (std::vector<std::string>{"box", "circle", "heap"}));
  EXPECT_EQ(catalogue.find("test_shape", "box")->version, 3);
  EXPECT_EQ(catalogue.find("test_shape", "pencil"), nullptr);
  EXPECT_EQ(catalogue.find("nothing", "box"), nullptr);
  EXPECT_TRUE(catalogue.all("nothing").empty());
  EXPECT_EQ(catalogue.all("test_pen").front()->name, "brush");
}

TEST(Catalogue, OfThisProgramIsSound) {
  EXPECT_NO_THROW(Catalogue::instance().verify());
}

std::string problems_of(const std::vector<ComponentInfo>& infos) {
  Catalogue catalogue;
  for (const ComponentInfo& info : infos) catalogue.add(info);
  try {
    catalogue.verify();
    return "";
  } catch (const std::logic_error& error) {
    return error.what();
  }
}

ComponentInfo component(const std::string& name) {
  ComponentInfo info;
  info.interface = "thing";
  info.name = name;
  info.doc = "A thing.";
  info.source = "no publication";
  return info;
}

ParameterInfo parameter(const std::string& name) {
  ParameterInfo info;
  info.name = name;
  info.doc = "A parameter.";
  info.default_text = "1";
  return info;
}

TEST(Catalogue, VerifyNamesEveryMistakeOfADeclaration) {
  EXPECT_EQ(problems_of({component("a"), component("b")}), "");
  EXPECT_NE(problems_of({component("a"), component("a")}).find("thing/a is registered twice"),
            std::string::npos);

  ComponentInfo undocumented = component("a");
  undocumented.doc = undocumented.source = "";
  EXPECT_NE(problems_of({undocumented}).find("has no doc"), std::string::npos);
  EXPECT_NE(problems_of({undocumented}).find("has no source"), std::string::npos);

  const auto with = [](const auto& change) {
    ComponentInfo info = component("a");
    info.parameters.push_back(parameter("p"));
    change(info);
    return problems_of({info});
  };
  EXPECT_EQ(with([](ComponentInfo&) {}), "");
  EXPECT_NE(with([](ComponentInfo& i) { i.parameters.push_back(i.parameters[0]); }).find("'p' stands twice"),
            std::string::npos);
  EXPECT_NE(with([](ComponentInfo& i) { i.parameters[0].doc = ""; }).find("has no doc"), std::string::npos);
  EXPECT_NE(with([](ComponentInfo& i) { i.parameters[0].unit = "deg"; }).find("is not an SI unit"),
            std::string::npos);
  EXPECT_NE(with([](ComponentInfo& i) { i.parameters[0].unit = "x"; }).find("is not an SI unit"),
            std::string::npos);
  EXPECT_NE(with([](ComponentInfo& i) {
              i.parameters[0].bounds = above(1);
            }).find("the default 1 of 'p' is not > 1"),
            std::string::npos);
  EXPECT_NE(with([](ComponentInfo& i) { i.parameters[0].bounds = between(3, 2); }).find("nothing satisfies"),
            std::string::npos);
  EXPECT_NE(with([](ComponentInfo& i) { i.parameters[0].type = ValueType::choice; }).find("has no choices"),
            std::string::npos);
  EXPECT_NE(with([](ComponentInfo& i) { i.version = 0; }).find("version below 1"), std::string::npos);

  const SlotInfo direct{"thing", "thing", true, false, false, "", "A thing inside."};
  const SlotInfo wrapped{"p", "thing", false, false, false, "", "A thing inside."};
  const SlotInfo clashing{"a", "thing", false, false, false, "missing", ""};
  EXPECT_EQ(with([&](ComponentInfo& i) { i.slots = {direct}; }), "");
  EXPECT_NE(with([&](ComponentInfo& i) {
              i.slots = {direct, direct};
            }).find("two of its thing"),
            std::string::npos);
  EXPECT_NE(with([&](ComponentInfo& i) { i.slots = {wrapped}; }).find("'p' stands twice"), std::string::npos);
  EXPECT_NE(with([&](ComponentInfo& i) { i.slots = {clashing}; }).find("does not exist"), std::string::npos);
  EXPECT_NE(with([&](ComponentInfo& i) {
              i.slots = {direct, clashing};
            }).find("'a' is also a thing"),
            std::string::npos);
}

}  // namespace
}  // namespace coppice
