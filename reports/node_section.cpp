#include "reports/node_section.h"

#include <fmt/format.h>

#include <map>
#include <set>

#include "reports/html.h"

namespace coppice {
namespace {

using html::element;
using html::text_element;

/// How many nodes are in which state, and what the finished ones took.
struct Count {
  std::size_t done = 0, failed = 0, all = 0;
  double cpu_s = 0, wall_s = 0;

  void add(const NodeState& node) {
    ++all;
    if (node.done) ++done;
    if (!node.message.empty()) ++failed;
    cpu_s += node.cpu_s.value_or(0);
    wall_s += node.wall_s.value_or(0);
  }
  std::string cells() const {
    const char* state = failed > 0 ? "failed" : done == all ? "done" : "missing";
    std::string cells = text_element("td", state, {{"class", state}});
    const auto add_number = [&](const std::string& text) {
      cells += text_element("td", text, {{"class", "number"}});
    };
    add_number(fmt::format("{} / {}", done, all));
    add_number(done == 0 ? "" : fmt::format("{:.2f}", cpu_s));
    add_number(done == 0 ? "" : fmt::format("{:.2f}", wall_s));
    return cells;
  }
};

std::string node_table(const Element& experiment, const RunStatus& status) {
  std::map<std::string, Count> counts;
  Count total;
  for (const NodeState& node : status.states) {
    counts[node.id].add(node);
    total.add(node);
  }
  std::string body;
  std::set<std::string> shown;
  for (const Element& node : experiment.children) {
    const auto found = counts.find(std::string(node.get("id")));
    if (found == counts.end() || !shown.insert(found->first).second) continue;
    body +=
        element("tr", text_element("th", found->first, {{"scope", "row"}}) + text_element("td", node.name) +
                          found->second.cells() + text_element("td", node.get("doc")));
  }
  body += element("tr", text_element("th", "all", {{"scope", "row"}}) + text_element("td", "") +
                            total.cells() + text_element("td", ""));
  std::string head;
  for (const char* column :
       {"node", "kind", "state", "done", "CPU time (s)", "wall time (s)", "what it is for"})
    head += text_element("th", column, {{"scope", "col"}});
  return element("figure", element("table", element("thead", element("tr", head)) + element("tbody", body)) +
                               text_element("figcaption",
                                            "Times are those of computing the results, summed, whenever and "
                                            "wherever that was; they are no part of them."));
}

}  // namespace

std::string node_section(const Element& experiment, const RunStatus& status) {
  std::string failures;
  for (const NodeState& node : status.states) {
    if (!node.message.empty()) failures += text_element("h3", node.name) + text_element("pre", node.message);
  }
  const std::string summary =
      fmt::format("{} nodes: {} done, {} failed, {} missing.", status.nodes, status.finished, status.failed,
                  status.nodes - status.finished - status.failed);
  return element("section", text_element("h2", "Nodes") + text_element("p", summary) + failures +
                                node_table(experiment, status));
}

}  // namespace coppice
