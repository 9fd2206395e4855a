#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace coppice {

/// Named typed arrays: what a learned object or a half-done training consists of besides its parameters.
/// Names are paths ("trees/0/split"); nested objects add a prefix. Reading checks names, types and sizes and
/// throws std::runtime_error with what is wrong, so that no damaged file can crash a reader that validates
/// its own indices.
class Archive {
 public:
  using Array = std::variant<std::vector<double>, std::vector<float>, std::vector<std::int64_t>,
                             std::vector<std::int32_t>, std::vector<std::uint8_t>, std::string>;

  template <class V>
  void put(std::string_view name, V array) {
    arrays_.insert_or_assign(prefix_ + std::string(name), Array(std::move(array)));
  }
  template <class V>
  const V& get(std::string_view name) const {
    const Array& array = find(name);
    if (const V* typed = std::get_if<V>(&array)) return *typed;
    wrong_type(name);
  }
  bool has(std::string_view name) const;
  /// All arrays with their full names, sorted.
  const std::map<std::string, Array, std::less<>>& arrays() const { return arrays_; }

  /// While alive, names are taken below `name/`.
  class Scope {
   public:
    Scope(Archive& archive, std::string_view name);
    ~Scope();
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    Archive& archive_;
    std::size_t length_;
  };

  /// Little-endian bytes, sorted by name: equal content gives equal bytes.
  std::string bytes() const;
  /// Throws std::runtime_error for anything that bytes() did not write.
  static Archive from_bytes(std::string_view bytes);

 private:
  const Array& find(std::string_view name) const;
  [[noreturn]] void wrong_type(std::string_view name) const;

  std::map<std::string, Array, std::less<>> arrays_;
  std::string prefix_;
};

}  // namespace coppice
