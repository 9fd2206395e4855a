#pragma once

#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>

namespace coppice {

// Binary files: numbers little-endian, a text as its length (u32) and its bytes.

static_assert(std::endian::native == std::endian::little, "numbers are written as they lie in memory");

template <class V>
void append_number(std::string& out, V value) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  out.append(raw, sizeof value);
}

inline void append_text(std::string& out, std::string_view text) {
  append_number(out, static_cast<std::uint32_t>(text.size()));
  out += text;
}

/// Takes pieces off the front of some bytes. Throws std::runtime_error naming the piece when there are too
/// few left.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : rest_(bytes) {}

  std::string_view take(std::uint64_t size, std::string_view what) {
    if (size > rest_.size()) {
      throw std::runtime_error(fmt::format("{} needs {} bytes, {} are left", what, size, rest_.size()));
    }
    const std::string_view piece = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return piece;
  }
  template <class V>
  V number(std::string_view what) {
    V value;
    std::memcpy(&value, take(sizeof value, what).data(), sizeof value);
    return value;
  }
  std::string text(std::string_view what) { return std::string(take(number<std::uint32_t>(what), what)); }
  std::size_t left() const { return rest_.size(); }

 private:
  std::string_view rest_;
};

}  // namespace coppice
