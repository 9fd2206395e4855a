#pragma once

// Expands texts and small folders of files in tests.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "engine/config/experiment.h"

namespace coppice::config_testing {

/// Overrides as the command line gives them.
inline std::vector<Override> overrides(const std::vector<std::string>& words) {
  std::string line = "runner";
  for (const std::string& word : words) line += " " + word;
  const auto file = std::make_shared<const SourceFile>(SourceFile{"<command line>", line});
  std::vector<Override> all;
  int column = 8;
  for (const std::string& word : words) {
    const std::size_t assign = word.find(":=");
    all.push_back({word.substr(0, assign), word.substr(assign + 2),
                   Place{file, 1, column, static_cast<int>(word.size()), nullptr}});
    column += static_cast<int>(word.size()) + 1;
  }
  return all;
}

struct Outcome {
  ExperimentConfig config;
  std::vector<Diagnostic> errors;

  std::string text() const {
    std::string all;
    for (const Diagnostic& error : errors) all += to_text(error);
    return all;
  }
};

/// The body of an <experiment> named "test", which begins in line 2.
inline std::string document(const std::string& body) {
  return "<experiment coppice=\"1\" name=\"test\">\n" + body + "\n</experiment>\n";
}

inline Outcome expand_document(const std::string& text, const std::vector<std::string>& words = {}) {
  const auto source = std::make_shared<const SourceFile>(SourceFile{"test.xml", text});
  Diagnostics diagnostics;
  const std::vector<Override> given = overrides(words);
  Outcome outcome;
  outcome.config = expand(source, ExpandOptions{given, std::nullopt}, diagnostics);
  check_overrides({outcome.config}, given, diagnostics);
  outcome.errors = diagnostics.all();
  return outcome;
}

inline Outcome expand_body(const std::string& body, const std::vector<std::string>& words = {}) {
  return expand_document(document(body), words);
}

/// The config of a body without mistakes.
inline ExperimentConfig good(const std::string& body, const std::vector<std::string>& words = {}) {
  Outcome outcome = expand_body(body, words);
  EXPECT_EQ(outcome.text(), "");
  EXPECT_TRUE(outcome.config.complete);
  return std::move(outcome.config);
}

/// The only mistake of a body.
inline Diagnostic bad(const std::string& body, const std::vector<std::string>& words = {}) {
  const Outcome outcome = expand_body(body, words);
  EXPECT_EQ(outcome.errors.size(), 1u) << outcome.text();
  return outcome.errors.empty() ? Diagnostic{} : outcome.errors.front();
}

/// The characters that a mistake underlines.
inline std::string marked(const Diagnostic& error) {
  if (!error.place.file || error.place.column < 1) return "";
  const std::string_view line = error.place.file->line(error.place.line);
  return std::string(line.substr(static_cast<std::size_t>(error.place.column - 1),
                                 static_cast<std::size_t>(error.place.length)));
}

/// The nodes one under the other, as XML with their point behind: "<a id="x"/> {v=1}".
inline std::string nodes_text(const ExperimentConfig& config) {
  std::string all;
  for (const NodeElement& node : config.nodes) {
    std::string xml = to_xml(node.element);
    xml.pop_back();
    all += xml;
    for (const auto& [column, value] : node.point) all += " {" + column + "=" + value + "}";
    all += "\n";
  }
  return all;
}

/// The attribute `value` of the only node, an <x value="..."/>.
inline std::string value_of(const std::string& text, const std::string& definitions = "",
                            const std::vector<std::string>& words = {}) {
  const ExperimentConfig config = good(definitions + "<x value=\"" + text + "\"/>", words);
  return config.nodes.size() == 1 ? std::string(config.nodes[0].element.get("value")) : "not one node";
}

/// A folder of files that goes away at the end.
class Folder {
 public:
  explicit Folder(const std::map<std::string, std::string>& files) {
    path_ = std::filesystem::temp_directory_path() /
            ("coppice_config_" + std::to_string(reinterpret_cast<std::uintptr_t>(this)));
    for (const auto& [name, text] : files) {
      std::filesystem::create_directories((path_ / name).parent_path());
      std::ofstream(path_ / name) << text;
    }
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  std::string path(const std::string& name) const { return (path_ / name).string(); }

  Outcome expand_file(const std::string& name, const std::vector<std::string>& words = {}) const {
    Diagnostics diagnostics;
    const std::vector<Override> given = overrides(words);
    Outcome outcome;
    outcome.config = expand(path(name), ExpandOptions{given, std::nullopt}, diagnostics);
    check_overrides({outcome.config}, given, diagnostics);
    outcome.errors = diagnostics.all();
    return outcome;
  }

 private:
  std::filesystem::path path_;
};

}  // namespace coppice::config_testing
