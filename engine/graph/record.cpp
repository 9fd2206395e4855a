#include "engine/graph/record.h"

#include <nlohmann/json.hpp>

namespace coppice {
namespace {

using Json = nlohmann::ordered_json;

/// Raised when records change so that older programs would misread them.
constexpr int kRecordFormat = 1;

}  // namespace

std::string record_text(const ResultRecord& record) {
  Json files = Json::array();
  for (const StoredFile& file : record.files) {
    files.push_back(
        {{"name", file.name}, {"size", file.size}, {"hash", file.hash}, {"modified_ns", file.modified_ns}});
  }
  const Json json = {
      {"format", kRecordFormat},       {"key", record.key},         {"kind", record.kind},
      {"component", record.component}, {"family", record.family},   {"wall_s", record.wall_s},
      {"cpu_s", record.cpu_s},         {"files", std::move(files)}, {"key_text", record.key_text}};
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + '\n';
}

std::optional<ResultRecord> parse_record(std::string_view text) {
  const Json json = Json::parse(text, nullptr, false);
  try {
    if (json.at("format") != kRecordFormat) return std::nullopt;
    ResultRecord record;
    json.at("key").get_to(record.key);
    json.at("kind").get_to(record.kind);
    json.at("component").get_to(record.component);
    json.at("family").get_to(record.family);
    json.at("wall_s").get_to(record.wall_s);
    json.at("cpu_s").get_to(record.cpu_s);
    json.at("key_text").get_to(record.key_text);
    for (const Json& entry : json.at("files")) {
      StoredFile& file = record.files.emplace_back();
      entry.at("name").get_to(file.name);
      entry.at("size").get_to(file.size);
      entry.at("hash").get_to(file.hash);
      entry.at("modified_ns").get_to(file.modified_ns);
    }
    return record;
  } catch (const Json::exception&) {  // not JSON at all, or a part is missing or of another type
    return std::nullopt;
  }
}

}  // namespace coppice
