#include "engine/data/csv.h"

#include <fmt/compile.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <utility>

#include "registry/text.h"

namespace coppice {
namespace {

constexpr bool is_blank(char c) {
  return c == ' ' || c == '\t';
}

}  // namespace

CsvReader::CsvReader(std::shared_ptr<const SourceFile> source) : source_(std::move(source)) {
  check_characters();
  if (!next_record()) fail(0, "the file has no header row");
  for (const Field& field : fields_) {
    if (field.text.empty()) fail(field.offset, "a column has no name");
    if (column(field.text)) fail(field.offset, fmt::format("the column '{}' stands twice", field.text));
    header_.emplace_back(field.text);
  }
  header_fields_ = fields_;
  for (std::size_t i = 0; i < header_.size(); ++i) header_fields_[i].text = header_[i];
}

void CsvReader::check_characters() const {
  const std::string& text = source_->text;
  for (std::size_t offset = 0; offset < text.size();) {
    if ((text[offset] & 0x80) == 0) {
      ++offset;
    } else if (const std::optional<CodePoint> character = decode_utf8(text, offset)) {
      offset += character->bytes;
    } else {
      fail(offset, "this is not UTF-8 text", "save the file as UTF-8");
    }
  }
}

std::optional<std::size_t> CsvReader::column(std::string_view name) const {
  const auto found = std::find(header_.begin(), header_.end(), name);
  if (found == header_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - header_.begin());
}

bool CsvReader::next() {
  if (!next_record()) return false;
  if (fields_.size() != header_.size()) {
    fail(fields_.back().offset,
         fmt::format("the row has {} cells, the header has {}", fields_.size(), header_.size()));
  }
  return true;
}

bool CsvReader::next_record() {
  const std::string& text = source_->text;
  while (position_ < text.size() && text[position_] == '\n') ++position_;
  if (position_ >= text.size()) return false;
  fields_.clear();
  unescaped_.clear();
  for (;;) {
    read_field();
    if (position_ >= text.size()) return true;
    if (text[position_++] == '\n') return true;  // else a comma
  }
}

/// Ends at the separator: a comma, a line end, or the end of the text.
void CsvReader::read_field() {
  const std::string& text = source_->text;
  while (position_ < text.size() && is_blank(text[position_])) ++position_;
  if (position_ < text.size() && text[position_] == '"') return read_quoted(position_);
  const std::size_t begin = position_;
  while (position_ < text.size() && text[position_] != ',' && text[position_] != '\n') {
    if (text[position_] == '"')
      fail(position_, "a quote stands inside a cell", "quote the whole cell, and double it");
    ++position_;
  }
  std::size_t end = position_;
  while (end > begin && is_blank(text[end - 1])) --end;
  fields_.push_back({std::string_view(text).substr(begin, end - begin), begin});
}

void CsvReader::read_quoted(std::size_t quote) {
  const std::string& text = source_->text;
  const std::size_t begin = quote + 1;
  bool doubled = false;
  std::size_t end = text.find('"', begin);
  while (end != std::string::npos && end + 1 < text.size() && text[end + 1] == '"') {
    doubled = true;
    end = text.find('"', end + 2);
  }
  if (end == std::string::npos) fail(quote, "the quote is not closed");
  std::string_view inside = std::string_view(text).substr(begin, end - begin);
  if (doubled) {
    std::string& plain = unescaped_.emplace_back();
    for (std::size_t i = 0; i < inside.size(); ++i) {
      plain += inside[i];
      if (inside[i] == '"') ++i;
    }
    inside = plain;
  }
  fields_.push_back({inside, quote});
  position_ = end + 1;
  while (position_ < text.size() && is_blank(text[position_])) ++position_;
  if (position_ < text.size() && text[position_] != ',' && text[position_] != '\n') {
    fail(position_, "a comma or a line end must follow the closing quote");
  }
}

Place CsvReader::place(std::size_t field) const {
  return place_of(fields_[field]);
}

Place CsvReader::header_place(std::size_t field) const {
  return place_of(header_fields_[field]);
}

Place CsvReader::place_of(const Field& field) const {
  const std::string_view before = std::string_view(source_->text).substr(0, field.offset);
  const std::size_t line = before.rfind('\n') + 1;  // npos + 1 is 0
  return {source_, 1 + static_cast<int>(std::count(before.begin(), before.end(), '\n')),
          1 + static_cast<int>(count_characters(before.substr(line))),
          std::max(1, static_cast<int>(count_characters(field.text))), nullptr};
}

void CsvReader::fail(std::size_t offset, std::string message, std::string hint) const {
  throw ConfigError({Diagnostic{place_of({{}, offset}), std::move(message), std::move(hint), {}}});
}

std::optional<double> parse_number(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

void append_csv(std::string& line, std::string_view text) {
  const bool blank_at_end = !text.empty() && (is_blank(text.front()) || is_blank(text.back()));
  if (!blank_at_end && text.find_first_of(",\"\n\r") == std::string_view::npos) {
    line += text;
    return;
  }
  line += '"';
  for (char c : text) {
    if (c == '"') line += '"';
    line += c;
  }
  line += '"';
}

void append_csv(std::string& line, double number) {
  if (std::isfinite(number)) fmt::format_to(std::back_inserter(line), FMT_COMPILE("{}"), number);
}

}  // namespace coppice
