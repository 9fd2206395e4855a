#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "engine/data/file_system.h"
#include "engine/graph/report.h"
#include "engine/graph/status.h"
#include "registry/text.h"
#include "reports/html.h"
#include "reports/node_section.h"
#include "reports/page_style.h"
#include "reports/published.h"

namespace coppice {
namespace {

namespace fs = std::filesystem;
using html::element;
using html::text_element;
using Json = nlohmann::ordered_json;

/// What a run folder says about itself.
struct RunRecord {
  fs::path folder;
  Element experiment;  ///< resolved.xml
  Json provenance;
  RunStatus status;
};

RunRecord read_record(const fs::path& folder) {
  RunRecord record;
  record.folder = folder;
  record.status = read_status(folder);
  record.experiment = parse_xml(read_source((folder / "resolved.xml").string()));
  const fs::path provenance = folder / "provenance.json";
  if (fs::is_regular_file(provenance)) record.provenance = Json::parse(read_file(provenance), nullptr, false);
  if (!record.provenance.is_object()) record.provenance = Json::object();
  return record;
}

/// A JSON value as text; "" when there is none.
std::string text_of(const Json& object, const char* name) {
  const auto found = object.find(name);
  if (found == object.end() || found->is_null()) return {};
  if (found->is_string()) return found->get<std::string>();
  if (!found->is_array()) return found->dump();
  std::vector<std::string> items;
  for (const Json& item : *found) items.push_back(item.is_string() ? item.get<std::string>() : item.dump());
  return join(items, " ");
}

std::string definitions(const Json& object) {
  std::string list;
  for (const auto& [name, value] : object.items()) {
    list += text_element("dt", name) + text_element("dd", text_of(object, name.c_str()));
  }
  return element("dl", list);
}

std::string folded(const std::string& title, const std::string& content) {
  return element("details", text_element("summary", title) + content);
}

std::string header(const RunRecord& record) {
  const std::string name(record.experiment.get("name"));
  const std::string outcome = text_of(record.provenance, "outcome");
  std::vector<std::string> facts = {fmt::format("seed {}", record.experiment.get("seed"))};
  if (const auto overrides = record.provenance.find("overrides"); overrides != record.provenance.end()) {
    for (const auto& [argument, value] : overrides->items()) {
      facts.push_back(fmt::format("{}:={}", argument, text_of(*overrides, argument.c_str())));
    }
  }
  if (!outcome.empty()) facts.push_back(outcome);
  facts.push_back(text_of(record.provenance, "finished"));
  std::erase(facts, "");
  const std::string_view doc = record.experiment.get("doc");
  return element("header", text_element("h1", name) + (doc.empty() ? "" : text_element("p", doc)) +
                               text_element("p", join(facts, " · "), {{"class", "soft"}}));
}

std::string provenance(const RunRecord& record) {
  Json facts = Json::object();
  for (const char* name : {"config", "command", "threads", "started", "finished", "outcome"}) {
    if (const std::string text = text_of(record.provenance, name); !text.empty()) facts[name] = text;
  }
  if (facts.contains("command")) facts["command"] = "runner " + facts["command"].get<std::string>();
  std::string content = definitions(facts);
  const auto fold = [&](const char* name, const char* title) {
    const auto found = record.provenance.find(name);
    if (found != record.provenance.end() && found->is_object() && !found->empty()) {
      content += folded(title, definitions(*found));
    }
  };
  fold("arguments", "Arguments");
  fold("environment", "Program and machine");
  Json inputs = Json::object();
  if (const auto found = record.provenance.find("inputs"); found != record.provenance.end()) {
    for (const Json& input : *found) inputs[text_of(input, "path")] = text_of(input, "hash");
  }
  if (!inputs.empty()) content += folded("Input files and their hashes", definitions(inputs));
  std::string links;
  for (const char* file : {"resolved.xml", "provenance.json", "events.jsonl"}) {
    links += (links.empty() ? "" : " · ") + text_element("a", file, {{"href", file}});
  }
  return element("section", text_element("h2", "Provenance") + content + element("p", links));
}

/// `report.html`: one file that needs neither network nor scripts, in light and dark and on paper.
struct Page : Report {
  void write(const fs::path& run_folder) const override {
    const RunRecord record = read_record(run_folder);
    std::string head = "<meta charset=\"utf-8\"/>\n";
    head += "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n";
    head += text_element("title", record.experiment.get("name"));
    head += element("style", kPageStyle);
    std::string main = published_section(record.folder, record.experiment, "tables", "Tables");
    main += published_section(record.folder, record.experiment, "figures", "Figures");
    main += node_section(record.experiment, record.status);
    main += provenance(record);
    std::string page = "<!DOCTYPE html>\n<html lang=\"en\" xmlns=\"http://www.w3.org/1999/xhtml\">\n";
    page += element("head", head);
    page += element("body", header(record) + element("main", main));
    write_file(run_folder / "report.html", page + "\n</html>\n");
  }

  static Parameters<Page> parameters() { return {}; }
};

const Component<Report, Page> kPage(
    "page", "Tables, state of the nodes and provenance of an experiment on one page, report.html.",
    "no publication");

}  // namespace
}  // namespace coppice
