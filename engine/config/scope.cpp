#include "engine/config/scope.h"

namespace coppice::config {

const Definition* Scope::find_here(std::string_view name) const {
  const auto found = own_.find(name);
  return found == own_.end() ? nullptr : &found->second;
}

const Definition* Scope::find_before(const Scope& limit, std::string_view name) const {
  for (const Scope* scope = this; scope != nullptr && scope != &limit; scope = scope->outer_.get()) {
    if (const Definition* found = scope->find_here(name)) return found;
  }
  return nullptr;
}

Scope::Found Scope::find(std::string_view name) const {
  for (const Scope* scope = this; scope != nullptr; scope = scope->outer_.get()) {
    if (const Definition* found = scope->find_here(name)) return {&found->value, found->failed};
    if (scope->columns_ == nullptr) continue;
    for (const ColumnValue& column : *scope->columns_) {
      if (*column.name == name) return {column.value, false};
    }
  }
  return {};
}

std::vector<std::string> Scope::names() const {
  std::vector<std::string> all;
  for (const Scope* scope = this; scope != nullptr; scope = scope->outer_.get()) {
    for (const auto& [name, definition] : scope->own_) all.push_back(name);
    if (scope->columns_ == nullptr) continue;
    for (const ColumnValue& column : *scope->columns_) all.push_back(*column.name);
  }
  return all;
}

}  // namespace coppice::config
