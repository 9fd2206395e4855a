#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "registry/component.h"
#include "registry/language.h"

// A small family of components to test the registry with: drawings made of shapes and pens.

namespace coppice::test {

struct Pen {
  static constexpr const char* kInterface = "test_pen";
  virtual ~Pen() = default;
  virtual std::string draw() const = 0;
};

struct Pencil final : Pen {
  double width = 1e-3;
  std::string draw() const override { return "pencil"; }
  static Parameters<Pencil> parameters() {
    return Parameters<Pencil>().add("width", &Pencil::width, "m", "Width of its line.", above(0));
  }
};

struct Brush final : Pen {
  double softness = 0.5;
  std::string draw() const override { return "brush"; }
  static Parameters<Brush> parameters() {
    return Parameters<Brush>().add("softness", &Brush::softness, "", "How soft.", between(0, 1));
  }
};

struct Shape {
  static constexpr const char* kInterface = "test_shape";
  virtual ~Shape() = default;
  virtual double area() const = 0;
};

struct Box final : Shape {
  double width = 2, height = 3;
  double area() const override { return width * height; }
  void check() const {
    if (width > 10 * height) throw std::invalid_argument("width must be at most ten times the height");
  }
  static Parameters<Box> parameters() {
    return Parameters<Box>()
        .add("width", &Box::width, "m", "From left to right.", above(0))
        .add("height", &Box::height, "m", "From bottom to top.", above(0));
  }
};

struct Heap final : Shape {
  std::vector<Sub<Shape>> parts;
  Sub<Pen> pen{"pencil", {{"width", "2 mm", {}, {}}}};
  double area() const override {
    double sum = 0;
    for (const Sub<Shape>& part : parts) sum += part->area();
    return sum;
  }
  static Parameters<Heap> parameters() {
    return Parameters<Heap>()
        .components("parts", &Heap::parts, "What lies on it.", true)
        .component("pen", &Heap::pen, "What draws it.");
  }
};

/// A circle is a plain struct: an adapter makes it a shape.
struct Circle {
  double radius = 1;
  static Parameters<Circle> parameters() {
    return Parameters<Circle>().require("radius", &Circle::radius, "m", "From the centre.", above(0));
  }
};

struct Drawing {
  static constexpr const char* kInterface = "test_drawing";
  virtual ~Drawing() = default;
};

/// A sheet holds one shape, a pen if wanted, and a name.
struct Sheet final : Drawing {
  std::string id;
  bool framed = false;
  Sub<Shape> shape;
  Sub<Pen> pen;
  static Parameters<Sheet> parameters() {
    return Parameters<Sheet>()
        .require("id", &Sheet::id, "", "Its name.")
        .add("framed", &Sheet::framed, "", "Whether it has a frame.")
        .direct(&Sheet::shape, "What is on it.")
        .component("pen", &Sheet::pen, "What it is drawn with.");
  }
};

}  // namespace coppice::test

namespace coppice {

template <>
struct Adapter<test::Shape> {
  static std::shared_ptr<test::Shape> make(test::Circle circle, std::string name) {
    struct Round final : test::Shape {
      double radius = 0;
      std::string name;
      double area() const override { return 3 * radius * radius; }
    };
    auto round = std::make_shared<Round>();
    round->radius = circle.radius;
    round->name = std::move(name);
    return round;
  }
};

}  // namespace coppice

namespace coppice::test {

inline const Component<Pen, Pencil> kPencil("pencil", "A pencil.", "no publication");
inline const Component<Pen, Brush> kBrush("brush", "A brush.", "no publication");
inline const Component<Shape, Box> kBox("box", "A box.", "no publication", 3);
inline const Component<Shape, Heap> kHeap("heap", "Several shapes.", "no publication");
inline const Component<Shape, Circle> kCircle("circle", "A circle.", "no publication", 2);
inline const Component<Drawing, Sheet> kSheet("sheet", "A sheet.", "Doe, 2001");

inline LanguageElement language_element(std::string name, std::vector<LanguageAttribute> attributes = {}) {
  LanguageElement element;
  element.name = std::move(name);
  element.doc = "Explains " + element.name + ".";
  element.attributes = std::move(attributes);
  return element;
}

/// A language whose root holds drawings; <list> is declared twice, for two parents.
inline Language drawing_language() {
  Language language;
  language.root =
      language_element("album", {{"version", "Of the language.", true}, {"title", "Shown.", false}});
  language.root_interface = "test_drawing";
  language.common = {{"if", "The element counts only when this is true.", false}};
  LanguageElement group = language_element("group");
  group.content = LanguageContent::surrounding;
  group.in_root = group.in_components = true;
  LanguageElement macro = language_element("macro", {{"name", "Its name.", true}});
  macro.content = LanguageContent::anything;
  macro.in_root = true;
  LanguageElement call = language_element("call", {{"macro", "Which.", true}});
  call.content = LanguageContent::anything;
  call.free_attributes = call.in_root = call.in_components = true;
  LanguageElement sweep = language_element("sweep", {{"id", "Its name.", true}});
  sweep.children = {"list", "zip"};
  sweep.in_root = true;
  LanguageElement list = language_element("list", {{"values", "All of them.", true}});
  list.inside = {"sweep"};
  LanguageElement zip = language_element("zip");
  zip.children = {"list"};
  zip.inside = {"sweep"};
  LanguageElement columns = language_element("list", {{"columns", "Side by side.", true}});
  columns.inside = {"zip"};
  language.elements = {group, macro, call, sweep, list, zip, columns};
  language.interfaces["test_shape"] = "What can be drawn.";
  return language;
}

}  // namespace coppice::test
