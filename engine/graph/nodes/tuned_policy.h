#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/vocabulary/space.h"
#include "registry/source.h"

namespace coppice {

/// A configured policy some of whose numbers are free: the items of parameters that are numbers or lists of
/// numbers, one after the other.
class TunedPolicy {
 public:
  /// `policy` is resolved. Throws std::invalid_argument for parameters that the policy does not have, and for
  /// those that have no numbers to begin with.
  TunedPolicy(Element policy, const std::vector<std::string>& parameters);

  /// An axis for each free number: `gain`, or `gains_0`, `gains_1` of a list; in SI units, its limits those
  /// declared.
  const Space& box() const { return box_; }
  const std::vector<double>& configured() const { return configured_; }
  /// The policy's element with these numbers.
  Element at(std::span<const double> numbers) const;

 private:
  struct Part {
    std::string parameter;
    std::size_t numbers = 0;
  };
  void add(const std::string& parameter);

  Element policy_;
  std::vector<Part> parts_;
  Space box_;
  std::vector<double> configured_;
};

}  // namespace coppice
