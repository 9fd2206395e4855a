#pragma once

#include <exception>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace coppice {

/// A rule of a component that its parameters break, alone or with what it reads.
struct BrokenRule {
  std::string parameter;  ///< whose attribute the message stands at; empty: the component's element
  std::exception_ptr why;
};

/// All rules that a component breaks. what() is their texts.
class BrokenRules : public std::invalid_argument {
 public:
  explicit BrokenRules(std::vector<BrokenRule> rules);
  const std::vector<BrokenRule>& all() const { return rules_; }

 private:
  std::vector<BrokenRule> rules_;
};

/// Collects the rules that a component breaks, so that one pass reports all of them.
class Rules {
 public:
  void broken(std::string_view parameter, const std::string& message, const std::string& hint = {});
  /// `check` throws std::invalid_argument or std::runtime_error where the rule is broken; false then.
  bool check(std::string_view parameter, const std::function<void()>& check);
  /// Throws BrokenRules with everything collected, if there is anything.
  void enforce() const;

 private:
  std::vector<BrokenRule> broken_;
};

}  // namespace coppice
