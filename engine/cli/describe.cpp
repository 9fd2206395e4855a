#include "registry/describe.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "engine/cli/command.h"
#include "engine/cli/console.h"
#include "engine/cli/exit_status.h"
#include "engine/cli/layout.h"
#include "engine/config/language.h"
#include "registry/suggest.h"

namespace coppice::cli {
namespace {

using Json = nlohmann::ordered_json;

std::string text(const LanguageElement& element, std::size_t width) {
  std::string text =
      fmt::format("{} (element of the config language)\n\n{}\n", element.name, wrapped(element.doc, width));
  std::vector<std::vector<std::string>> rows;
  for (const LanguageAttribute& attribute : element.attributes) {
    rows.push_back({attribute.name, attribute.required ? "required" : "", attribute.doc});
  }
  if (element.free_attributes) rows.push_back({"...", "", "Further attributes have any names."});
  if (!rows.empty()) text += "\nAttributes:\n" + aligned(rows, 2, width);
  return text;
}

Json json(const LanguageElement& element) {
  Json object = {
      {"kind", "language"}, {"name", element.name}, {"doc", element.doc}, {"attributes", Json::array()}};
  for (const LanguageAttribute& attribute : element.attributes) {
    object["attributes"].push_back(
        {{"name", attribute.name}, {"required", attribute.required}, {"doc", attribute.doc}});
  }
  return object;
}

/// Everything of this name: components of any kind, and elements of the language.
struct Found {
  std::vector<const ComponentInfo*> components;
  std::vector<const LanguageElement*> elements;
  std::vector<std::string> known;
};

/// `name` may begin with the kind: "policy/random".
Found find(const std::string& name) {
  Found found;
  const Catalogue& catalogue = Catalogue::instance();
  for (const std::string& kind : catalogue.interfaces()) {
    for (const ComponentInfo* info : catalogue.all(kind)) {
      found.known.push_back(info->name);
      if (name == info->name || name == kind + "/" + info->name) found.components.push_back(info);
    }
  }
  const Language& language = config_language();
  const auto consider = [&](const LanguageElement& element) {
    found.known.push_back(element.name);
    if (name == element.name) found.elements.push_back(&element);
  };
  consider(language.root);
  for (const LanguageElement& element : language.elements) consider(element);
  return found;
}

struct Describe {
  std::string name;
  bool as_json = false;

  static Arguments<Describe> arguments() {
    return Arguments<Describe>()
        .positional(
            "NAME", &Describe::name,
            "A component or an element of the config language; 'KIND/NAME' where several kinds share a name.",
            Completes::component)
        .flag("--json", &Describe::as_json, "The same as JSON: an array with everything of this name.");
  }

  int run(const CommandLine& line, Console& console) const {
    const Catalogue& catalogue = Catalogue::instance();
    const Found found = find(name);
    if (found.components.empty() && found.elements.empty()) {
      throw line.error(name, "there is no component '" + name + "'", suggestion(name, found.known));
    }
    const std::size_t width = static_cast<std::size_t>(console.width());
    Json all = Json::array();
    std::vector<std::string> texts;
    for (const ComponentInfo* info : found.components) {
      texts.push_back(describe_text(catalogue, *info, width));
      all.push_back(describe_json(catalogue, *info));
    }
    for (const LanguageElement* element : found.elements) {
      texts.push_back(text(*element, width));
      all.push_back(json(*element));
    }
    if (as_json) {
      console.out(all.dump(2) + '\n');
    } else {
      for (std::size_t i = 0; i < texts.size(); ++i) console.out((i == 0 ? "" : "\n") + texts[i]);
    }
    return kDone;
  }
};

const Command<Describe> kDescribe(
    {.name = "describe",
     .group = Group::components,
     .rank = 2,
     .doc = "Explains a component: parameters with type, unit, bounds and default, source, an example.",
     .examples = {{"runner describe double_integrator", "Explains a problem."},
                  {"runner describe sweep", "Explains an element of the config language."},
                  {"runner describe policy/random --json", "As data; the policy of this name only."}}});

}  // namespace
}  // namespace coppice::cli
