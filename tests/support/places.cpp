#include "tests/support/places.h"

namespace coppice {

std::filesystem::path source_folder() {
  return COPPICE_SOURCE_DIR;
}

std::string runner_program() {
  return COPPICE_RUNNER;
}

std::string contributing_program() {
  return COPPICE_CONTRIBUTING_RUNNER;
}

std::string compiler_program() {
  return COPPICE_COMPILER;
}

std::filesystem::path your_problem_folder() {
  return COPPICE_YOUR_PROBLEM;
}

}  // namespace coppice
