#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "engine/config/files.h"
#include "engine/config/scope.h"
#include "engine/config/text_template.h"

namespace coppice::config {

/// Works out the values of attributes, which must stay where they are in memory: each is parsed once. Reports
/// what is wrong at its place inside the attribute.
class Evaluator {
 public:
  Evaluator(const Files& files, Diagnostics& diagnostics) : files_(files), diagnostics_(diagnostics) {}

  /// The typed value. Nothing after a mistake, which was then reported.
  std::optional<Value> value(const Attribute& attribute, const Context& context);
  std::optional<std::string> text(const Attribute& attribute, const Context& context);
  /// The attribute with its text worked out and its places traced; marked as failed after a mistake.
  Attribute attribute(const Attribute& raw, const Context& context);

  /// Tells apart a misspelt name from the column of a sweep used outside of its nodes.
  void add_column(const std::string& column, const std::string& sweep) { columns_[column].insert(sweep); }

  Diagnostics& diagnostics() { return diagnostics_; }
  /// Reports a mistake in an attribute, at the characters [offset, offset + length) of its value.
  void error(const Attribute& attribute, const Context& context, std::size_t offset, std::size_t length,
             std::string message, std::string hint = {});

 private:
  class ContextNames;

  const TextTemplate& compiled(const Attribute& attribute);
  void report(const Attribute& attribute, const Context& context, const std::vector<ExpressionError>& errors);
  ExpressionError unknown_name(std::string_view name, std::size_t offset, const Attribute& attribute,
                               const Context& context);

  const Files& files_;
  Diagnostics& diagnostics_;
  std::unordered_map<const Attribute*, TextTemplate>
      compiled_;  // attributes of loaded files, which stay in place
  std::unordered_map<const Attribute*, int> failures_;
  std::map<std::string, std::set<std::string>> columns_;
  std::set<std::string> circular_;  // names of the definitions whose circle was reported
};

/// A place with the way that expansion took to it.
Place traced(const Place& place, const Context& context);

}  // namespace coppice::config
