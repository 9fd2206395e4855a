#include "registry/suggest.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <system_error>
#include <utility>

#include "registry/text.h"

namespace coppice {
namespace {

/// Lower case, with '-' and ' ' as '_': spellings that people mix up.
std::string fold(std::string_view name) {
  std::string folded(name);
  for (char& c : folded) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    if (c == '-' || c == ' ') c = '_';
  }
  return folded;
}

/// Damerau-Levenshtein distance in its restricted form (optimal string alignment): insertions, deletions,
/// substitutions and swaps of neighbours.
std::size_t distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const bool same = a[i - 1] == b[j - 1];
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (same ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        row[j] = std::min(row[j], before[j - 2] + 1);
      }
    }
    std::swap(before, last);
    std::swap(last, row);
  }
  return last[b.size()];
}

constexpr std::size_t kLongestName = 200;  // beyond that nobody mistyped a name

}  // namespace

std::string nearest(std::string_view given, const std::vector<std::string>& known) {
  const std::string name = fold(given);
  if (name.empty() || name.size() > kLongestName) return "";
  const std::size_t allowed = std::max<std::size_t>(1, (name.size() + 1) / 3);
  std::size_t best = allowed + 1;
  std::string found;
  for (const std::string& candidate : known) {
    const std::size_t d = distance(name, fold(candidate));
    // A name of two letters with one wrong resembles everything.
    if (d < best && d < std::max(name.size(), candidate.size()) && (d == 0 || name.size() > 1)) {
      best = d;
      found = candidate;
    }
  }
  if (!found.empty() || name.size() < 3) return found;
  for (const std::string& candidate : known) {  // an abbreviation, when only one name begins so
    if (!fold(candidate).starts_with(name)) continue;
    if (!found.empty()) return "";
    found = candidate;
  }
  return found;
}

std::string suggestion(std::string_view given, const std::vector<std::string>& known) {
  constexpr std::size_t kShown = 12;
  if (const std::string name = nearest(given, known); !name.empty()) {
    return fmt::format("did you mean '{}'?", name);
  }
  if (known.empty()) return "";
  const auto shown = std::min(kShown, known.size());
  std::string text = "valid: " + join({known.begin(), known.begin() + static_cast<std::ptrdiff_t>(shown)});
  if (known.size() > shown) text += fmt::format(" and {} more", known.size() - shown);
  return text;
}

std::string nearest_file(const std::string& path) {
  const std::filesystem::path missing(path);
  const std::filesystem::path folder = missing.has_parent_path() ? missing.parent_path() : ".";
  std::vector<std::string> names;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());  // folders list their files in any order
  return nearest(missing.filename().string(), names);
}

}  // namespace coppice
