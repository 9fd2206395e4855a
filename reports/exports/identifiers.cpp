#include "reports/exports/identifiers.h"

#include <algorithm>
#include <array>

namespace coppice {
namespace {

/// Keywords of C++20 in the alphabet of axes, and names that the header has itself.
bool is_taken(const std::string& name) {
  static constexpr std::array kTaken = {"act",
                                        "alignas",
                                        "alignof",
                                        "and",
                                        "and_eq",
                                        "asm",
                                        "auto",
                                        "bitand",
                                        "bitor",
                                        "bool",
                                        "break",
                                        "case",
                                        "catch",
                                        "char",
                                        "char16_t",
                                        "char32_t",
                                        "char8_t",
                                        "class",
                                        "co_await",
                                        "co_return",
                                        "co_yield",
                                        "compl",
                                        "concept",
                                        "const",
                                        "const_cast",
                                        "consteval",
                                        "constexpr",
                                        "constinit",
                                        "continue",
                                        "decltype",
                                        "default",
                                        "delete",
                                        "detail",
                                        "do",
                                        "double",
                                        "dynamic_cast",
                                        "else",
                                        "enum",
                                        "explicit",
                                        "export",
                                        "extern",
                                        "false",
                                        "float",
                                        "for",
                                        "friend",
                                        "goto",
                                        "if",
                                        "inline",
                                        "int",
                                        "long",
                                        "mutable",
                                        "namespace",
                                        "new",
                                        "noexcept",
                                        "not",
                                        "not_eq",
                                        "nullptr",
                                        "operator",
                                        "or",
                                        "or_eq",
                                        "private",
                                        "protected",
                                        "public",
                                        "register",
                                        "reinterpret_cast",
                                        "requires",
                                        "return",
                                        "short",
                                        "signed",
                                        "sizeof",
                                        "static",
                                        "static_assert",
                                        "static_cast",
                                        "std",
                                        "struct",
                                        "switch",
                                        "template",
                                        "this",
                                        "thread_local",
                                        "throw",
                                        "true",
                                        "try",
                                        "typedef",
                                        "typeid",
                                        "typename",
                                        "union",
                                        "unsigned",
                                        "using",
                                        "virtual",
                                        "void",
                                        "volatile",
                                        "wchar_t",
                                        "while",
                                        "xor",
                                        "xor_eq"};
  return std::find(kTaken.begin(), kTaken.end(), name) != kTaken.end();
}

std::string identifier(const std::string& name) {
  std::string result;
  for (const char c : name) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    const bool digit = c >= '0' && c <= '9';
    if (result.empty() && digit) result = "axis_";
    if (letter || digit)
      result += c;
    else if (!result.empty() && result.back() != '_')
      result += '_';  // no two of them: reserved
  }
  if (result.empty()) result = "axis";
  return is_taken(result) ? result + (result.back() == '_' ? "axis" : "_") : result;
}

}  // namespace

std::vector<std::string> identifiers(const Space& axes) {
  std::vector<std::string> names;
  for (const Axis& axis : axes) {
    const std::string plain = identifier(axis.name);
    std::string name = plain;
    for (int i = 2; std::find(names.begin(), names.end(), name) != names.end(); ++i)
      name = plain + (plain.back() == '_' ? "" : "_") + std::to_string(i);
    names.push_back(std::move(name));
  }
  return names;
}

}  // namespace coppice
