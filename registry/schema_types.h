#pragma once

#include "registry/parameters.h"
#include "registry/xml_writer.h"

namespace coppice {

/// The simple type of a parameter's attribute: its literals, or an expression.
void write_value_type(XmlWriter& xml, const ParameterInfo& info);

/// The named types that write_value_type refers to.
void write_value_types(XmlWriter& xml);

}  // namespace coppice
