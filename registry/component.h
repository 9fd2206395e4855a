#pragma once

#include <concepts>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "registry/parameters.h"
#include "registry/rules.h"

namespace coppice {

/// A registered component, as the factory, the schema and the manual see it.
struct ComponentInfo {
  std::string interface;  ///< "problem", "policy", "approximator", ...
  std::string name;       ///< the element's name in a config
  std::string doc;        ///< one line
  std::string source;     ///< where it is published; "no publication" when nowhere
  int version = 1;        ///< raised whenever its results change; enters the cache key
  std::vector<ParameterInfo> parameters;
  std::vector<SlotInfo> slots;
  /// Makes the object (a shared_ptr<Interface>) and its resolved element; null after an error.
  std::function<std::shared_ptr<void>(const Element&, Element* resolved, Diagnostics&)> make;
  std::string example{};  ///< XML; empty: one is made from the parameters
};

namespace detail {
/// Reports the rules that the component `element` breaks.
void report_broken(const std::invalid_argument& broken, const Element& element, Diagnostics& diagnostics);
}  // namespace detail

/// All registered components.
class Catalogue {
 public:
  static Catalogue& instance();

  void add(ComponentInfo info);
  /// Null when there is none.
  const ComponentInfo* find(std::string_view interface, std::string_view name) const;
  std::vector<std::string> interfaces() const;                              ///< sorted
  std::vector<const ComponentInfo*> all(std::string_view interface) const;  ///< sorted by name
  std::vector<std::string> names(std::string_view interface) const;         ///< sorted
  /// Throws std::logic_error naming every duplicate, everything without doc or source, and every declaration
  /// that contradicts itself (units that are not SI, defaults out of bounds, slots for interfaces without
  /// components).
  void verify() const;

 private:
  std::map<std::string, std::map<std::string, ComponentInfo, std::less<>>, std::less<>> components_;
  std::vector<std::string> problems_;
};

/// Turns a plain struct into an interface; specialised beside interfaces that accept plain structs (Problem).
/// Has `static std::shared_ptr<Interface> make(T object, std::string component_name)`.
template <class Interface>
struct Adapter;

/// Registers T as a component of Interface; a constant at namespace scope in T's source file. T's parameters
/// come from `static Parameters<T> T::parameters()`; relations between them from an optional `void T::check()
/// const`, which throws std::invalid_argument with the broken rule (BrokenRules with several). An optional
/// `static constexpr const char* kExample` is shown as example, where one made from required parameters would
/// break such a relation.
template <class Interface, class T>
class Component {
 public:
  Component(std::string name, std::string doc, std::string source, int version = 1) {
    const Parameters<T> parameters = T::parameters();
    std::string example;
    if constexpr (requires { T::kExample; }) example = T::kExample;
    Catalogue::instance().add(
        {Interface::kInterface, std::move(name), std::move(doc), std::move(source), version,
         parameters.parameters(), parameters.slots(),
         [parameters](const Element& element, Element* resolved, Diagnostics& diagnostics) {
           return make(parameters, element, resolved, diagnostics);
         },
         std::move(example)});
  }

 private:
  static std::shared_ptr<void> make(const Parameters<T>& parameters, const Element& element,
                                    Element* resolved, Diagnostics& diagnostics) {
    const std::size_t before = diagnostics.size();
    Reader reader(element, resolved, &diagnostics);
    T object = parameters.read(reader);
    if (diagnostics.size() != before) return nullptr;
    if constexpr (requires { object.check(); }) {
      try {
        object.check();
      } catch (const std::invalid_argument& broken) {
        detail::report_broken(broken, element, diagnostics);
        return nullptr;
      }
    }
    if constexpr (std::derived_from<T, Interface>) {
      return std::static_pointer_cast<Interface>(std::make_shared<T>(std::move(object)));
    } else {
      return std::shared_ptr<Interface>(Adapter<Interface>::make(std::move(object), element.name));
    }
  }
};

/// Makes the component that `element` names. Throws nothing for the user's mistakes: they go to
/// `diagnostics`, and the object is then null. `resolved` has every parameter with its value.
template <class Interface>
Sub<Interface> make(const Element& element, Diagnostics& diagnostics) {
  Sub<Interface> made;
  made.object = std::static_pointer_cast<Interface>(
      detail::make_component(Interface::kInterface, element, &made.resolved, diagnostics));
  return made;
}

/// An object of component T, called `name`, with the element that makes it again.
template <class Interface, class T>
Sub<Interface> made(T object, std::string name) {
  Sub<Interface> sub;
  sub.resolved = T::parameters().print(object, std::move(name));
  sub.object = std::make_shared<T>(std::move(object));
  return sub;
}

}  // namespace coppice
