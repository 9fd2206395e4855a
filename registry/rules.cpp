#include "registry/rules.h"

#include <utility>

#include "registry/error.h"

namespace coppice {
namespace {

std::string texts_of(const std::vector<BrokenRule>& rules) {
  std::string texts;
  for (const BrokenRule& rule : rules) {
    try {
      std::rethrow_exception(rule.why);
    } catch (const std::exception& why) {
      texts.append(texts.empty() ? "" : "\n").append(why.what());
    }
  }
  return texts;
}

}  // namespace

BrokenRules::BrokenRules(std::vector<BrokenRule> rules)
    : std::invalid_argument(texts_of(rules)), rules_(std::move(rules)) {}

void Rules::broken(std::string_view parameter, const std::string& message, const std::string& hint) {
  const ConfigError why({Diagnostic{{}, message, hint, {}}});
  broken_.push_back({std::string(parameter), std::make_exception_ptr(why)});
}

bool Rules::check(std::string_view parameter, const std::function<void()>& check) {
  try {
    check();
    return true;
  } catch (const BrokenRules& inner) {
    broken_.insert(broken_.end(), inner.all().begin(), inner.all().end());
  } catch (const std::invalid_argument&) {
    broken_.push_back({std::string(parameter), std::current_exception()});
  } catch (const std::runtime_error&) {
    broken_.push_back({std::string(parameter), std::current_exception()});
  }
  return false;
}

void Rules::enforce() const {
  if (!broken_.empty()) throw BrokenRules(broken_);
}

}  // namespace coppice
