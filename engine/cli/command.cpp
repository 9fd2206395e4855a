#include "engine/cli/command.h"

#include <algorithm>
#include <tuple>

namespace coppice::cli {
namespace {

std::vector<CommandInfo>& table() {
  static std::vector<CommandInfo> all;
  return all;
}

}  // namespace

const std::vector<CommandInfo>& commands() {
  return table();
}

const CommandInfo* find_command(std::string_view name) {
  const auto found = std::find_if(table().begin(), table().end(),
                                  [&](const CommandInfo& info) { return info.name == name; });
  return found == table().end() ? nullptr : &*found;
}

void add_command(CommandInfo info) {
  const auto before = [](const CommandInfo& a, const CommandInfo& b) {
    return std::tie(a.group, a.rank, a.name) < std::tie(b.group, b.rank, b.name);
  };
  table().insert(std::upper_bound(table().begin(), table().end(), info, before), std::move(info));
}

namespace detail {

std::string read_text(const std::string& text, std::string& value) {
  value = text;
  return {};
}

std::string read_text(const std::string& text, std::optional<std::string>& value) {
  value = text;
  return {};
}

std::string read_text(const std::string& text, std::uint64_t& value) {
  const char* end = text.data() + text.size();
  const auto [stop, failure] = std::from_chars(text.data(), end, value);
  if (failure == std::errc::result_out_of_range) return "must be an integer below 2^64";
  const bool good = failure == std::errc() && stop == end;
  return good ? std::string() : std::string("must be an integer >= 0");
}

std::string read_text(const std::string& text, std::optional<std::uint64_t>& value) {
  return read_text(text, value.emplace());
}

std::string read_text(const std::string& text, std::vector<std::string>& value) {
  value.push_back(text);
  return {};
}

std::string default_text(const std::string& value) {
  return value;
}
std::string default_text(std::uint64_t value) {
  return std::to_string(value);
}

}  // namespace detail
}  // namespace coppice::cli
