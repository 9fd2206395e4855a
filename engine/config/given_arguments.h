#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "engine/config/experiment.h"

namespace coppice::config {

/// What the command line gives one argument.
struct GivenArgument {
  Override override;
  Attribute whole;                ///< the text after ":="
  std::vector<Attribute> values;  ///< its items
  bool taken = false;             ///< a file declares it
  bool swept = false;             ///< it has several values, and is not a list itself
  std::size_t chosen = 0;         ///< which value this pass of expansion takes

  const Attribute& value() const { return swept ? values[chosen] : whole; }
};

/// The arguments of a command line. Those given several values are swept: there is one pass of expansion for
/// each combination of them.
class GivenArguments {
 public:
  explicit GivenArguments(const std::vector<Override>& overrides);

  /// Null when the command line does not name it.
  GivenArgument* find(std::string_view name);
  /// Says that the argument was found to be swept.
  void sweep(GivenArgument& argument);

  const std::vector<GivenArgument*>& swept() const { return swept_; }
  /// Chooses the next combination, the last argument changing fastest; false after the last one.
  bool next_combination();
  std::vector<Override> taken() const;

 private:
  std::map<std::string, GivenArgument, std::less<>> arguments_;
  std::vector<std::string> order_;
  std::vector<GivenArgument*> swept_;  // in the order of their declarations
};

}  // namespace coppice::config
