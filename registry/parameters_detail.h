#pragma once

// The template bodies of registry/parameters.h.

#include <type_traits>
#include <utility>

#include "registry/parameters.h"

namespace coppice {

template <class T>
ParameterInfo Parameters<T>::base(std::string name, ValueType type, std::string unit, std::string doc,
                                  Bounds bounds) {
  ParameterInfo info;
  info.name = std::move(name);
  info.type = type;
  info.unit = std::move(unit);
  info.bounds = bounds;
  info.doc = std::move(doc);
  return info;
}

template <class T>
template <class V>
Parameters<T>& Parameters<T>::insert(ParameterInfo info, V T::*member, bool required) {
  info.required = required;
  if (!required) info.default_text = detail::print_value(info, T{}.*member);
  Field field;
  field.read = [info, member](T& object, const Attribute* given, Reader& reader) {
    if (given != nullptr) detail::read_value(info, *given, reader, object.*member);
  };
  field.print = [info, member](const T& object) { return detail::print_value(info, object.*member); };
  parameters_.push_back(std::move(info));
  fields_.push_back(std::move(field));
  return *this;
}

template <class T>
template <class V>
Parameters<T>& Parameters<T>::automatic(std::string name, std::optional<V> T::*member, std::string unit,
                                        std::string doc, Bounds bounds) {
  ParameterInfo info = base(std::move(name), detail::type_of<V>(), std::move(unit), std::move(doc), bounds);
  info.automatic = true;
  info.default_text = "auto";
  Field field;
  field.read = [info, member](T& object, const Attribute* given, Reader& reader) {
    if (given == nullptr) return;
    V value{};
    if (given->value == "auto") {
      (object.*member).reset();
    } else if (detail::read_value(info, *given, reader, value)) {
      object.*member = value;
    }
  };
  field.print = [info, member](const T& object) {
    return (object.*member) ? detail::print_value(info, *(object.*member)) : std::string("auto");
  };
  parameters_.push_back(std::move(info));
  fields_.push_back(std::move(field));
  return *this;
}

template <class T>
template <class E>
Parameters<T>& Parameters<T>::choice(std::string name, E T::*member, std::vector<std::string> choices,
                                     std::string doc) {
  ParameterInfo info = base(std::move(name), ValueType::choice, "", std::move(doc), {});
  info.choices = std::move(choices);
  info.default_text = info.choices.at(static_cast<std::size_t>(T{}.*member));
  Field field;
  field.read = [info, member](T& object, const Attribute* given, Reader& reader) {
    std::size_t index = 0;
    if (given != nullptr && detail::read_choice(info, *given, reader, index))
      object.*member = static_cast<E>(index);
  };
  field.print = [info, member](const T& object) {
    return info.choices[static_cast<std::size_t>(object.*member)];
  };
  parameters_.push_back(std::move(info));
  fields_.push_back(std::move(field));
  return *this;
}

template <class T>
Parameters<T>& Parameters<T>::reference(std::string name, Reference T::*member, std::string artifact,
                                        std::string doc, bool required) {
  ParameterInfo info = base(std::move(name), ValueType::reference, "", std::move(doc), {});
  info.artifact = std::move(artifact);
  return insert(std::move(info), member, required);
}

template <class T>
Parameters<T>& Parameters<T>::references(std::string name, References T::*member, std::string artifact,
                                         std::string doc, bool required, bool fan_out) {
  ParameterInfo info = base(std::move(name), ValueType::references, "", std::move(doc), {});
  info.artifact = std::move(artifact);
  info.fan_out = fan_out;
  return insert(std::move(info), member, required);
}

template <class T>
template <class I>
Parameters<T>& Parameters<T>::slot(SlotInfo info, Sub<I> T::*member) {
  info.default_component = (T{}.*member).resolved.name;
  SlotField field;
  field.read = [info, member](T& object, const std::vector<const Element*>& given, Reader& reader) {
    Sub<I>& sub = object.*member;
    if (given.empty() && sub.resolved.name.empty()) return;
    Element fallback = given.empty() ? sub.resolved : Element();
    fallback.place = reader.element().place;
    const Element& element = given.empty() ? fallback : *given.front();
    std::vector<Element> resolved(1);
    sub.object = std::static_pointer_cast<I>(
        detail::make_component(I::kInterface, element, &resolved.front(), reader.diagnostics()));
    sub.resolved = resolved.front();
    detail::fill_slot(info, reader.resolved(), std::move(resolved));
  };
  field.print = [info, member](const T& object) {
    const Sub<I>& sub = object.*member;
    return sub.object ? std::vector<Element>{sub.resolved} : std::vector<Element>{};
  };
  slots_.push_back(std::move(info));
  slot_fields_.push_back(std::move(field));
  return *this;
}

template <class T>
template <class I>
Parameters<T>& Parameters<T>::components(std::string name, std::vector<Sub<I>> T::*member, std::string doc,
                                         bool required) {
  SlotInfo info{std::move(name), I::kInterface, false, true, required, {}, std::move(doc)};
  SlotField field;
  field.read = [info, member](T& object, const std::vector<const Element*>& given, Reader& reader) {
    std::vector<Element> resolved;
    for (const Element* element : given) {
      Sub<I> sub;
      sub.object = std::static_pointer_cast<I>(
          detail::make_component(I::kInterface, *element, &sub.resolved, reader.diagnostics()));
      resolved.push_back(sub.resolved);
      (object.*member).push_back(std::move(sub));
    }
    detail::fill_slot(info, reader.resolved(), std::move(resolved));
  };
  field.print = [member](const T& object) {
    std::vector<Element> elements;
    for (const Sub<I>& sub : object.*member) elements.push_back(sub.resolved);
    return elements;
  };
  slots_.push_back(std::move(info));
  slot_fields_.push_back(std::move(field));
  return *this;
}

template <class T>
T Parameters<T>::read(Reader& reader) const {
  T object{};
  reader.resolved().name = reader.element().name;
  reader.resolved().place = reader.element().place;
  reader.resolved().attributes.reserve(fields_.size());
  for (std::size_t i = 0; i < fields_.size(); ++i) {
    const Attribute* given = reader.element().find(parameters_[i].name);
    if (given == nullptr && parameters_[i].required)
      detail::report_missing(parameters_[i], parameters_, reader);
    const bool failed = given != nullptr && given->failed;
    if (failed) reader.diagnostics().already_reported();
    fields_[i].read(object, failed ? nullptr : given, reader);
    reader.resolved().set(parameters_[i].name, fields_[i].print(object));
  }
  const auto children = detail::assign_children(parameters_, slots_, reader);
  for (std::size_t i = 0; i < slots_.size(); ++i) slot_fields_[i].read(object, children[i], reader);
  detail::check_attributes(parameters_, slots_, reader);
  return object;
}

template <class T>
Element Parameters<T>::print(const T& object, std::string name) const {
  Element element;
  element.name = std::move(name);
  for (std::size_t i = 0; i < fields_.size(); ++i) element.set(parameters_[i].name, fields_[i].print(object));
  for (std::size_t i = 0; i < slots_.size(); ++i)
    detail::fill_slot(slots_[i], element, slot_fields_[i].print(object));
  return element;
}

}  // namespace coppice
