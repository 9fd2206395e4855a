#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/vocabulary/exporter.h"

namespace coppice {
namespace {

using Json = nlohmann::ordered_json;

/// JSON has no infinity: an axis without a limit has null.
Json limit(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json json(const Space& axes) {
  Json list = Json::array();
  for (const Axis& axis : axes) {
    list.push_back({{"name", axis.name},
                    {"unit", axis.unit},
                    {"low", limit(axis.low)},
                    {"high", limit(axis.high)},
                    {"circular", axis.circular}});
  }
  return list;
}

Json json(const ConstantModel& model) {
  return {{"kind", "constant"}, {"values", model.values}};
}

Json json(const LinearModel& model) {
  return {{"kind", "linear"}, {"slopes", model.slopes}, {"bias", model.bias}, {"bias_last", model.bias_last}};
}

/// Single-precision numbers are written as the doubles that they are, exactly.
Json json(const ForestModel::Tree& tree, bool linear) {
  Json value = Json::array(), index = Json::array(), child = Json::array();
  for (const ForestModel::Node& node : tree.nodes) {
    value.push_back(static_cast<double>(node.value));
    index.push_back(node.index);
    child.push_back(node.child);
  }
  Json object = {{"child", std::move(child)}, {"index", std::move(index)}, {"value", std::move(value)}};
  if (linear) object["models"] = tree.models;
  return object;
}

Json json(const ForestModel& model) {
  Json outputs = Json::array();
  for (const ForestModel::Output& output : model.outputs) {
    Json object = {{"offset", output.offset}, {"scale", output.scale}, {"trees", Json::array()}};
    for (const ForestModel::Tree& tree : output.trees)
      object["trees"].push_back(json(tree, model.linear_leaves));
    outputs.push_back(std::move(object));
  }
  Json object = {{"kind", "forest"},
                 {"inputs", model.inputs},
                 {"leaves", model.linear_leaves ? "linear" : "constant"},
                 {"trimmed", model.trimmed ? Json(*model.trimmed) : Json(nullptr)},
                 {"outputs", std::move(outputs)}};
  if (!model.directions.empty()) object["directions"] = model.directions;
  return object;
}

/// All numbers of a policy, each with the digits that read back to the same double (docs/exports.md says what
/// each member is).
class JsonExporter : public Exporter {
 public:
  std::string extension() const override { return "json"; }
  std::string write(const ExportedPolicy& policy) const override {
    const Json object = {
        {"format", "coppice policy"},
        {"version", 1},
        {"name", policy.name},
        {"component", policy.component},
        {"writer", policy.writer},
        {"provenance", policy.provenance},
        {"states", json(policy.spaces.states)},
        {"action",
         {{"id", policy.model.action}, {"name", policy.action().name}, {"axes", json(policy.action().axes)}}},
        {"function", std::visit([](const auto& model) { return json(model); }, policy.model.function)}};
    return object.dump(-1, ' ', false, Json::error_handler_t::replace) + '\n';
  }
  static Parameters<JsonExporter> parameters() { return {}; }
};

const Component<Exporter, JsonExporter> kJsonExporter("json", "All numbers of the policy, for any program.",
                                                      "no publication");

}  // namespace
}  // namespace coppice
