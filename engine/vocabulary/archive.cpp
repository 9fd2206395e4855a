#include "engine/vocabulary/archive.h"

#include <fmt/format.h>

#include <bit>
#include <cstring>
#include <stdexcept>
#include <type_traits>

namespace coppice {
namespace {

static_assert(std::endian::native == std::endian::little, "archives are written as they lie in memory");

constexpr std::string_view kTypeNames[] = {"float64", "float32", "int64", "int32", "uint8", "text"};

template <class V>
void append(std::string& out, V value) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  out.append(raw, sizeof value);
}

/// Takes pieces off the front of the bytes; never reads beyond their end.
class Bytes {
 public:
  explicit Bytes(std::string_view bytes) : rest_(bytes) {}

  std::string_view take(std::uint64_t n, std::string_view what) {
    if (n > rest_.size()) {
      throw std::runtime_error(fmt::format("arrays: {} needs {} bytes, {} are left", what, n, rest_.size()));
    }
    const std::string_view piece = rest_.substr(0, n);
    rest_.remove_prefix(n);
    return piece;
  }
  template <class V>
  V number(std::string_view what) {
    V value;
    std::memcpy(&value, take(sizeof value, what).data(), sizeof value);
    return value;
  }
  std::size_t left() const { return rest_.size(); }

 private:
  std::string_view rest_;
};

template <class V>
V read_array(Bytes& bytes, std::uint64_t items, std::string_view name) {
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
Archive::Array read_typed(std::size_t type, Bytes& bytes, std::uint64_t items, std::string_view name) {
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
  append<std::uint64_t>(out, arrays_.size());
  for (const auto& [name, array] : arrays_) {
    append(out, static_cast<std::uint32_t>(name.size()));
    out += name;
    append(out, static_cast<std::uint8_t>(array.index()));
    std::visit(
        [&out](const auto& items) {
          append<std::uint64_t>(out, items.size());
          const std::size_t size = items.size() * sizeof(items[0]);
          if (size > 0) out.append(reinterpret_cast<const char*>(items.data()), size);
        },
        array);
  }
  return out;
}

Archive Archive::from_bytes(std::string_view raw) {
  Bytes bytes(raw);
  Archive archive;
  std::string last;
  const auto count = bytes.number<std::uint64_t>("the number of arrays");
  for (std::uint64_t i = 0; i < count; ++i) {
    std::string name(bytes.take(bytes.number<std::uint32_t>("a name's length"), "a name"));
    if (i > 0 && name <= last) throw std::runtime_error("arrays: the names are not in order");
    const std::size_t type = bytes.number<std::uint8_t>("a type");
    const auto items = bytes.number<std::uint64_t>("a number of items");
    archive.arrays_.emplace(name, read_typed(type, bytes, items, name));
    last = std::move(name);
  }
  if (bytes.left() > 0)
    throw std::runtime_error(fmt::format("arrays: {} bytes follow the last one", bytes.left()));
  return archive;
}

}  // namespace coppice
