#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "engine/data/file_system.h"
#include "engine/data/table_file.h"
#include "engine/graph/key.h"
#include "tests/support/example.h"
#include "tests/support/make.h"
#include "tests/support/places.h"

namespace coppice {

// A golden is what a component does, kept in tests/golden/<interface>s/<name>.csv. One that changes must be
// meant, and is then said by raising the version of a component that it is made of. COPPICE_UPDATE_GOLDENS=1
// build/test_conformance writes goldens; COPPICE_GOLDEN_DIR names another folder for them (for components
// from elsewhere).

constexpr double kGoldenTolerance = 1e-9;  // relative; across compilers and machines

inline std::filesystem::path golden_folder(std::string interface) {
  const char* given = std::getenv("COPPICE_GOLDEN_DIR");
  const std::filesystem::path own = source_folder() / "tests/golden";
  if (interface.back() == 'y') interface.replace(interface.size() - 1, 1, "ie");
  return (given != nullptr ? std::filesystem::path(given) : own) / (interface + "s");
}

/// The component that a golden is made with: the element in <name>.xml beside it, where there is one (as for
/// solvers whose defaults learn for long), else the component's example.
template <class Interface>
Sub<Interface> make_for_golden(const std::string& name) {
  const std::filesystem::path file = golden_folder(Interface::kInterface) / (name + ".xml");
  return std::filesystem::exists(file) ? make_from_xml<Interface>(read_file(file))
                                       : make_example<Interface>(name);
}

/// "2; extra_trees 1": the version of a component, then those of its parts.
template <class Interface>
std::string versions_of(const Sub<Interface>& made) {
  std::string key, versions;
  FileHashes files;
  Diagnostics diagnostics;
  add_component(key, "", Interface::kInterface, made.resolved, files, diagnostics);
  diagnostics.throw_if_any();
  for (const auto& [place, value] : key_lines(key)) {
    const std::size_t slash = value.rfind('/');
    const std::string number = slash == std::string::npos ? "" : value.substr(slash + 1);
    if (number.empty() || number.find_first_not_of("0123456789") != std::string::npos) continue;
    versions += versions.empty() ? number : "; " + value.substr(0, slash) + " " + number;
  }
  return versions;
}

/// Where two tables differ; empty when they do not.
inline std::string golden_difference(const Table& golden, const Table& now) {
  for (const ColumnInfo& column : now.columns) {
    if (!golden.has(column.name)) return "the golden has no column '" + column.name + "'";
  }
  if (golden.columns.size() != now.columns.size() + 1) return "the golden has other columns";  // + version
  if (golden.rows.size() != now.rows.size()) return "the golden has another number of rows";
  for (std::size_t row = 0; row < now.rows.size(); ++row) {
    for (std::size_t c = 0; c < now.columns.size(); ++c) {
      const Cell& was = golden.rows[row][golden.column(now.columns[c].name)];
      const Cell& is = now.rows[row][c];
      const double a = number(was), b = number(is);
      const bool equal = std::isnan(a) || std::isnan(b)
                             ? cell_text(was) == cell_text(is)
                             : std::fabs(a - b) <= kGoldenTolerance * std::max(1.0, std::fabs(a));
      if (equal) continue;
      return fmt::format("row {}: {} was {}, is {}", row + 1, now.columns[c].name, cell_text(was),
                         cell_text(is));
    }
  }
  return "";
}

/// Fails unless the golden of the component is `now`, or there is none; writes it where that is asked for.
inline void expect_golden(const std::string& interface, const std::string& name, Table now,
                          const std::string& versions) {
  const std::filesystem::path file = golden_folder(interface) / (name + ".csv");
  const bool update = std::getenv("COPPICE_UPDATE_GOLDENS") != nullptr;
  ASSERT_TRUE(update || std::filesystem::exists(file))
      << interface << " <" << name
      << "> has no golden; COPPICE_UPDATE_GOLDENS=1 build/test_conformance writes it";
  if (std::filesystem::exists(file)) {
    const Table golden = read_table(file);
    const bool has_version = golden.has("version") && !golden.rows.empty();
    const std::string before = has_version ? cell_text(golden.rows[0][golden.column("version")]) : "";
    const std::string what = golden_difference(golden, now);
    if (what.empty() && before == versions) return;
    ASSERT_TRUE(what.empty() || before != versions)
        << what
        << "; if this is meant, raise the component's version (cached results are then computed anew), "
        << "then COPPICE_UPDATE_GOLDENS=1 build/test_conformance";
    ASSERT_TRUE(update) << "the golden is of version " << before << ", the component of " << versions
                        << "; COPPICE_UPDATE_GOLDENS=1 build/test_conformance writes it anew";
  }
  now.columns.push_back({"version", ColumnInfo::Type::text, "", "Versions of the component and its parts."});
  for (std::vector<Cell>& row : now.rows) row.emplace_back(versions);
  std::filesystem::create_directories(file.parent_path());
  write_table(file, now);
  std::filesystem::remove(golden_folder(interface) / (name + ".schema.json"));
}

/// A table of named numbers, for goldens that are no table by nature.
class NamedValues {
 public:
  void add(std::string what, double value) { table_.rows.push_back({std::move(what), value}); }
  Table table() const { return table_; }

 private:
  Table table_{{{"what", ColumnInfo::Type::text, "", ""}, {"value", ColumnInfo::Type::number, "", ""}}, {}};
};

}  // namespace coppice
