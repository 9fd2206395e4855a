#include "engine/config/given_arguments.h"

#include "engine/config/attribute_place.h"
#include "engine/config/value.h"
#include "registry/text.h"

namespace coppice::config {
namespace {

/// The value of an override, with its place behind ":=".
Attribute whole_value(const Override& given) {
  Attribute value{given.name, given.value, given.place, given.place};
  const auto skipped = static_cast<int>(count_characters(given.name)) + 2;
  value.name_place.length = skipped - 2;
  if (value.value_place.column > 0) value.value_place.column += skipped;
  value.value_place.length = static_cast<int>(count_characters(given.value));
  return value;
}

}  // namespace

GivenArguments::GivenArguments(const std::vector<Override>& overrides) {
  for (const Override& given : overrides) {
    GivenArgument argument{given, whole_value(given), {}};
    const std::vector<std::string> items = split_items(given.value);
    const std::vector<std::size_t> offsets = item_offsets(given.value);
    for (std::size_t i = 0; i < items.size(); ++i) {
      Attribute item = argument.whole;
      item.value_place = place_in(argument.whole, offsets[i], items[i].size());
      item.value = items[i];
      argument.values.push_back(std::move(item));
    }
    if (argument.values.size() == 1) argument.whole.value = argument.values.front().value;  // without quotes
    if (arguments_.emplace(given.name, std::move(argument)).second) order_.push_back(given.name);
  }
}

GivenArgument* GivenArguments::find(std::string_view name) {
  const auto found = arguments_.find(name);
  return found == arguments_.end() ? nullptr : &found->second;
}

void GivenArguments::sweep(GivenArgument& argument) {
  if (argument.swept) return;
  argument.swept = true;
  swept_.push_back(&argument);
}

bool GivenArguments::next_combination() {
  for (auto argument = swept_.rbegin(); argument != swept_.rend(); ++argument) {
    if (++(*argument)->chosen < (*argument)->values.size()) return true;
    (*argument)->chosen = 0;
  }
  return false;
}

std::vector<Override> GivenArguments::taken() const {
  std::vector<Override> all;
  for (const std::string& name : order_) {
    const GivenArgument& argument = arguments_.at(name);
    if (argument.taken) all.push_back(argument.override);
  }
  return all;
}

}  // namespace coppice::config
