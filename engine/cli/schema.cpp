#include "registry/schema.h"

#include "engine/cli/command.h"
#include "engine/cli/console.h"
#include "engine/cli/exit_status.h"
#include "engine/config/language.h"

namespace coppice::cli {
namespace {

struct Schema {
  static Arguments<Schema> arguments() { return {}; }

  int run(const CommandLine&, Console& console) const {
    console.out(xml_schema(Catalogue::instance(), config_language()));
    return kDone;
  }
};

const Command<Schema> kSchema(
    {.name = "schema",
     .group = Group::components,
     .rank = 3,
     .doc = "Writes the XML schema (XSD 1.0) of configs, for editors and xmllint.",
     .details = "With the schema, an editor completes and explains elements and attributes. What it cannot "
                "say, above "
                "all whether the nodes that a config refers to exist, only 'validate' checks.",
     .examples = {
         {"runner schema > coppice.xsd", "Writes it to a file."},
         {"xmllint --noout --schema coppice.xsd configs/quickstart.xml", "Checks a config with it."}}});

}  // namespace
}  // namespace coppice::cli
