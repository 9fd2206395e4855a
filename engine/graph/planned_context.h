#pragma once

#include <map>
#include <string>
#include <vector>

#include "engine/graph/plan.h"

namespace coppice {

/// A node's context as far as the plan knows it: for Node::check, and as the base of the running context.
class PlannedContext : public NodeContext {
 public:
  /// With a run folder, the inputs have their folders; without, they are only elements.
  PlannedContext(const Plan& plan, std::size_t node, const std::filesystem::path& run_folder = {});

  const std::vector<InputNode>& inputs(std::string_view parameter) const override;
  const Point& point() const override { return node_.point; }
  std::optional<int> replicate() const override { return node_.replicate; }
  Draws draws() const override;
  const std::string& key() const override { return node_.key; }
  const std::string& stream() const override;

  // While checking there is nothing to write to; these throw std::logic_error.
  const std::filesystem::path& folder() const override;
  Parallel& parallel() override;
  void count(std::string_view what, std::int64_t amount) override;
  void measure(std::string_view what, double value) override;
  void progress(std::int64_t done, std::int64_t total) override;
  std::optional<Archive> checkpoint() override;
  void save_checkpoint(const Archive& archive) override;

 protected:
  const PlannedNode& planned() const { return node_; }

 private:
  const PlannedNode& node_;
  std::uint64_t seed_;
  std::map<std::string, std::vector<InputNode>, std::less<>> inputs_;
};

}  // namespace coppice
