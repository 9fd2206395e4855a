#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "registry/units.h"

namespace coppice::config {

class Value;
using List = std::vector<Value>;

/// A value of the config language: a number with its dimension, a truth value, a text or a list. One that was
/// read from the user's text keeps its spelling, so that "20 deg" stays "20 deg" wherever it is put in.
class Value {
 public:
  static Value number(double value) { return Value(Quantity{value, {}}); }
  static Value quantity(const Quantity& value) { return Value(value); }
  static Value boolean(bool value) { return Value(value); }
  static Value text(std::string value) { return Value(std::move(value)); }
  static Value list(List items) { return Value(std::make_shared<const List>(std::move(items))); }

  /// What an attribute's text stands for: "3 h" a number, "true" a truth value, "1, 2" a list, else a text.
  static Value inferred(std::string_view text);

  const Quantity* as_quantity() const { return std::get_if<Quantity>(&data_); }
  const bool* as_boolean() const { return std::get_if<bool>(&data_); }
  const std::string* as_text() const { return std::get_if<std::string>(&data_); }
  const List* as_list() const;
  /// The number if it has no dimension.
  const double* as_plain_number() const;

  /// The text put into an attribute. A computed number with a dimension keeps its SI unit ("0.349 rad"); a
  /// list's items are joined by commas.
  std::string to_text() const;
  /// For messages: "3 h, a time (s)", "text 'abc'", "true".
  std::string description() const;

  /// Nothing when the two cannot be compared: different dimensions, or different types. A value that was read
  /// from text compares with a text by its spelling.
  friend std::optional<bool> equal(const Value& a, const Value& b);

 private:
  using Data = std::variant<Quantity, bool, std::string, std::shared_ptr<const List>>;
  explicit Value(Data data) : data_(std::move(data)) {}

  Data data_;
  std::optional<std::string> spelling_;
};

/// The items of a list written as text: separated by commas outside of quotes, brackets and ${...}, trimmed;
/// an item may stand in single quotes, where '' is a quote. A blank text has no items.
std::vector<std::string> split_items(std::string_view text);

/// The offset in `text` at which each of its items begins (after blanks), in the order of split_items.
std::vector<std::size_t> item_offsets(std::string_view text);

/// The item as split_items reads it back, whatever follows it: quoted where it needs to be.
std::string quoted_item(const std::string& item);

/// The opposite: the text without blanks around it and without the quotes that it stands in.
std::string unquoted_item(std::string_view text);

}  // namespace coppice::config
