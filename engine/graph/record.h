#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "engine/graph/store.h"

namespace coppice {

/// A record as it stands in the store: JSON with a format version.
std::string record_text(const ResultRecord& record);

/// None when the text is damaged, or of another format.
std::optional<ResultRecord> parse_record(std::string_view text);

}  // namespace coppice
