#include "engine/graph/events.h"

#include <fcntl.h>
#include <unistd.h>

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>

#include "engine/graph/provenance.h"

namespace coppice {
namespace {

using Json = nlohmann::ordered_json;

std::string to_line(const Event& event) {
  Json json = {{"time", event.time}, {"event", event.what}};
  if (!event.node.empty()) json["node"] = event.node;
  if (!event.key.empty()) json["key"] = event.key;
  if (!event.message.empty()) json["message"] = event.message;
  if (event.wall_s) json["wall_s"] = *event.wall_s;
  if (event.cpu_s) json["cpu_s"] = *event.cpu_s;
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + '\n';
}

std::optional<Event> from_line(std::string_view line) {
  const Json json = Json::parse(line, nullptr, false);
  if (!json.is_object()) return std::nullopt;
  try {
    Event event;
    json.at("time").get_to(event.time);
    json.at("event").get_to(event.what);
    event.node = json.value("node", "");
    event.key = json.value("key", "");
    event.message = json.value("message", "");
    if (json.contains("wall_s")) event.wall_s = json.at("wall_s").get<double>();
    if (json.contains("cpu_s")) event.cpu_s = json.at("cpu_s").get<double>();
    return event;
  } catch (const Json::exception&) {  // an object, but no event
    return std::nullopt;
  }
}

bool ends_torn(const OpenFile& file) {
  const off_t size = ::lseek(file.descriptor(), 0, SEEK_END);
  char last = '\n';
  if (size > 0 && ::pread(file.descriptor(), &last, 1, size - 1) != 1) return true;
  return last != '\n';
}

}  // namespace

Journal::Journal(const std::filesystem::path& file) {
  try {
    file_ = std::make_unique<OpenFile>(file, O_RDWR | O_CREAT | O_APPEND);
    torn_ = ends_torn(*file_);
  } catch (const std::runtime_error& error) {
    error_ = error.what();
  }
}

void Journal::write(Event event) {
  if (event.time.empty()) event.time = timestamp();
  const std::lock_guard lock(mutex_);
  if (!file_) return;
  const std::string line = (torn_ ? "\n" : "") + to_line(event);
  try {
    file_->write(line);
    torn_ = false;
  } catch (const std::runtime_error& error) {
    torn_ = true;
    if (error_.empty()) error_ = error.what();
  }
}

std::string Journal::error() const {
  const std::lock_guard lock(mutex_);
  return error_;
}

std::vector<Event> read_events(const std::filesystem::path& file) {
  std::vector<Event> events;
  std::string text;
  try {
    text = read_file(file);
  } catch (const std::runtime_error&) {  // no journal, no events
    return events;
  }
  for (std::string_view rest = text; rest.find('\n') != rest.npos;) {
    const std::size_t end = rest.find('\n');
    if (std::optional<Event> event = from_line(rest.substr(0, end))) events.push_back(std::move(*event));
    rest.remove_prefix(end + 1);
  }
  return events;
}

}  // namespace coppice
