#include "registry/parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <system_error>
#include <utility>

#include "registry/parameter_text.h"
#include "registry/suggest.h"
#include "registry/text.h"
#include "registry/units.h"

namespace coppice {
namespace {

/// One value inside an attribute: all of it, or an item of a list.
struct Item {
  const ParameterInfo& info;
  const Attribute& attribute;
  std::string_view text;
  Reader& reader;

  bool fail(std::string message, std::string hint = {}) const {
    const auto offset = static_cast<std::size_t>(text.data() - attribute.value.data());
    reader.error(reader.place_of(attribute, offset, text.size()), std::move(message), std::move(hint));
    return false;
  }
  std::string rule() const { return fmt::format("'{}' is {}", info.name, parameter_text(info)); }
};

Dimension declared_dimension(const ParameterInfo& info) {
  const std::optional<Quantity> unit = parse_unit(info.unit);
  return unit ? unit->dimension : Dimension{};
}

/// A number of the declared dimension; one without unit is in the declared unit.
bool read_quantity(const Item& item, double& value) {
  const std::optional<Quantity> quantity = parse_quantity(item.text);
  if (!quantity) {
    if (item.text.empty())
      return item.fail(fmt::format("'{}' has an empty value", item.info.name), item.rule());
    return item.fail(
        fmt::format("'{}' is not a number{}", item.text, item.info.unit.empty() ? "" : " with a known unit"),
        item.rule());
  }
  const Dimension wanted = declared_dimension(item.info);
  const bool bare = quantity->dimension == Dimension{} && !item.text.ends_with('%');
  if (!bare && quantity->dimension != wanted) {
    return item.fail(fmt::format("'{}' is {}; '{}' needs {}", item.text, dimension_text(quantity->dimension),
                                 item.info.name, dimension_text(wanted)),
                     item.rule());
  }
  value = quantity->value;
  return true;
}

bool check_bounds(const Item& item, double value) {
  const Bounds& bounds = item.info.bounds;
  const bool low_ok = bounds.low_open ? value > bounds.low : value >= bounds.low;
  const bool high_ok = bounds.high_open ? value < bounds.high : value <= bounds.high;
  if (low_ok && high_ok) return true;
  const std::string unit = item.info.unit.empty() ? "" : " " + item.info.unit;
  return item.fail(fmt::format("'{}' is {}{}, but must be {}", item.info.name, number_text(value), unit,
                               bounds_text(item.info)),
                   item.rule());
}

bool read_number(const Item& item, double& value) {
  double read = 0;
  if (!read_quantity(item, read)) return false;
  // Infinity passes only where the component's own default is infinite: elsewhere it would end as NaN.
  if (std::isinf(read) && item.info.default_text.find("inf") == std::string::npos) {
    return item.fail(fmt::format("'{}' must be finite", item.info.name), item.rule());
  }
  if (!check_bounds(item, read)) return false;
  value = read;
  return true;
}

/// "10000", "1e5", "2 kB": what is a whole number when all is said.
bool read_integer(const Item& item, std::int64_t low, std::int64_t high, std::int64_t& value) {
  std::string_view digits = item.text;
  if (digits.starts_with('+') && !digits.starts_with("+-")) digits.remove_prefix(1);
  std::int64_t read = 0;
  const auto [stop, failure] = std::from_chars(digits.data(), digits.data() + digits.size(), read);
  const bool plain = failure == std::errc{} && stop == digits.data() + digits.size();
  if (!plain) {
    double number = 0;
    if (!read_quantity(item, number)) return false;
    if (std::floor(number) != number) {
      return item.fail(fmt::format("'{}' is not a whole number", item.text), item.rule());
    }
    constexpr double kExact = 9007199254740992.0;  // 2^53: beyond, doubles skip integers
    if (!(std::fabs(number) <= kExact)) {
      return item.fail(fmt::format("'{}' is too large for '{}'", item.text, item.info.name), item.rule());
    }
    read = static_cast<std::int64_t>(number);
  }
  if (!check_bounds(item, static_cast<double>(read))) return false;
  if (read < low || read > high) {
    const double least = std::max(static_cast<double>(low), item.info.bounds.low);
    return item.fail(
        fmt::format("'{}' is {}, but must be in [{}, {}]", item.info.name, read, number_text(least), high),
        item.rule());
  }
  value = read;
  return true;
}

/// Calls read(item) for each item of a list, all of them even after a mistake.
bool for_each_item(const ParameterInfo& info, const Attribute& attribute, Reader& reader, auto&& read) {
  bool good = true;
  const std::vector<std::string_view> items = split_list(attribute.value);
  if (items.empty() && info.required) {
    return Item{info, attribute, attribute.value, reader}.fail(fmt::format("'{}' is empty", info.name),
                                                               info.doc);
  }
  for (const std::string_view text : items) {
    const Item item{info, attribute, text, reader};
    if (text.empty()) {
      good = item.fail(fmt::format("'{}' has an empty item", info.name),
                       "items are separated by one comma each");
    } else {
      good = read(item) && good;
    }
  }
  return good;
}

/// The folder that relative paths of an attribute start from.
std::filesystem::path base_folder(const Place& place) {
  const bool in_file = place.file && !place.file->path.starts_with('<');
  return in_file ? std::filesystem::path(place.file->path).parent_path() : std::filesystem::path();
}

std::string missing_file_hint(const std::filesystem::path& path, const std::filesystem::path& given) {
  std::error_code ignored;
  if (!std::filesystem::is_directory(path.parent_path(), ignored)) {
    return fmt::format("there is no folder '{}'", path.parent_path().string());
  }
  const std::string name = nearest_file(path.string());
  if (name.empty()) return fmt::format("looked for '{}'", path.string());
  return fmt::format("did you mean '{}'?", (given.parent_path() / name).string());
}

}  // namespace

std::string path_of_file(const Attribute& attribute) {
  const std::filesystem::path given(trim(attribute.value));
  return std::filesystem::absolute(base_folder(attribute.value_place) / given).lexically_normal().string();
}

void Reader::error(const Place& place, std::string message, std::string hint,
                   std::vector<std::string> notes) {
  diagnostics_->error(place, std::move(message), std::move(hint), std::move(notes));
}

Place Reader::place_of(const Attribute& attribute, std::size_t offset, std::size_t length) const {
  if (!attribute.value_place.file) return element_.place;
  Place place = attribute.value_place;
  // Only a value that stands in the file as it is can be pointed into; entities and expressions move what
  // follows.
  const std::string_view value = attribute.value;
  if (static_cast<std::size_t>(place.length) == count_characters(value) && offset <= value.size()) {
    place.column += static_cast<int>(count_characters(value.substr(0, offset)));
    place.length = static_cast<int>(std::max<std::size_t>(1, count_characters(value.substr(offset, length))));
  }
  return place;
}

namespace detail {

bool read_value(const ParameterInfo& info, const Attribute& attribute, Reader& reader, double& value) {
  return read_number({info, attribute, trim(attribute.value), reader}, value);
}

bool read_value(const ParameterInfo& info, const Attribute& attribute, Reader& reader, std::int64_t& value) {
  using Limits = std::numeric_limits<std::int64_t>;
  return read_integer({info, attribute, trim(attribute.value), reader}, Limits::min(), Limits::max(), value);
}

bool read_value(const ParameterInfo& info, const Attribute& attribute, Reader& reader, int& value) {
  using Limits = std::numeric_limits<int>;
  std::int64_t read = 0;
  if (!read_integer({info, attribute, trim(attribute.value), reader}, Limits::min(), Limits::max(), read))
    return false;
  value = static_cast<int>(read);
  return true;
}

bool read_value(const ParameterInfo& info, const Attribute& attribute, Reader& reader, bool& value) {
  const Item item{info, attribute, trim(attribute.value), reader};
  if (item.text != "true" && item.text != "false" && item.text != "1" && item.text != "0") {
    return item.fail(fmt::format("'{}' is neither true nor false", item.text), item.rule());
  }
  value = item.text == "true" || item.text == "1";
  return true;
}

bool read_value(const ParameterInfo& info, const Attribute& attribute, Reader& reader, std::string& value) {
  if (info.required && trim(attribute.value).empty()) {
    return Item{info, attribute, attribute.value, reader}.fail(fmt::format("'{}' is empty", info.name),
                                                               info.doc);
  }
  value = attribute.value;
  return true;
}

bool read_value(const ParameterInfo& info, const Attribute& attribute, Reader& reader,
                std::vector<double>& value) {
  std::vector<double> numbers;
  const bool good = for_each_item(
      info, attribute, reader, [&](const Item& item) { return read_number(item, numbers.emplace_back()); });
  if (good) value = std::move(numbers);
  return good;
}

bool read_value(const ParameterInfo& info, const Attribute& attribute, Reader& reader,
                std::vector<std::string>& value) {
  std::vector<std::string> texts;
  const bool good = for_each_item(info, attribute, reader, [&](const Item& item) {
    texts.emplace_back(item.text);
    return true;
  });
  if (good) value = std::move(texts);
  return good;
}

bool read_value(const ParameterInfo& info, const Attribute& attribute, Reader& reader, FilePath& value) {
  const Item item{info, attribute, trim(attribute.value), reader};
  if (item.text.empty()) {
    if (info.required) return item.fail(fmt::format("'{}' names no file", info.name), info.doc);
    value = {};
    return true;
  }
  const std::filesystem::path given(item.text);
  std::error_code ignored;
  const std::filesystem::path path = path_of_file(attribute);
  if (std::filesystem::is_directory(path, ignored)) {
    return item.fail(fmt::format("'{}' is a folder, not a file", item.text), info.doc);
  }
  if (!std::filesystem::exists(path, ignored)) {
    return item.fail(fmt::format("there is no file '{}'", item.text), missing_file_hint(path, given));
  }
  if (!std::filesystem::is_regular_file(path, ignored)) {  // read twice: for its hash and for its content
    return item.fail(fmt::format("'{}' is a pipe or a device, not a file", item.text), info.doc);
  }
  value.path = path.string();
  return true;
}

bool read_value(const ParameterInfo& info, const Attribute& attribute, Reader& reader, Reference& value) {
  const Item item{info, attribute, trim(attribute.value), reader};
  if (info.required && item.text.empty())
    return item.fail(fmt::format("'{}' is empty", info.name), item.rule());
  if (item.text.find(',') != std::string_view::npos) {
    return item.fail(fmt::format("'{}' takes one id, not a list", info.name), item.rule());
  }
  value.id = item.text;
  return true;
}

bool read_value(const ParameterInfo& info, const Attribute& attribute, Reader& reader, References& value) {
  References references;
  const bool good = for_each_item(info, attribute, reader, [&](const Item& item) {
    const bool twice = std::any_of(references.begin(), references.end(),
                                   [&](const Reference& reference) { return reference.id == item.text; });
    if (twice) return item.fail(fmt::format("'{}' stands twice in '{}'", item.text, info.name));
    references.push_back({std::string(item.text)});
    return true;
  });
  if (good) value = std::move(references);
  return good;
}

bool read_choice(const ParameterInfo& info, const Attribute& attribute, Reader& reader, std::size_t& index) {
  const Item item{info, attribute, trim(attribute.value), reader};
  const auto found = std::find(info.choices.begin(), info.choices.end(), item.text);
  if (found == info.choices.end()) {
    const std::string name = nearest(item.text, info.choices);
    return item.fail(
        fmt::format("'{}' is not a choice of '{}'", item.text, info.name),
        (name.empty() ? "" : fmt::format("did you mean '{}'? ", name)) + "valid: " + join(info.choices));
  }
  index = static_cast<std::size_t>(found - info.choices.begin());
  return true;
}

std::string print_value(const ParameterInfo&, double value) {
  return number_text(value);
}
std::string print_value(const ParameterInfo&, std::int64_t value) {
  return fmt::format("{}", value);
}
std::string print_value(const ParameterInfo&, int value) {
  return fmt::format("{}", value);
}
std::string print_value(const ParameterInfo&, bool value) {
  return value ? "true" : "false";
}
std::string print_value(const ParameterInfo&, const std::string& value) {
  return value;
}

std::string print_value(const ParameterInfo&, const std::vector<double>& value) {
  std::vector<std::string> items;
  for (const double number : value) items.push_back(number_text(number));
  return join(items);
}

std::string print_value(const ParameterInfo&, const std::vector<std::string>& value) {
  return join(value);
}
std::string print_value(const ParameterInfo&, const FilePath& value) {
  return value.path;
}
std::string print_value(const ParameterInfo&, const Reference& value) {
  return value.id;
}

std::string print_value(const ParameterInfo&, const References& value) {
  std::vector<std::string> ids;
  for (const Reference& reference : value) ids.push_back(reference.id);
  return join(ids);
}

}  // namespace detail
}  // namespace coppice
