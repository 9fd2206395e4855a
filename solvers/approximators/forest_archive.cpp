#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "solvers/approximators/forest.h"

namespace coppice {
namespace {

[[noreturn]] void invalid(std::string_view why) {
  throw std::runtime_error(fmt::format("not a valid forest: {}", why));
}

bool all_finite(std::span<const double> values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

/// Calls reach(node, parent, output) for all nodes, parents first; the parent of a root is -1. Every node
/// must be a root or the child of exactly one node before it, so that nothing can loop or grow when it is
/// walked.
template <class Reach>
void walk(const std::vector<ForestNode>& nodes, const std::vector<std::uint32_t>& roots, std::size_t outputs,
          const Reach& reach) {
  if (roots.empty() || roots.size() % outputs != 0) invalid("number of trees");
  const std::size_t trees = roots.size() / outputs;
  std::vector<std::int64_t> output_of(nodes.size(), -1);
  const auto visit = [&](std::size_t node, std::int64_t parent, std::int64_t output) {
    if (node >= nodes.size()) invalid("a node that does not exist");
    if (output_of[node] >= 0) invalid("a node is used twice");
    output_of[node] = output;
    reach(node, parent, static_cast<std::size_t>(output));
  };
  for (std::size_t i = 0; i < roots.size(); ++i) visit(roots[i], -1, static_cast<std::int64_t>(i / trees));
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (output_of[i] < 0) invalid("a node that no tree reaches");
    if (nodes[i].ahead() == 0) continue;
    visit(i + nodes[i].ahead(), static_cast<std::int64_t>(i), output_of[i]);
    visit(i + nodes[i].ahead() + 1, static_cast<std::int64_t>(i), output_of[i]);
  }
}

/// The arrays of versions before 0.2: nodes in double precision, with numbers of their children.
struct FirstFormat {
  const std::vector<double>& values;
  const std::vector<std::int32_t>& features;
  const std::vector<std::int32_t>& children;
  const std::vector<double>& models;
};

ForestNode converted(const FirstFormat& old, std::size_t i, std::size_t inputs, LeafModel leaf) {
  const std::int64_t ahead = std::int64_t{old.children[i]} - static_cast<std::int64_t>(i);
  if (ahead < 0 || ahead > ForestNode::kMaxAhead) invalid("children that do not follow their parent");
  if (old.features[i] < 0 || old.features[i] > static_cast<std::int64_t>(inputs))
    invalid("a split of no input");
  const bool is_leaf = old.features[i] == static_cast<std::int64_t>(inputs);
  if (is_leaf != (ahead == 0)) invalid("a leaf with children");
  if (!is_leaf) {
    return ForestNode::split(static_cast<std::uint32_t>(old.features[i]), static_cast<float>(old.values[i]),
                             static_cast<std::uint32_t>(ahead));
  }
  const double value = old.values[i];
  if (leaf == LeafModel::constant) return ForestNode::leaf(inputs, 0);
  const std::size_t rows = old.models.size() / model_width(inputs);
  if (!(value >= 0 && value < static_cast<double>(rows) && value == std::floor(value)))
    invalid("a leaf without its model");
  return ForestNode::linear_leaf(inputs, static_cast<std::uint32_t>(value));
}

}  // namespace

void Forest::save(Archive& archive) const {
  check_numbers();  // what cannot be read again is not written
  std::vector<double> scales;
  for (const OutputScale& scale : scales_) scales.insert(scales.end(), {scale.offset, scale.scale});
  std::vector<float> values(nodes_.size());
  std::vector<std::int32_t> links(nodes_.size());
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const bool has_row = leaf_ == LeafModel::linear && nodes_[i].ahead() == 0;  // the next one
    values[i] = has_row ? 0.0F : nodes_[i].value;
    links[i] = std::bit_cast<std::int32_t>(nodes_[i].link);
  }
  std::vector<std::int64_t> shape = {static_cast<std::int64_t>(inputs_), static_cast<std::int64_t>(outputs()),
                                     static_cast<std::int64_t>(leaf_)};
  // Versions that know no other aggregation than the mean read forests of means, and refuse others.
  if (aggregation_ != Aggregation::mean) shape.push_back(static_cast<std::int64_t>(aggregation_));
  archive.put("shape", std::move(shape));
  archive.put("scales", std::move(scales));
  archive.put("roots", std::vector<std::int64_t>(roots_.begin(), roots_.end()));
  archive.put("values", std::move(values));
  archive.put("links", std::move(links));
  archive.put("models", models_);
  // Versions that know no directions find that leaves are none, and refuse the forest.
  if (!directions_.empty()) archive.put("directions", directions_.rows());
}

void Forest::load_directions(const Archive& archive) {
  const auto& rows = archive.get<std::vector<double>>("directions");
  const std::size_t width = inputs_ + 1;
  if (rows.empty() || rows.size() % width != 0 || inputs_ + rows.size() / width > kMaxTreeInputs)
    invalid("number of directions");
  if (!all_finite(rows)) invalid("a direction that is not finite");
  directions_.clear(inputs_);
  for (std::size_t at = 0; at < rows.size(); at += width)
    std::copy_n(rows.begin() + static_cast<std::ptrdiff_t>(at), width, directions_.add());
}

Forest Forest::load(const Archive& archive) {
  const auto& shape = archive.get<std::vector<std::int64_t>>("shape");
  if (shape.size() != 3 && shape.size() != 4) invalid("its shape needs three or four numbers");
  if (shape[0] < 0 || shape[0] > static_cast<std::int64_t>(kMaxTreeInputs)) invalid("number of inputs");
  if (shape[1] < 1 || shape[1] > std::numeric_limits<std::int32_t>::max()) invalid("number of outputs");
  if (shape[2] != 0 && shape[2] != 1) invalid("unknown kind of leaf");
  if (shape.size() == 4 && shape[3] != 0 && shape[3] != 1) invalid("unknown aggregation");
  const auto inputs = static_cast<std::size_t>(shape[0]);
  const auto outputs = static_cast<std::size_t>(shape[1]);
  const auto leaf = static_cast<LeafModel>(shape[2]);
  if (archive.has("features")) return load_first_format(archive, inputs, outputs, leaf);

  const auto& scales = archive.get<std::vector<double>>("scales");
  const auto& roots = archive.get<std::vector<std::int64_t>>("roots");
  const auto& values = archive.get<std::vector<float>>("values");
  const auto& links = archive.get<std::vector<std::int32_t>>("links");
  if (scales.size() != 2 * outputs) invalid("number of scales");
  if (links.size() != values.size()) invalid("arrays differ in length");
  Forest forest(inputs, {}, leaf);
  if (shape.size() == 4) forest.aggregation_ = static_cast<Aggregation>(shape[3]);
  if (archive.has("directions")) forest.load_directions(archive);
  for (std::size_t i = 0; i < outputs; ++i) forest.scales_.push_back({scales[2 * i], scales[2 * i + 1]});
  for (const std::int64_t root : roots) {
    if (root < 0 || root >= static_cast<std::int64_t>(values.size())) invalid("a node that does not exist");
    forest.roots_.push_back(static_cast<std::uint32_t>(root));
  }
  std::uint32_t rows = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    ForestNode node{values[i], std::bit_cast<std::uint32_t>(links[i])};
    if (leaf == LeafModel::linear && node.ahead() == 0)
      node = ForestNode::linear_leaf(node.feature(), rows++);
    forest.nodes_.push_back(node);
  }
  forest.models_ = archive.get<std::vector<double>>("models");
  forest.check();
  forest.make_tops();
  return forest;
}

Forest Forest::load_first_format(const Archive& archive, std::size_t inputs, std::size_t outputs,
                                 LeafModel leaf) {
  const FirstFormat old{
      archive.get<std::vector<double>>("values"), archive.get<std::vector<std::int32_t>>("features"),
      archive.get<std::vector<std::int32_t>>("children"), archive.get<std::vector<double>>("models")};
  const std::size_t size = old.values.size();
  if (old.features.size() != size || old.children.size() != size) invalid("arrays differ in length");
  if (!all_finite(old.values)) invalid("a value that is not finite");
  Forest forest(inputs, {}, leaf);
  for (const std::int32_t root : archive.get<std::vector<std::int32_t>>("roots")) {
    if (root < 0) invalid("a node that does not exist");
    forest.roots_.push_back(static_cast<std::uint32_t>(root));
  }
  const auto width = static_cast<std::ptrdiff_t>(model_width(inputs));
  for (std::size_t i = 0; i < size; ++i) {
    ForestNode node = converted(old, i, inputs, leaf);
    if (leaf == LeafModel::linear && node.ahead() == 0) {  // models in the order of leaves
      const auto row = old.models.begin() + static_cast<std::ptrdiff_t>(node.row()) * width;
      const std::size_t rows = forest.models_.size() / static_cast<std::size_t>(width);
      forest.models_.insert(forest.models_.end(), row, row + width);
      node = ForestNode::linear_leaf(inputs, static_cast<std::uint32_t>(rows));
    }
    forest.nodes_.push_back(node);
  }
  forest.scales_.resize(outputs);
  if (leaf == LeafModel::constant) {
    std::vector<std::size_t> output_of(size);
    std::vector<ValueRange> ranges(outputs);
    walk(forest.nodes_, forest.roots_, outputs, [&](std::size_t node, std::int64_t, std::size_t output) {
      output_of[node] = output;
      if (forest.nodes_[node].ahead() == 0) ranges[output].include(old.values[node]);
    });
    for (std::size_t i = 0; i < outputs; ++i) forest.scales_[i] = ranges[i].scale();
    for (std::size_t i = 0; i < size; ++i) {
      if (forest.nodes_[i].ahead() != 0) continue;
      forest.nodes_[i].value = forest.scales_[output_of[i]].packed(old.values[i]);
    }
  }
  forest.check();
  forest.make_tops();
  return forest;
}

void Forest::check_numbers() const {
  for (const OutputScale& scale : scales_) {
    if (!std::isfinite(scale.offset) || !std::isfinite(scale.scale)) invalid("a scale that is not finite");
  }
  for (const ForestNode& node : nodes_) {
    if (!std::isfinite(node.value)) invalid("a value that is not finite");
  }
  if (!all_finite(models_)) invalid("a leaf model that is not finite");
}

void Forest::make_tops() {
  for (const std::uint32_t root : roots_) tops_.push_back(make_top(nodes_.data(), root));
}

void Forest::check() const {
  check_numbers();
  const std::size_t size = nodes_.size();
  std::vector<std::int16_t> depth(size, 0);
  walk(nodes_, roots_, outputs(), [&](std::size_t node, std::int64_t parent, std::size_t) {
    if (parent >= 0) depth[node] = static_cast<std::int16_t>(depth[static_cast<std::size_t>(parent)] + 1);
    if (depth[node] > kMaxTreeDepth) invalid("too deep");
  });
  for (const ForestNode& node : nodes_) {
    if ((node.feature() == features()) != (node.ahead() == 0))
      invalid("a leaf with children, or a split without");
    if (node.feature() > features()) invalid("a split of no input");
  }
  const std::size_t rows = leaf_ == LeafModel::linear ? leaves() : 0;
  if (models_.size() != rows * model_width(inputs_)) invalid("size of its leaf models");
  for (std::size_t row = 0; row < rows; ++row) {
    const double* range = models_.data() + row * model_width(inputs_) + inputs_ + 1;
    if (range[0] > range[1]) invalid("a leaf model with an empty range");
  }
}

}  // namespace coppice
