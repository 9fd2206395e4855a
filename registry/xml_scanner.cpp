#include "registry/xml_scanner.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "registry/text.h"

namespace coppice {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

bool starts_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == ':' || (c & 0x80) != 0;
}

bool in_name(char c) {
  return starts_name(c) || (c >= '0' && c <= '9') || c == '-' || c == '.';
}

/// XML 1.0's Char.
bool is_character(char32_t c) {
  return c == '\t' || c == '\n' || c == '\r' || (c >= 0x20 && c < 0xD800) || (c > 0xDFFF && c < 0xFFFE) ||
         (c > 0xFFFF && c <= 0x10FFFF);
}

/// Offsets to lines and columns; cheap when asked in the order of the text.
class Locator {
 public:
  explicit Locator(const std::shared_ptr<const SourceFile>& source) : source_(source) {}

  Place place(std::size_t offset, std::size_t bytes) {
    const std::string_view text = source_->text;
    if (offset < offset_) *this = Locator(source_);
    for (; offset_ < offset;) {
      const std::optional<CodePoint> character = decode_utf8(text, offset_);
      if (text[offset_] == '\n') {
        ++line_;
        column_ = 1;
      } else if (offset_ > 0 || !text.starts_with(kByteOrderMark)) {
        ++column_;
      }
      offset_ += character ? character->bytes : 1;
    }
    const auto length = static_cast<int>(count_characters(text.substr(offset, bytes)));
    return {source_, line_, column_, std::max(1, length), nullptr};
  }

 private:
  std::shared_ptr<const SourceFile> source_;
  std::size_t offset_ = 0;
  int line_ = 1;
  int column_ = 1;
};

class Scanner {
 public:
  explicit Scanner(const std::shared_ptr<const SourceFile>& source)
      : source_(source), text_(source->text), locator_(source) {
    xml_.text = source->text;
  }

  ScannedXml scan() {
    check_characters();
    if (text_.starts_with(kByteOrderMark)) at_ = kByteOrderMark.size();
    start_ = at_;
    while (at_ < text_.size()) {
      scan_text();
      if (at_ < text_.size()) scan_markup();
    }
    if (!open_.empty()) {
      fail(open_.back().place, fmt::format("<{}> is never closed", open_.back().name),
           fmt::format("</{}> is missing", open_.back().name));
    }
    if (xml_.tags.empty()) fail(place(at_, 0), "there is no element in this file");
    xml_.mistakes = diagnostics_.all();
    return std::move(xml_);
  }

 private:
  struct Open {
    std::string_view name;
    Place place;
  };

  Place place(std::size_t offset, std::size_t bytes) { return locator_.place(offset, bytes); }

  /// A mistake after which the rest of the text cannot be understood.
  [[noreturn]] void fail(const Place& where, std::string message, std::string hint = {},
                         std::vector<std::string> notes = {}) {
    diagnostics_.error(where, std::move(message), std::move(hint), std::move(notes));
    diagnostics_.throw_if_any();
    throw std::logic_error("unreachable");
  }

  bool looking_at(std::string_view text) const { return text_.substr(at_).starts_with(text); }

  void skip_blank() {
    while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
  }

  std::string_view take_name() {
    const std::size_t begin = at_;
    if (at_ < text_.size() && starts_name(text_[at_])) {
      while (at_ < text_.size() && in_name(text_[at_])) ++at_;
    }
    return text_.substr(begin, at_ - begin);
  }

  void blank_out(std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (xml_.text[i] != '\n') xml_.text[i] = ' ';
    }
  }

  void check_characters();
  void scan_text();
  void scan_markup();
  void scan_comment();
  void scan_instruction();
  void scan_declaration();
  void scan_end_tag();
  void scan_start_tag();
  void scan_attribute(ScannedTag& tag, std::string_view element, std::vector<std::string_view>& names);
  void scan_value(std::string_view name, ScannedAttribute& attribute);
  std::string unexpected(std::string_view element) const;
  void check_reference(std::size_t begin, std::size_t end);

  std::shared_ptr<const SourceFile> source_;
  std::string_view text_;
  Locator locator_;
  std::size_t at_ = 0;
  std::size_t start_ = 0;  ///< after the byte order mark
  std::vector<Open> open_;
  Open root_;
  bool closed_ = false;  ///< the root has ended
  Diagnostics diagnostics_;
  ScannedXml xml_;
};

void Scanner::check_characters() {
  for (std::size_t offset = 0; offset < text_.size();) {
    const std::optional<CodePoint> character = decode_utf8(text_, offset);
    if (!character) fail(place(offset, 1), "this is not UTF-8 text", "save the file as UTF-8");
    if (!is_character(character->value)) {
      fail(place(offset, 1), fmt::format("the character U+{:04X} is not allowed in XML",
                                         static_cast<std::uint32_t>(character->value)));
    }
    offset += character->bytes;
  }
}

/// Up to the next '<': white space only.
void Scanner::scan_text() {
  const std::size_t end = std::min(text_.find('<', at_), text_.size());
  std::string_view text = trim(text_.substr(at_, end - at_));
  if (!text.empty()) {
    text = text.substr(0, text.find('\n'));
    const Place where = place(static_cast<std::size_t>(text.data() - text_.data()), text.size());
    blank_out(at_, end);
    if (xml_.tags.empty()) {
      fail(where, "text before the first element: this is not an XML file");
    }
    diagnostics_.error(where, closed_ ? "text after the end of the root element" : "text between elements",
                       closed_ ? "" : "values are written as attributes: name=\"value\"");
  }
  at_ = end;
}

void Scanner::scan_markup() {
  if (looking_at("<!--")) return scan_comment();
  if (looking_at("<?")) return scan_instruction();
  if (looking_at("<!")) return scan_declaration();
  if (looking_at("</")) return scan_end_tag();
  scan_start_tag();
}

void Scanner::scan_comment() {
  const std::size_t begin = at_;
  const int line = place(begin, 4).line;
  const std::size_t close = text_.find("-->", begin + 4);
  if (close == std::string_view::npos) fail(place(begin, 4), "the comment is never closed", "--> is missing");
  const std::size_t dashes = text_.find("--", begin + 4);
  if (dashes < close) {
    diagnostics_.error(place(dashes, 2), "'--' may not stand inside a comment", "a comment ends in -->",
                       {fmt::format("the comment begins at line {}", line)});
  }
  at_ = close + 3;
  blank_out(begin, at_);
}

void Scanner::scan_instruction() {
  const std::size_t begin = at_;
  const std::size_t end = text_.find("?>", begin);
  if (end == std::string_view::npos)
    fail(place(begin, 2), "the instruction is never closed", "?> is missing");
  const std::string_view content = text_.substr(begin + 2, end - begin - 2);
  if (content.empty() || !starts_name(content.front()))
    fail(place(begin, 2), "an instruction needs a name after '<?'");
  if (content.starts_with("xml") && (content.size() == 3 || is_blank(content[3]))) {
    if (begin != start_) {
      fail(place(begin, 5), "<?xml ...?> may only stand at the very beginning of the file");
    }
    if (const std::size_t mark = content.find("encoding"); mark != std::string_view::npos) {
      const std::size_t quote = content.find_first_of("\"'", mark);
      const std::string_view rest = quote == std::string_view::npos ? "" : content.substr(quote + 1);
      std::string encoding(rest.substr(0, rest.find_first_of("\"'")));
      for (char& c : encoding) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
      if (encoding != "UTF-8" && encoding != "US-ASCII" && encoding != "ASCII") {
        fail(place(begin + 2 + mark, 8), fmt::format("the encoding '{}' is not supported", encoding),
             "save the file as UTF-8");
      }
    }
  }
  at_ = end + 2;
  blank_out(begin, at_);
}

/// "<!": CDATA is text; everything else belongs to document types.
void Scanner::scan_declaration() {
  constexpr std::string_view kCdata = "<![CDATA[";
  const std::size_t begin = at_;
  if (!looking_at(kCdata)) {
    fail(place(begin, 9), "document types (<!DOCTYPE>, <!ENTITY>, ...) are not supported", "remove it");
  }
  const std::size_t end = text_.find("]]>", begin);
  if (end == std::string_view::npos)
    fail(place(begin, kCdata.size()), "the CDATA is never closed", "]]> is missing");
  diagnostics_.error(place(begin, kCdata.size()), "text between elements",
                     "values are written as attributes: name=\"value\"");
  at_ = end + 3;
  blank_out(begin, at_);
}

void Scanner::scan_end_tag() {
  const std::size_t begin = at_;
  at_ += 2;
  const std::string_view name = take_name();
  const Place where = place(begin, name.size() + 3);
  if (open_.empty()) fail(where, fmt::format("</{}> closes nothing", name));
  if (name != open_.back().name) {
    fail(where, fmt::format("</{}> does not close <{}>", name, open_.back().name),
         fmt::format("expected </{}>", open_.back().name),
         {fmt::format("<{}> opens at line {}, column {}", open_.back().name, open_.back().place.line,
                      open_.back().place.column)});
  }
  skip_blank();
  if (!looking_at(">")) fail(where, fmt::format("</{}> has no closing '>'", name));
  ++at_;
  open_.pop_back();
  closed_ = open_.empty();
}

void Scanner::scan_start_tag() {
  const std::size_t begin = at_++;
  const std::string_view name = take_name();
  if (name.empty()) {
    fail(place(begin, 1), "'<' begins no element", "a name must follow; the sign itself is written &lt;");
  }
  ScannedTag tag{place(begin + 1, name.size()), {}};
  if (closed_) {
    fail(tag.name, fmt::format("<{}> is a second root element", name), "a file has one root element",
         {fmt::format("the root <{}> ends before; it begins at line {}", root_.name, root_.place.line)});
  }
  if (open_.size() >= kMaxXmlDepth) {
    fail(tag.name, fmt::format("elements are nested more than {} deep", kMaxXmlDepth));
  }
  if (xml_.tags.empty()) root_ = {name, tag.name};
  std::vector<std::string_view> names;
  for (;;) {
    const std::size_t before = at_;
    skip_blank();
    if (at_ >= text_.size() || looking_at("<")) {
      fail(tag.name, fmt::format("the tag <{}> is never closed", name), "'>' or '/>' is missing");
    }
    if (looking_at(">") || looking_at("/>")) break;
    if (before == at_) fail(place(at_, 1), unexpected(name), "attributes are separated by spaces");
    if (names.size() == kMaxXmlAttributes) {
      fail(place(at_, 1), fmt::format("<{}> has more than {} attributes", name, kMaxXmlAttributes));
    }
    scan_attribute(tag, name, names);
  }
  const bool empty = looking_at("/>");
  at_ += empty ? 2 : 1;
  if (!empty) open_.push_back({name, tag.name});
  closed_ = open_.empty();
  xml_.tags.push_back(std::move(tag));
}

std::string Scanner::unexpected(std::string_view element) const {
  const std::size_t bytes = decode_utf8(text_, at_)->bytes;  // the whole text has been checked
  return fmt::format("unexpected '{}' in the tag <{}>", text_.substr(at_, bytes), element);
}

void Scanner::scan_attribute(ScannedTag& tag, std::string_view element,
                             std::vector<std::string_view>& names) {
  const std::size_t begin = at_;
  const std::string_view name = take_name();
  if (name.empty()) fail(place(at_, 1), unexpected(element), "attributes look like name=\"value\"");
  ScannedAttribute attribute;
  attribute.name = place(begin, name.size());
  const bool twice = std::find(names.begin(), names.end(), name) != names.end();
  if (twice)
    diagnostics_.error(attribute.name, fmt::format("<{}> has the attribute '{}' twice", element, name));
  names.push_back(name);
  skip_blank();
  if (!looking_at("=")) {
    fail(attribute.name, fmt::format("the attribute '{}' has no value", name),
         fmt::format("{}=\"...\"", name));
  }
  ++at_;
  skip_blank();
  if (!looking_at("\"") && !looking_at("'")) {
    fail(attribute.name, fmt::format("the value of '{}' is not in quotes", name),
         fmt::format("{}=\"...\"", name));
  }
  scan_value(name, attribute);
  if (twice) return blank_out(begin, at_);
  tag.attributes.push_back(std::move(attribute));
}

/// At the opening quote; ends after the closing one.
void Scanner::scan_value(std::string_view name, ScannedAttribute& attribute) {
  const std::size_t quote = at_;
  const std::size_t end = text_.find(text_[quote], quote + 1);
  const std::size_t bad = text_.find('<', quote + 1);
  const std::string_view before_bad = text_.substr(quote, std::min(bad, text_.size()) - quote);
  if (end == std::string_view::npos || (bad < end && before_bad.find('\n') != std::string_view::npos)) {
    fail(place(quote, 1), fmt::format("the value of '{}' has no closing quote", name));
  }
  attribute.value = place(quote + 1, end - quote - 1);
  for (std::size_t i = quote + 1; i < end; ++i) {
    if (text_[i] == '<') {
      diagnostics_.error(place(i, 1), fmt::format("'<' inside the value of '{}'", name),
                         "it is written &lt;");
    }
    const std::size_t before = diagnostics_.size();
    if (text_.substr(i, end - i).starts_with("&&")) {
      diagnostics_.error(place(i, 2), "'&' by itself", "it is written &amp;; in an expression '&&' is 'and'");
      ++i;
    } else if (text_[i] == '&') {
      check_reference(i, end);
    }
    attribute.failed = attribute.failed || diagnostics_.size() != before;
    if (is_blank(text_[i])) xml_.text[i] = ' ';  // what XML demands of literal white space in a value
  }
  at_ = end + 1;
}

/// At '&' inside a value that goes up to `end`.
void Scanner::check_reference(std::size_t begin, std::size_t end) {
  constexpr std::array<std::string_view, 5> kEntities = {"lt", "gt", "amp", "quot", "apos"};
  constexpr std::size_t kLongest = 40;  // no reference is longer
  const std::string_view rest = text_.substr(begin + 1, std::min(end - begin - 1, kLongest));
  const std::size_t semicolon = rest.find(';');
  const std::string_view name = rest.substr(0, semicolon);
  if (semicolon == std::string_view::npos || name.empty() ||
      name.find_first_of(" \t\r\n&") != std::string_view::npos) {
    diagnostics_.error(place(begin, 1), "'&' by itself", "it is written &amp;");
    return;
  }
  const Place where = place(begin, name.size() + 2);
  if (!name.starts_with('#')) {
    if (std::find(kEntities.begin(), kEntities.end(), name) == kEntities.end()) {
      diagnostics_.error(where, fmt::format("unknown entity '&{};'", name),
                         "there are &lt; &gt; &amp; &quot; &apos; and &#number;");
    }
    return;
  }
  const bool hexadecimal = name.starts_with("#x");
  const std::string_view digits = name.substr(hexadecimal ? 2 : 1);
  std::uint32_t code = 0;
  const char* last = digits.data() + digits.size();
  const auto [stop, failure] = std::from_chars(digits.data(), last, code, hexadecimal ? 16 : 10);
  if (failure != std::errc{} || stop != last || !is_character(static_cast<char32_t>(code))) {
    diagnostics_.error(where, fmt::format("'&{};' is not a character", name));
    xml_.text[begin] = '?';  // the parser would make something of it
  }
}

}  // namespace

ScannedXml scan_xml(const std::shared_ptr<const SourceFile>& source) {
  return Scanner(source).scan();
}

}  // namespace coppice
