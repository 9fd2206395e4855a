#include "engine/config/config_root.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>

#include "engine/config/control_check.h"
#include "engine/config/evaluator.h"

namespace coppice::config {
namespace {

class RootReader {
 public:
  RootReader(const LoadedFile& file, const Files& files, const std::shared_ptr<const TraceFrame>& trace,
             Diagnostics& diagnostics)
      : file_(file), diagnostics_(diagnostics), evaluator_(files, diagnostics) {
    context_.scope = std::make_shared<Scope>();
    context_.trace = trace;
  }

  RootAttributes read() {
    RootAttributes root;
    if (file_.root.name != "experiment") {
      error(file_.root.place, fmt::format("the root element is <{}>", file_.root.name),
            "a config begins with <experiment coppice=\"1\">");
      return root;
    }
    check_control(without_namespaces(), root_element(), context_.trace, diagnostics_);
    root.readable = version();
    root.doc = text("doc").value_or("");
    root.seed = seed();
    root.name = name();
    return root;
  }

 private:
  void error(const Place& place, std::string message, std::string hint = {}) {
    diagnostics_.error(traced(place, context_), std::move(message), std::move(hint));
  }

  /// Editors find the schema by attributes of the namespaces xmlns and xsi: they are no business of the
  /// language.
  Element without_namespaces() const {
    Element element = file_.root;
    element.children.clear();
    std::erase_if(element.attributes, [](const Attribute& attribute) {
      return attribute.name == "xmlns:xsi" || attribute.name == "xsi:noNamespaceSchemaLocation";
    });
    return element;
  }

  std::optional<std::string> text(const char* attribute) {
    const Attribute* found = file_.root.find(attribute);
    return found == nullptr ? std::nullopt : evaluator_.text(*found, context_);
  }

  bool version() {
    const Attribute* attribute = file_.root.find("coppice");
    if (attribute == nullptr) return true;  // reported; what follows may well be meant for this version
    const std::string& text = attribute->value;
    int version = 0;
    const auto [stop, failure] = std::from_chars(text.data(), text.data() + text.size(), version);
    const std::string known = fmt::format("this program knows version {}", kLanguageVersion);
    if (failure != std::errc{} || stop != text.data() + text.size() || version < 1) {
      error(attribute->value_place, fmt::format("'{}' is not a version of the language", text), known);
      return false;
    }
    if (version <= kLanguageVersion) return true;
    error(attribute->value_place, fmt::format("the file is written in version {} of the language", version),
          known);
    return false;
  }

  std::optional<std::uint64_t> seed() {
    const Attribute* attribute = file_.root.find("seed");
    if (attribute == nullptr) return 1;
    const std::optional<std::string> text = this->text("seed");
    if (!text) return std::nullopt;
    std::uint64_t seed = 0;
    const char* end = text->data() + text->size();
    const auto [stop, failure] = std::from_chars(text->data(), end, seed);
    if (failure == std::errc{} && stop == end) return seed;
    error(attribute->value_place, fmt::format("the seed '{}' is not an integer from 0 to 2^64 - 1", *text));
    return std::nullopt;
  }

  /// Names are folders: letters, digits, '_', '-' and '.', not a name that the output folder uses itself.
  std::string name() {
    const Attribute* attribute = file_.root.find("name");
    std::string name = std::filesystem::path(file_.source->path).stem().string();
    if (attribute != nullptr) {
      const std::optional<std::string> given = text("name");
      if (!given) return name;
      name = *given;
    }
    const bool characters = !name.empty() && name.front() != '.' && name.front() != '-' &&
                            std::all_of(name.begin(), name.end(), [](char c) {
                              return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                                     (c >= '0' && c <= '9') || c == '_' || c == '-' || c == '.';
                            });
    const bool taken = name == "store" || name == "index.sqlite";
    if (characters && !taken) return name;
    const std::string rule =
        taken ? "the output folder uses this name itself" : "letters, digits, '_', '-' and '.' make a name";
    error(attribute != nullptr ? attribute->value_place : file_.root.place,
          fmt::format("'{}' cannot be the name of an experiment", name),
          attribute != nullptr ? rule : rule + "; the attribute 'name' gives one that is not the file's");
    return "unnamed";
  }

  const LoadedFile& file_;
  Diagnostics& diagnostics_;
  Evaluator evaluator_;
  Context context_;
};

}  // namespace

RootAttributes read_root(const LoadedFile& file, const Files& files,
                         const std::shared_ptr<const TraceFrame>& trace, Diagnostics& diagnostics) {
  return RootReader(file, files, trace, diagnostics).read();
}

}  // namespace coppice::config
