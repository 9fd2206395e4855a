#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "registry/source.h"

namespace coppice {

/// What a parameter's text must be.
enum class ValueType { number, integer, boolean, text, choice, numbers, texts, file, reference, references };

/// The range of a number; an open end excludes the limit itself. Applies to every item of a list.
struct Bounds {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false;
  bool high_open = false;
};
inline Bounds any() {
  return {};
}
inline Bounds above(double low) {
  return {.low = low, .low_open = true};
}
inline Bounds at_least(double low) {
  return {.low = low};
}
inline Bounds at_most(double high) {
  return {.high = high};
}
inline Bounds between(double low, double high) {
  return {.low = low, .high = high};
}

/// A file named by the user, relative to the config file that names it; its content enters the cache key.
struct FilePath {
  std::string path;
};

/// The absolute path of the file that an attribute names.
std::string path_of_file(const Attribute& attribute);

/// The id of another node, and what that node must make ("problem", "policy", "dataset", ...).
struct Reference {
  std::string id;
};
using References = std::vector<Reference>;

/// One parameter as the schema, the manual and completion see it.
struct ParameterInfo {
  std::string name;
  ValueType type = ValueType::number;
  std::string unit;  ///< SI unit of the stored value, "" for plain numbers
  Bounds bounds;
  std::vector<std::string> choices;
  std::string doc;
  std::string default_text;  ///< canonical text of the default; "" when required or when empty is the default
  bool required = false;
  bool automatic = false;  ///< "auto" is allowed (and the default): the component works the value out
  std::string artifact;    ///< for references: what the node referred to must make
  bool fan_out = false;    ///< for references: the node becomes one node per node referred to
};

/// A place for sub-components: `<q_value><extra_trees/></q_value>`, or, when direct, `<extra_trees/>` itself.
struct SlotInfo {
  std::string name;
  std::string interface;  ///< kind of component that fits
  bool direct = false;    ///< the component stands in the element itself, without `<name>` around it
  bool many = false;
  bool required = false;
  std::string default_component;  ///< used when the slot is left out; "" for none
  std::string doc;
};

/// Reads one component's element; collects every mistake and, on the way, the resolved element.
class Reader {
 public:
  Reader(const Element& element, Element* resolved, Diagnostics* diagnostics)
      : element_(element), resolved_(resolved), diagnostics_(diagnostics) {}

  const Element& element() const { return element_; }
  Element& resolved() { return *resolved_; }
  Diagnostics& diagnostics() { return *diagnostics_; }
  void error(const Place& place, std::string message, std::string hint = {},
             std::vector<std::string> notes = {});
  /// Where `length` bytes from `offset` of an attribute's value stand; the element when the program made the
  /// value.
  Place place_of(const Attribute& attribute, std::size_t offset = 0,
                 std::size_t length = std::string::npos) const;

 private:
  const Element& element_;
  Element* resolved_;
  Diagnostics* diagnostics_;
};

/// A sub-component, and the resolved element that makes it again. The default is a component's name (said in
/// the member's initializer); an empty name means "none".
template <class Interface>
struct Sub {
  std::shared_ptr<Interface> object;
  Element resolved;  ///< before reading: the default component (name and attributes)

  Sub() = default;
  /// Default component, with attributes that differ from its own defaults.
  explicit Sub(std::string default_component, std::vector<Attribute> attributes = {}) {
    resolved.name = std::move(default_component);
    resolved.attributes = std::move(attributes);
  }
  const Interface& operator*() const { return *object; }
  const Interface* operator->() const { return object.get(); }
  explicit operator bool() const { return object != nullptr; }
};

namespace detail {
// Texts to values, with all checks and messages; printing gives canonical text that reads back equal.
bool read_value(const ParameterInfo&, const Attribute&, Reader&, double&);
bool read_value(const ParameterInfo&, const Attribute&, Reader&, std::int64_t&);
bool read_value(const ParameterInfo&, const Attribute&, Reader&, int&);
bool read_value(const ParameterInfo&, const Attribute&, Reader&, bool&);
bool read_value(const ParameterInfo&, const Attribute&, Reader&, std::string&);
bool read_value(const ParameterInfo&, const Attribute&, Reader&, std::vector<double>&);
bool read_value(const ParameterInfo&, const Attribute&, Reader&, std::vector<std::string>&);
bool read_value(const ParameterInfo&, const Attribute&, Reader&, FilePath&);
bool read_value(const ParameterInfo&, const Attribute&, Reader&, Reference&);
bool read_value(const ParameterInfo&, const Attribute&, Reader&, References&);
bool read_choice(const ParameterInfo&, const Attribute&, Reader&, std::size_t& index);
std::string print_value(const ParameterInfo&, double);
std::string print_value(const ParameterInfo&, std::int64_t);
std::string print_value(const ParameterInfo&, int);
std::string print_value(const ParameterInfo&, bool);
std::string print_value(const ParameterInfo&, const std::string&);
std::string print_value(const ParameterInfo&, const std::vector<double>&);
std::string print_value(const ParameterInfo&, const std::vector<std::string>&);
std::string print_value(const ParameterInfo&, const FilePath&);
std::string print_value(const ParameterInfo&, const Reference&);
std::string print_value(const ParameterInfo&, const References&);

template <class V>
constexpr ValueType type_of() {
  if constexpr (std::is_same_v<V, double>)
    return ValueType::number;
  else if constexpr (std::is_same_v<V, int> || std::is_same_v<V, std::int64_t>)
    return ValueType::integer;
  else if constexpr (std::is_same_v<V, bool>)
    return ValueType::boolean;
  else if constexpr (std::is_same_v<V, std::string>)
    return ValueType::text;
  else if constexpr (std::is_same_v<V, std::vector<double>>)
    return ValueType::numbers;
  else if constexpr (std::is_same_v<V, std::vector<std::string>>)
    return ValueType::texts;
  else if constexpr (std::is_same_v<V, FilePath>)
    return ValueType::file;
  else if constexpr (std::is_same_v<V, Reference>)
    return ValueType::reference;
  else
    return ValueType::references;
}

/// Makes the component named by `element` for `interface` (catalogue look-up); null after an error.
std::shared_ptr<void> make_component(std::string_view interface, const Element& element, Element* resolved,
                                     Diagnostics& diagnostics);
/// Reports that `interface` has no component named like `element`.
void report_unknown_component(std::string_view interface, const Element& element, Diagnostics& diagnostics);
/// Reports a required parameter that was not given, unless an unknown attribute is a misspelling of it.
void report_missing(const ParameterInfo&, const std::vector<ParameterInfo>& all, Reader&);
/// Reports attributes that no declaration knows, with the nearest valid name.
void check_attributes(const std::vector<ParameterInfo>&, const std::vector<SlotInfo>&, Reader&);
/// The elements that fill each slot (those inside `<slot>` unless direct). Reports too few, too many and
/// unknown ones.
std::vector<std::vector<const Element*>> assign_children(const std::vector<ParameterInfo>&,
                                                         const std::vector<SlotInfo>&, Reader&);
/// Puts the sub-components of a slot into an element.
void fill_slot(const SlotInfo&, Element& element, std::vector<Element> parts);
}  // namespace detail

/// The parameters of a component T: its members with unit, bounds and doc; the defaults are those of `T{}`.
/// Everything the user can set, see or complete follows from this declaration.
template <class T>
class Parameters {
 public:
  /// A number (double), integer, boolean, text, list or file with unit, doc and bounds.
  template <class V>
  Parameters& add(std::string name, V T::*member, std::string unit, std::string doc, Bounds bounds = {}) {
    return insert(base(std::move(name), detail::type_of<V>(), std::move(unit), std::move(doc), bounds),
                  member, false);
  }
  /// As add, but the user must give it.
  template <class V>
  Parameters& require(std::string name, V T::*member, std::string unit, std::string doc, Bounds bounds = {}) {
    return insert(base(std::move(name), detail::type_of<V>(), std::move(unit), std::move(doc), bounds),
                  member, true);
  }
  /// A value that may be "auto"; `doc` says how it is then worked out.
  template <class V>
  Parameters& automatic(std::string name, std::optional<V> T::*member, std::string unit, std::string doc,
                        Bounds bounds = {});
  /// One of several names, in the order of the enumeration's values from 0.
  template <class E>
  Parameters& choice(std::string name, E T::*member, std::vector<std::string> choices, std::string doc);
  /// Another node that must make `artifact`.
  Parameters& reference(std::string name, Reference T::*member, std::string artifact, std::string doc,
                        bool required = true);
  /// Other nodes; with `fan_out` this node becomes one node for each of them.
  Parameters& references(std::string name, References T::*member, std::string artifact, std::string doc,
                         bool required = true, bool fan_out = false);
  /// A sub-component in an element of its own: `<name><component/></name>`.
  template <class I>
  Parameters& component(std::string name, Sub<I> T::*member, std::string doc, bool required = false) {
    return slot({std::move(name), I::kInterface, false, false, required, {}, std::move(doc)}, member);
  }
  /// A sub-component that stands directly in the element: `<component/>`. At most one direct slot per
  /// interface.
  template <class I>
  Parameters& direct(Sub<I> T::*member, std::string doc, bool required = true) {
    return slot({I::kInterface, I::kInterface, true, false, required, {}, std::move(doc)}, member);
  }
  /// Several sub-components: `<name><a/><b/></name>`.
  template <class I>
  Parameters& components(std::string name, std::vector<Sub<I>> T::*member, std::string doc,
                         bool required = false);

  const std::vector<ParameterInfo>& parameters() const { return parameters_; }
  const std::vector<SlotInfo>& slots() const { return slots_; }

  /// Reads all parameters, reports every mistake, fills the resolved element.
  T read(Reader& reader) const;
  /// The resolved attributes and sub-components of an object, as an element called `name`.
  Element print(const T& object, std::string name) const;

 private:
  struct Field {
    std::function<void(T&, const Attribute*, Reader&)> read;  ///< attribute is null when not given
    std::function<std::string(const T&)> print;
  };
  struct SlotField {
    std::function<void(T&, const std::vector<const Element*>& given, Reader&)> read;
    std::function<std::vector<Element>(const T&)> print;
  };
  static ParameterInfo base(std::string name, ValueType type, std::string unit, std::string doc,
                            Bounds bounds);
  template <class V>
  Parameters& insert(ParameterInfo info, V T::*member, bool required);
  template <class I>
  Parameters& slot(SlotInfo info, Sub<I> T::*member);

  std::vector<ParameterInfo> parameters_;
  std::vector<Field> fields_;
  std::vector<SlotInfo> slots_;
  std::vector<SlotField> slot_fields_;
};

}  // namespace coppice

#include "registry/parameters_detail.h"  // IWYU pragma: export
