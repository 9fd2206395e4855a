#include "engine/graph/build_info.h"

#include "generated/version.h"

namespace coppice {

const BuildInfo& build_info() {
  static constexpr BuildInfo kInfo = {.version = COPPICE_VERSION,
                                      .commit = COPPICE_COMMIT,
                                      .compiler = COPPICE_COMPILER,
                                      .flags = COPPICE_FLAGS,
                                      .eigen = COPPICE_EIGEN,
                                      .tinyxml2 = COPPICE_TINYXML2};
  return kInfo;
}

}  // namespace coppice
