#include "engine/graph/report.h"

namespace coppice {

void write_reports(const std::filesystem::path& run_folder) {
  for (const ComponentInfo* info : Catalogue::instance().all(Report::kInterface)) {
    Element element;
    element.name = info->name;
    Diagnostics diagnostics;
    make<Report>(element, diagnostics)->write(run_folder);
  }
}

}  // namespace coppice
