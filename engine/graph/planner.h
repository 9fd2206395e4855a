#pragma once

#include "engine/graph/declared.h"
#include "engine/graph/join.h"
#include "engine/graph/plan.h"

namespace coppice {

/// Turns declared nodes into planned ones: fan-out, replicates, joining of inputs. Mistakes go to
/// `diagnostics`; nodes with a mistake, and those that read them, are left out.
class Planner {
 public:
  Planner(Declarations& declarations, Plan& plan, Diagnostics& diagnostics);
  void make_nodes();

 private:
  struct Variant;

  void expand(std::size_t declared, DeclaredElement& element);
  std::vector<Variant> variants(DeclaredElement& element);
  bool fan_out(DeclaredElement& element, const DeclaredReference& reference, std::vector<Variant>& variants);
  bool add(std::size_t declared, DeclaredElement& element, const Variant& variant);
  bool join(const DeclaredElement& element, const DeclaredReference& reference, PlannedNode& node);
  bool check_match(const DeclaredElement& element, const DeclaredReference& reference,
                   const DeclaredTarget& target, const PlannedNode& reader,
                   const std::vector<std::size_t>& found);
  std::string over_hint(const DeclaredElement& element, const std::vector<std::string>& missing) const;

  Declarations& declarations_;
  Plan& plan_;
  Diagnostics& diagnostics_;
  JoinIndex index_;
  std::map<std::string, std::map<std::string, std::string>> units_;  // SI units of the columns of each sweep
};

}  // namespace coppice
