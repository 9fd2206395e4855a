#pragma once

#include <string_view>

namespace coppice {

/// How the program was made.
struct BuildInfo {
  std::string_view version;
  std::string_view
      commit;  ///< "unknown" without a repository; ends in "-modified" where files differed from it
  std::string_view compiler;
  std::string_view flags;
  std::string_view eigen;  ///< version of the library; as below
  std::string_view tinyxml2;
};

const BuildInfo& build_info();

}  // namespace coppice
