#pragma once

#include <string_view>

#include "engine/config/experiment.h"

namespace coppice::config {

/// The declaration of a control element that stands in `parent` ("" outside of control elements); null when
/// there is none.
const ControlElement* find_control(std::string_view name, std::string_view parent);

/// The declaration of the root element.
const ControlElement& root_element();

/// Reports attributes that `declaration` does not know, required ones that are missing, and children that do
/// not belong there. `trace` is how expansion came to the element. False after a missing attribute.
bool check_control(const Element& element, const ControlElement& declaration,
                   const std::shared_ptr<const TraceFrame>& trace, Diagnostics& diagnostics);

/// Reports required attributes that are missing, unless an unknown one looks like a misspelling of them.
/// False when any is missing.
bool check_required(const Element& element, const ControlElement& declaration,
                    const std::shared_ptr<const TraceFrame>& trace, Diagnostics& diagnostics);

/// Letters, digits, '_' and '-': fit for the id of a node or a sweep, and so for a file name.
bool is_id(const std::string& text);

/// Reports a name that expressions could not use: not an identifier, kept by the language, or a function.
bool check_name(const std::string& name, const Place& place, Diagnostics& diagnostics);

/// Reports an item of a list written as text (see split_items) that is empty; one in quotes may be.
bool check_items(const Attribute& list, Diagnostics& diagnostics);

}  // namespace coppice::config
