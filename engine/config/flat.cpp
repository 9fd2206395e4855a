#include <fmt/format.h>

#include "engine/config/config_root.h"
#include "engine/config/experiment.h"
#include "engine/config/text_template.h"
#include "engine/config/value.h"
#include "registry/text.h"

namespace coppice {
namespace {

void add(Element& element, const std::string& name, const std::string& value) {
  element.attributes.push_back({name, config::escaped(value), {}, {}});
}

Element flat_sweep(const SweepPoints& sweep) {
  Element list;
  list.name = "list";
  for (const Point& point : sweep.points) {
    Element row;
    row.name = "point";
    for (const auto& [column, value] : point) add(row, column, value);
    list.children.push_back(std::move(row));
  }
  Element element;
  element.name = "sweep";
  add(element, "id", sweep.id);
  element.children.push_back(std::move(list));
  return element;
}

/// Text that expansion leaves as it is.
void escape(Element& element) {
  for (Attribute& attribute : element.attributes) attribute.value = config::escaped(attribute.value);
  for (Element& child : element.children) escape(child);
}

Element flat_node(const NodeElement& node) {
  Element element = node.resolved ? *node.resolved : node.element;
  escape(element);
  if (node.sweeps.empty()) return element;
  std::vector<std::string> point;
  for (const auto& [column, value] : node.point) {
    point.push_back(column + "=" + config::quoted_item(value));
  }
  add(element, "over", join(node.sweeps));
  add(element, "at", join(point));
  return element;
}

}  // namespace

std::string flat(const ExperimentConfig& experiment) {
  Element root;
  root.name = "experiment";
  add(root, "coppice", std::to_string(config::kLanguageVersion));
  add(root, "name", experiment.name);
  add(root, "seed", std::to_string(experiment.seed));
  if (!experiment.doc.empty()) add(root, "doc", experiment.doc);
  for (const SweepPoints& sweep : experiment.sweeps) root.children.push_back(flat_sweep(sweep));
  if (experiment.nodes.empty()) return to_xml(root);
  // Node by node: all of them as one tree would take more memory than the text.
  constexpr int kInside = 2;
  constexpr std::string_view kEnd = "</experiment>\n", kEmptyEnd = "/>\n";
  std::string text = to_xml(root);
  text.resize(text.size() - (root.children.empty() ? kEmptyEnd : kEnd).size());
  if (root.children.empty()) text += ">\n";
  for (const NodeElement& node : experiment.nodes) text += to_xml(flat_node(node), kInside);
  return text.append(kEnd);
}

}  // namespace coppice
