// What every registered component promises, whatever it is.

#include <gtest/gtest.h>

#include "registry/component.h"

namespace coppice {
namespace {

TEST(Components, AreDeclaredInFull) {
  const Catalogue& catalogue = Catalogue::instance();
  EXPECT_NO_THROW(catalogue.verify());
  std::size_t count = 0;
  for (const std::string& interface : catalogue.interfaces()) {
    for (const ComponentInfo* info : catalogue.all(interface)) {
      ++count;
      const std::string name = interface + " <" + info->name + ">";
      EXPECT_FALSE(info->doc.empty()) << name;
      EXPECT_FALSE(info->source.empty()) << name;
      EXPECT_GE(info->version, 1) << name;
      EXPECT_EQ(info->name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_"), std::string::npos)
          << name;
      for (const ParameterInfo& parameter : info->parameters) {
        EXPECT_FALSE(parameter.doc.empty()) << name << " " << parameter.name;
      }
      for (const SlotInfo& slot : info->slots) EXPECT_FALSE(slot.doc.empty()) << name << " " << slot.name;
    }
  }
  EXPECT_GT(count, 0u);
}

}  // namespace
}  // namespace coppice
