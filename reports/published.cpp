#include "reports/published.h"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "registry/text.h"
#include "reports/html.h"
#include "reports/table_view.h"

namespace coppice {
namespace {

namespace fs = std::filesystem;
using html::element;
using html::text_element;

/// The element of the node that a published file belongs to; null when there is none. Files are called
/// <id>.csv, or <id>.<sweep point>.csv.
const Element* node_of_file(const Element& experiment, const std::string& file) {
  const std::string id = file.substr(0, file.find('.'));
  for (const Element& node : experiment.children) {
    if (node.get("id") == id) return &node;
  }
  return nullptr;
}

/// The published tables of a folder, in the order of the experiment's nodes, then by name.
std::vector<std::string> published_files(const fs::path& folder, const Element& experiment) {
  std::vector<std::string> files;
  std::error_code code;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, code)) {
    if (entry.path().extension() == ".csv") files.push_back(entry.path().filename().string());
  }
  const auto rank = [&](const std::string& file) {
    const Element* node = node_of_file(experiment, file);
    return std::pair(node != nullptr ? node - experiment.children.data() : -1, file);
  };
  std::sort(files.begin(), files.end(),
            [&](const std::string& a, const std::string& b) { return rank(a) < rank(b); });
  return files;
}

std::vector<std::string> list_of(std::string_view text) {
  std::vector<std::string> items;
  for (const std::string_view item : split_list(text)) items.emplace_back(item);
  return items;
}

std::string published_table(const fs::path& folder, const Element& experiment, const std::string& path) {
  const std::string file = fs::path(path).filename().string();
  const Element* node = node_of_file(experiment, file);
  TableKeys keys;
  std::string title = fs::path(file).stem().string(), text;
  if (node != nullptr) {
    keys = {list_of(node->get("rows")), list_of(node->get("columns"))};
    if (!node->get("doc").empty()) text = text_element("p", node->get("doc"));
    if (const Attribute* metric = node->find("metric")) title += ": " + metric->value;
  }
  std::string content;
  try {
    content = table_view(read_table(folder / path), keys);
  } catch (const std::runtime_error& unreadable) {
    content = text_element("pre", unreadable.what());
  }
  const std::string source =
      element("figcaption", "Data: " + text_element("a", path, {{"href", html::link(path)}}));
  return text_element("h3", title) + text + element("figure", content + source);
}

}  // namespace

std::string published_section(const fs::path& run_folder, const Element& experiment,
                              const std::string& subfolder, std::string_view title) {
  std::string content;
  for (const std::string& file : published_files(run_folder / subfolder, experiment)) {
    content += published_table(run_folder, experiment, subfolder + "/" + file);
  }
  return content.empty() ? content : element("section", text_element("h2", title) + content);
}

}  // namespace coppice
