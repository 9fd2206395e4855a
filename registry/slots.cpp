#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <utility>

#include "registry/component.h"
#include "registry/parameter_text.h"
#include "registry/parameters.h"
#include "registry/suggest.h"
#include "registry/text.h"

// Which attributes and children an element may have, and which slot each child fills.

namespace coppice::detail {
namespace {

const ParameterInfo* find_parameter(const std::vector<ParameterInfo>& parameters, std::string_view name) {
  const auto found = std::find_if(parameters.begin(), parameters.end(),
                                  [name](const ParameterInfo& info) { return info.name == name; });
  return found == parameters.end() ? nullptr : &*found;
}

std::vector<std::string> names_of(const std::vector<ParameterInfo>& parameters) {
  std::vector<std::string> names;
  for (const ParameterInfo& info : parameters) names.push_back(info.name);
  return names;
}

std::string valid_names(const SlotInfo& slot) {
  return "valid: " + join(Catalogue::instance().names(slot.interface));
}

/// Sorts the children of one element into its slots.
class Assignment {
 public:
  Assignment(const std::vector<ParameterInfo>& parameters, const std::vector<SlotInfo>& slots, Reader& reader)
      : parameters_(parameters),
        slots_(slots),
        reader_(reader),
        wrappers_(slots.size()),
        filled_(slots.size()) {}

  std::vector<std::vector<const Element*>> assign() {
    for (const Element& child : reader_.element().children) place_child(child);
    for (std::size_t i = 0; i < slots_.size(); ++i) check_number(i);
    return std::move(filled_);
  }

 private:
  void place_child(const Element& child) {
    for (std::size_t i = 0; i < slots_.size(); ++i) {
      if (!slots_[i].direct && slots_[i].name == child.name) return open_wrapper(i, child);
    }
    for (std::size_t i = 0; i < slots_.size(); ++i) {
      if (slots_[i].direct && Catalogue::instance().find(slots_[i].interface, child.name) != nullptr) {
        filled_[i].push_back(&child);
        return;
      }
    }
    report_unknown(child);
  }

  void open_wrapper(std::size_t i, const Element& wrapper) {
    for (const Attribute& attribute : wrapper.attributes) {
      const Place& place = attribute.name_place.file ? attribute.name_place : wrapper.place;
      reader_.error(place, fmt::format("<{}> takes no attributes", wrapper.name),
                    fmt::format("they belong to the {} inside", slots_[i].interface));
    }
    if (wrappers_[i] != nullptr) {
      reader_.error(wrapper.place, fmt::format("<{}> stands twice in <{}>", wrapper.name, name()));
      return;
    }
    wrappers_[i] = &wrapper;
    for (const Element& child : wrapper.children) filled_[i].push_back(&child);
  }

  void check_number(std::size_t i) {
    const SlotInfo& slot = slots_[i];
    std::vector<const Element*>& filled = filled_[i];
    const std::string& holder = slot.direct ? name() : slot.name;
    if (filled.size() > 1 && !slot.many) {
      reader_.error(filled[1]->place,
                    fmt::format("<{}> takes one {}, not {}", holder, slot.interface, filled.size()));
      filled.resize(1);
    }
    if (!filled.empty()) return;
    if (wrappers_[i] != nullptr ? wrappers_[i]->failed : reader_.element().failed) {
      reader_.diagnostics().already_reported();
      return;
    }
    if (wrappers_[i] != nullptr && !(slot.many && !slot.required)) {
      reader_.error(wrappers_[i]->place, fmt::format("<{}> needs {}", holder, with_article(slot.interface)),
                    valid_names(slot));
    } else if (wrappers_[i] == nullptr && slot.required && slot.default_component.empty() && !unknown_) {
      const std::string what = slot.direct ? with_article(slot.interface) : fmt::format("<{}>", slot.name);
      reader_.error(reader_.element().place, fmt::format("<{}> needs {}", name(), what), slot.doc,
                    {fmt::format("valid for {}: {}", slot.interface,
                                 join(Catalogue::instance().names(slot.interface)))});
    }
  }

  void report_unknown(const Element& child) {
    unknown_ = true;
    const std::string message = fmt::format("<{}> has no element <{}>", name(), child.name);
    if (const ParameterInfo* info = find_parameter(parameters_, child.name); info != nullptr) {
      reader_.error(child.place, message,
                    fmt::format("'{}' is an attribute: {}=\"...\" ({})", info->name, info->name,
                                parameter_text(*info)));
      return;
    }
    for (const SlotInfo& slot : slots_) {
      if (slot.direct || Catalogue::instance().find(slot.interface, child.name) == nullptr) continue;
      reader_.error(child.place, message,
                    fmt::format("did you mean <{0}><{1}/></{0}>?", slot.name, child.name));
      return;
    }
    if (slots_.size() == 1 && slots_.front().direct) {
      report_unknown_component(slots_.front().interface, child, reader_.diagnostics());
      return;
    }
    const std::vector<std::string> names = valid_children();
    const bool near = !nearest(child.name, names).empty();
    reader_.error(child.place, message,
                  names.empty() ? "it has no elements inside" : suggestion(child.name, names),
                  near ? std::vector<std::string>{"valid: " + join(names)} : std::vector<std::string>{});
  }

  std::vector<std::string> valid_children() const {
    std::vector<std::string> names;
    for (const SlotInfo& slot : slots_) {
      if (!slot.direct) names.push_back(slot.name);
    }
    for (const SlotInfo& slot : slots_) {
      if (!slot.direct) continue;
      for (std::string& component : Catalogue::instance().names(slot.interface)) {
        names.push_back(std::move(component));
      }
    }
    return names;
  }

  const std::string& name() const { return reader_.element().name; }

  const std::vector<ParameterInfo>& parameters_;
  const std::vector<SlotInfo>& slots_;
  Reader& reader_;
  std::vector<const Element*> wrappers_;
  std::vector<std::vector<const Element*>> filled_;
  bool unknown_ = false;  ///< an unknown child may be a misspelt one of those that seem to be missing
};

}  // namespace

void report_missing(const ParameterInfo& info, const std::vector<ParameterInfo>& all, Reader& reader) {
  const std::vector<std::string> names = names_of(all);
  for (const Attribute& attribute : reader.element().attributes) {
    const bool known = find_parameter(all, attribute.name) != nullptr;
    if (!known && nearest(attribute.name, names) == info.name) return;  // check_attributes says so
  }
  reader.error(reader.element().place, fmt::format("<{}> needs '{}'", reader.element().name, info.name),
               fmt::format("{} ({})", info.doc, parameter_text(info)));
}

void check_attributes(const std::vector<ParameterInfo>& parameters, const std::vector<SlotInfo>& slots,
                      Reader& reader) {
  const std::vector<std::string> names = names_of(parameters);
  for (const Attribute& attribute : reader.element().attributes) {
    if (find_parameter(parameters, attribute.name) != nullptr) continue;
    std::string hint = suggestion(attribute.name, names);
    const auto slot = std::find_if(slots.begin(), slots.end(),
                                   [&](const SlotInfo& s) { return !s.direct && s.name == attribute.name; });
    if (slot != slots.end()) {
      hint = fmt::format("'{0}' is an element: <{0}><.../></{0}>; {1}", slot->name, valid_names(*slot));
    } else if (names.empty()) {
      hint = "it has no parameters";
    } else if (const ParameterInfo* info = find_parameter(parameters, nearest(attribute.name, names))) {
      hint = fmt::format("did you mean '{}' ({})?", info->name, parameter_text(*info));
    }
    reader.error(attribute.name_place.file ? attribute.name_place : reader.element().place,
                 fmt::format("<{}> has no parameter '{}'", reader.element().name, attribute.name),
                 std::move(hint));
  }
}

std::vector<std::vector<const Element*>> assign_children(const std::vector<ParameterInfo>& parameters,
                                                         const std::vector<SlotInfo>& slots, Reader& reader) {
  return Assignment(parameters, slots, reader).assign();
}

void fill_slot(const SlotInfo& slot, Element& element, std::vector<Element> parts) {
  if (parts.empty()) return;
  if (!slot.direct) {
    element.children.push_back({slot.name, {}, {}, std::move(parts)});
    return;
  }
  for (Element& part : parts) element.children.push_back(std::move(part));
}

}  // namespace coppice::detail
