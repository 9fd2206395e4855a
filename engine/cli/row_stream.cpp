#include "engine/cli/row_stream.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string_view>

namespace coppice::cli {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";  // as spreadsheets write it

/// Where the last whole record ends: after the last line end that is not inside quotes.
std::size_t end_of_records(const std::string& text) {
  std::size_t end = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '"') quoted = !quoted;
    if (text[i] == '\n' && !quoted) end = i + 1;
  }
  return end;
}

}  // namespace

bool RowStream::read_more() {
  char buffer[1 << 16];
  before_wait_();
  ssize_t count = 0;
  do {
    count = ::read(descriptor_, buffer, sizeof buffer);
  } while (count < 0 && errno == EINTR);
  if (count < 0) throw std::runtime_error(std::string("cannot read standard input: ") + std::strerror(errno));
  // Lines may end in CR LF; a lone CR is no line end and stays out of numbers by their own check.
  for (ssize_t i = 0; i < count; ++i) {
    if (buffer[i] == '\n' && pending_.ends_with('\r')) pending_.pop_back();
    pending_ += buffer[i];
  }
  return count > 0;
}

std::optional<std::string> RowStream::next() {
  std::size_t end = end_of_records(pending_);
  while (end == 0 && !ended_) {
    ended_ = !read_more();
    end = end_of_records(pending_);
  }
  if (end == 0) end = pending_.size();
  if (!begun_ && pending_.starts_with(kByteOrderMark)) {
    pending_.erase(0, kByteOrderMark.size());
    end -= kByteOrderMark.size();
  }
  begun_ = true;
  if (end == 0) return std::nullopt;
  std::string records = pending_.substr(0, end);
  pending_.erase(0, end);
  return records;
}

}  // namespace coppice::cli
