#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>

namespace coppice {

/// A message in Protocol Buffers' wire format (protobuf.dev/programming-guides/encoding), built field by
/// field. The order of fields is that of the calls. Little-endian machines only, as the project.
class ProtobufMessage {
 public:
  /// int32, int64, bool, enum.
  ProtobufMessage& integer(std::uint32_t field, std::int64_t value) {
    tag(field, 0);
    varint(static_cast<std::uint64_t>(value));
    return *this;
  }
  ProtobufMessage& real(std::uint32_t field, float value) {
    tag(field, 5);
    append_floats({&value, 1});
    return *this;
  }
  /// string, bytes.
  ProtobufMessage& text(std::uint32_t field, std::string_view value) {
    tag(field, 2);
    varint(value.size());
    bytes_.append(value);
    return *this;
  }
  ProtobufMessage& message(std::uint32_t field, const ProtobufMessage& value) {
    return text(field, value.bytes_);
  }
  /// Repeated int64, packed.
  ProtobufMessage& integers(std::uint32_t field, std::span<const std::int64_t> values) {
    ProtobufMessage packed;
    for (const std::int64_t value : values) packed.varint(static_cast<std::uint64_t>(value));
    return message(field, packed);
  }
  /// Repeated float, packed.
  ProtobufMessage& reals(std::uint32_t field, std::span<const float> values) {
    ProtobufMessage packed;
    packed.append_floats(values);
    return message(field, packed);
  }

  const std::string& bytes() const { return bytes_; }

 private:
  void tag(std::uint32_t field, std::uint32_t wire_type) { varint(std::uint64_t{field} << 3 | wire_type); }
  void varint(std::uint64_t value) {
    for (; value >= 0x80; value >>= 7) bytes_ += static_cast<char>(value | 0x80);
    bytes_ += static_cast<char>(value);
  }
  void append_floats(std::span<const float> values) {
    bytes_.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
  }

  std::string bytes_;
};

}  // namespace coppice
