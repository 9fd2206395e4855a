#include "engine/config/value.h"

#include <fmt/format.h>

#include <algorithm>

#include "registry/text.h"

namespace coppice::config {
namespace {

constexpr std::size_t kShownCharacters = 40;

std::string shortened(const std::string& text) {
  return text.size() <= kShownCharacters ? text : text.substr(0, kShownCharacters) + "...";
}

/// Calls found(begin, end) for each item, untrimmed.
template <class Found>
void for_each_item(std::string_view text, const Found& found) {
  if (trim(text).empty()) return;
  std::size_t begin = 0;
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    // A quote opens only where an item, a value or an expression does: in "Newton's method" it is an
    // apostrophe.
    const std::string_view before = trim(text.substr(begin, i - begin));
    const bool opens = depth > 0 || before.empty() || before.back() == '=';
    if (quoted && c == '\'' && text.substr(i + 1, 1) == "'") {  // a quote in quotes
      ++i;
      continue;
    }
    if (c == '\'' && (quoted || opens)) quoted = !quoted;
    if (quoted) continue;
    if (c == '(' || c == '[' || c == '{') ++depth;
    if ((c == ')' || c == ']' || c == '}') && depth > 0) --depth;
    if (c == ',' && depth == 0) {
      found(begin, i);
      begin = i + 1;
    }
  }
  found(begin, text.size());
}

std::string unquoted(std::string_view item) {
  if (item.size() < 2 || item.front() != '\'' || item.back() != '\'') return std::string(item);
  std::string text;
  for (std::size_t i = 1; i + 1 < item.size(); ++i) {
    text += item[i];
    if (item[i] != '\'') continue;
    if (i + 2 >= item.size() || item[i + 1] != '\'') return std::string(item);  // 'a' and 'b'
    ++i;
  }
  return text;
}

}  // namespace

std::vector<std::string> split_items(std::string_view text) {
  std::vector<std::string> items;
  for_each_item(text, [&](std::size_t begin, std::size_t end) {
    items.push_back(unquoted(trim(text.substr(begin, end - begin))));
  });
  return items;
}

std::vector<std::size_t> item_offsets(std::string_view text) {
  std::vector<std::size_t> offsets;
  for_each_item(text, [&](std::size_t begin, std::size_t end) {
    const std::string_view item = trim(text.substr(begin, end - begin));
    offsets.push_back(item.empty() ? end : static_cast<std::size_t>(item.data() - text.data()));
  });
  return offsets;
}

std::string quoted_item(const std::string& item) {
  // A bracket or quote left open would take in what follows.
  if (!item.empty() && split_items(item + ",") == std::vector<std::string>{item, ""}) return item;
  std::string text = "'";
  for (const char c : item) text += c == '\'' ? std::string("''") : std::string(1, c);
  return text + "'";
}

std::string unquoted_item(std::string_view text) {
  return unquoted(trim(text));
}

Value Value::inferred(std::string_view text) {
  const std::string_view core = trim(text);
  Value value{Data(std::string(text))};
  if (core == "true" || core == "false") {
    value.data_ = core == "true";
  } else if (const std::optional<Quantity> quantity = parse_quantity(core)) {
    value.data_ = *quantity;
  } else if (core.find(',') != std::string_view::npos) {
    std::vector<std::string> items = split_items(core);
    if (items.size() > 1) {
      List list;
      for (const std::string& item : items) list.push_back(inferred(item));
      value.data_ = std::make_shared<const List>(std::move(list));
    }
  }
  value.spelling_ = std::string(text);
  return value;
}

const List* Value::as_list() const {
  const auto* list = std::get_if<std::shared_ptr<const List>>(&data_);
  return list == nullptr ? nullptr : list->get();
}

const double* Value::as_plain_number() const {
  const Quantity* quantity = as_quantity();
  return quantity != nullptr && quantity->dimension == Dimension{} ? &quantity->value : nullptr;
}

std::string Value::to_text() const {
  if (spelling_) return *spelling_;
  if (const std::string* text = as_text()) return *text;
  if (const bool* truth = as_boolean()) return *truth ? "true" : "false";
  if (const Quantity* quantity = as_quantity()) {
    const std::string unit = unit_text(quantity->dimension);
    return unit.empty() ? number_text(quantity->value) : number_text(quantity->value) + " " + unit;
  }
  std::vector<std::string> items;
  for (const Value& item : *as_list()) items.push_back(quoted_item(item.to_text()));
  return join(items);
}

std::string Value::description() const {
  const std::string shown = shortened(to_text());
  if (const Quantity* quantity = as_quantity()) return shown + ", " + dimension_text(quantity->dimension);
  if (as_boolean() != nullptr) return shown;
  if (as_text() != nullptr) return "text '" + shown + "'";
  return fmt::format("a list of {} ({})", as_list()->size(), shown);
}

std::optional<bool> equal(const Value& a, const Value& b) {
  if (a.as_quantity() && b.as_quantity()) {
    if (a.as_quantity()->dimension != b.as_quantity()->dimension) return std::nullopt;
    return a.as_quantity()->value == b.as_quantity()->value;
  }
  if (a.as_boolean() && b.as_boolean()) return *a.as_boolean() == *b.as_boolean();
  if (a.as_list() && b.as_list()) {
    const List &x = *a.as_list(), &y = *b.as_list();
    if (x.size() != y.size()) return false;
    bool same = true;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const std::optional<bool> item = equal(x[i], y[i]);
      if (!item) return std::nullopt;
      same = same && *item;
    }
    return same;
  }
  const bool texts = (a.as_text() && (b.as_text() || b.spelling_)) || (b.as_text() && a.spelling_);
  if (!texts) return std::nullopt;
  return trim(a.to_text()) == trim(b.to_text());
}

}  // namespace coppice::config
