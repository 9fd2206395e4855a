#include "engine/vocabulary/archive.h"

#include <fmt/format.h>

#include <cstring>
#include <stdexcept>
#include <type_traits>

#include "engine/vocabulary/bytes.h"

namespace coppice {
namespace {

constexpr std::string_view kTypeNames[] = {"float64", "float32", "int64", "int32", "uint8", "text"};

template <class V>
V read_array(ByteReader& bytes, std::uint64_t items, std::string_view name) {
  using Item = typename V::value_type;
  if (items > bytes.left() / sizeof(Item)) {
    throw std::runtime_error(
        fmt::format("arrays: '{}' has {} items, more than there are bytes", name, items));
  }
  V array(items, Item{});
  const std::string_view raw = bytes.take(items * sizeof(Item), name);
  if (!raw.empty()) std::memcpy(array.data(), raw.data(), raw.size());
  return array;
}

template <std::size_t I = 0>
Archive::Array read_typed(std::size_t type, ByteReader& bytes, std::uint64_t items, std::string_view name) {
  if constexpr (I == std::variant_size_v<Archive::Array>) {
    throw std::runtime_error(fmt::format("arrays: '{}' has the unknown type {}", name, type));
  } else {
    if (type == I) return read_array<std::variant_alternative_t<I, Archive::Array>>(bytes, items, name);
    return read_typed<I + 1>(type, bytes, items, name);
  }
}

}  // namespace

bool Archive::has(std::string_view name) const {
  return arrays_.contains(prefix_ + std::string(name));
}

const Archive::Array& Archive::find(std::string_view name) const {
  const auto found = arrays_.find(prefix_ + std::string(name));
  if (found == arrays_.end())
    throw std::runtime_error(fmt::format("there is no array '{}{}'", prefix_, name));
  return found->second;
}

void Archive::wrong_type(std::string_view name) const {
  throw std::runtime_error(fmt::format("array '{}{}' has the type {}, another is expected", prefix_, name,
                                       kTypeNames[find(name).index()]));
}

Archive::Scope::Scope(Archive& archive, std::string_view name)
    : archive_(archive), length_(archive.prefix_.size()) {
  archive_.prefix_ += name;
  archive_.prefix_ += '/';
}

Archive::Scope::~Scope() {
  archive_.prefix_.resize(length_);
}

// Layout: number of arrays (u64), then for each its name (u32 length, bytes), type (u8, index into Array),
// number of items (u64) and items. Everything little-endian; names strictly ascending.
std::string Archive::bytes() const {
  std::string out;
  append_number<std::uint64_t>(out, arrays_.size());
  for (const auto& [name, array] : arrays_) {
    append_text(out, name);
    append_number(out, static_cast<std::uint8_t>(array.index()));
    std::visit(
        [&out](const auto& items) {
          append_number<std::uint64_t>(out, items.size());
          const std::size_t size = items.size() * sizeof(items[0]);
          if (size > 0) out.append(reinterpret_cast<const char*>(items.data()), size);
        },
        array);
  }
  return out;
}

Archive Archive::from_bytes(std::string_view raw) {
  ByteReader bytes(raw);
  Archive archive;
  std::string last;
  const auto count = bytes.number<std::uint64_t>("the number of arrays");
  for (std::uint64_t i = 0; i < count; ++i) {
    std::string name = bytes.text("an array's name");
    if (i > 0 && name <= last) throw std::runtime_error("arrays: the names are not in order");
    const std::size_t type = bytes.number<std::uint8_t>("an array's type");
    const auto items = bytes.number<std::uint64_t>("an array's size");
    archive.arrays_.emplace(name, read_typed(type, bytes, items, name));
    last = std::move(name);
  }
  if (bytes.left() > 0)
    throw std::runtime_error(fmt::format("arrays: {} bytes follow the last one", bytes.left()));
  return archive;
}

}  // namespace coppice
