#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "registry/error.h"

namespace coppice {

/// Reads the records of a CSV text (RFC 4180; blanks around unquoted fields do not count, blank lines are
/// skipped). Views stay valid until the next call of next().
class CsvReader {
 public:
  /// Reads the header. Throws ConfigError when there is none, or a name is empty or stands twice.
  explicit CsvReader(std::shared_ptr<const SourceFile> source);
  CsvReader(const CsvReader&) = delete;
  CsvReader& operator=(const CsvReader&) = delete;

  const std::vector<std::string>& header() const { return header_; }
  std::optional<std::size_t> column(std::string_view name) const;
  /// Goes to the next record; false at the end. Throws ConfigError when it has not as many fields as the
  /// header, or for a quote that is not closed or stands inside a field.
  bool next();
  std::string_view operator[](std::size_t field) const { return fields_[field].text; }
  Place place(std::size_t field) const;         ///< of a field of the current record
  Place header_place(std::size_t field) const;  ///< of a name in the header

 private:
  struct Field {
    std::string_view text;
    std::size_t offset;  ///< of the first character in the source
  };
  void check_characters() const;
  bool next_record();
  void read_field();
  void read_quoted(std::size_t quote);
  Place place_of(const Field& field) const;
  [[noreturn]] void fail(std::size_t offset, std::string message, std::string hint = {}) const;

  std::shared_ptr<const SourceFile> source_;
  std::size_t position_ = 0;
  std::vector<Field> fields_;
  std::deque<std::string> unescaped_;  ///< texts of fields that had quotes inside
  std::vector<std::string> header_;
  std::vector<Field> header_fields_;
};

/// The largest file that is read, in bytes.
inline constexpr std::size_t kLargestTable = std::size_t{4} << 30;

/// Reading stops after so many bad cells.
inline constexpr std::size_t kMaxCsvErrors = 20;

/// A finite number written in plain notation ("1", "-2.5e-3"); nothing for any other text.
std::optional<double> parse_number(std::string_view text);

/// Appends one field, quoted where it must be.
void append_csv(std::string& line, std::string_view text);
/// Appends the shortest text that reads back to the same number; nothing for NaN and the infinities.
void append_csv(std::string& line, double number);

}  // namespace coppice
