#pragma once

#include <unistd.h>

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/data/file_system.h"
#include "engine/graph/node.h"

namespace coppice::testing {

/// An element as the config would have it: <name a="b">children</name>.
inline Element element(std::string name, const std::vector<std::pair<std::string, std::string>>& attributes,
                       std::vector<Element> children = {}) {
  Element made;
  made.name = std::move(name);
  for (const auto& [attribute, value] : attributes) made.set(attribute, value);
  made.children = std::move(children);
  return made;
}

inline std::shared_ptr<const Element> shared(Element element) {
  return std::make_shared<const Element>(std::move(element));
}

/// One thread, which says that it is time to stop once it was asked a number of times.
class StoppableSerial : public Serial {
 public:
  bool stop_requested() const override { return patience >= 0 && patience-- == 0; }
  mutable int patience = -1;  ///< questions answered with no; -1: never stops
};

/// A node alone, its inputs given by hand: what the graph would show it.
class FakeContext : public NodeContext {
 public:
  FakeContext() {
    std::string pattern = (std::filesystem::temp_directory_path() / "coppice_node_XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
  }
  ~FakeContext() override { std::filesystem::remove_all(folder_); }

  const std::vector<InputNode>& inputs(std::string_view parameter) const override {
    static const std::vector<InputNode> kNone;
    const auto found = given.find(parameter);
    return found == given.end() ? kNone : found->second;
  }
  const Point& point() const override { return point_; }
  std::optional<int> replicate() const override { return 0; }
  Draws draws() const override { return {seed, label, 0}; }
  const std::string& key() const override { return key_; }
  const std::string& stream() const override { return stream_; }
  const std::filesystem::path& folder() const override { return folder_; }
  Parallel& parallel() override { return serial; }
  void count(std::string_view what, std::int64_t amount) override { counts[std::string(what)] += amount; }
  void measure(std::string_view what, double value) override { measures[std::string(what)] = value; }
  void progress(std::int64_t done, std::int64_t) override { progress_done = done; }
  std::optional<Archive> checkpoint() override { return saved; }
  void save_checkpoint(const Archive& archive) override { saved = archive; }

  std::map<std::string, std::vector<InputNode>, std::less<>> given;
  std::uint64_t seed = 1;
  std::string label = "test";
  StoppableSerial serial;
  std::map<std::string, std::int64_t> counts;
  std::map<std::string, double> measures;
  std::int64_t progress_done = 0;
  std::optional<Archive> saved;

 private:
  Point point_;
  std::string key_ = "0123456789abcdef0123456789abcdef";
  std::string stream_ = "test 0";
  std::filesystem::path folder_;
};

/// The node that an element describes; throws ConfigError.
inline Sub<Node> make_node(const Element& described) {
  Diagnostics diagnostics;
  Sub<Node> node = make<Node>(described, diagnostics);
  diagnostics.throw_if_any();
  return node;
}

/// An input as the graph would make it from a node's element.
inline InputNode input(const Element& described, const std::filesystem::path& folder = {}) {
  InputNode made;
  made.id = described.get("id");
  made.kind = described.name;
  const Sub<Node> node = make_node(described);
  made.element = shared(node.resolved);
  made.problem = node.object->problem();
  made.folder = folder;
  made.key = made.id + "'s key";
  return made;
}

/// The file of a folder as text.
inline std::string text_of(const std::filesystem::path& file) {
  return read_file(file);
}

/// What a callable throws, as text; "" when it throws nothing.
std::string error_of(const auto& action) try {
  action();
  return "";
} catch (const std::exception& thrown) {
  return thrown.what();
}

}  // namespace coppice::testing
