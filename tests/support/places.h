#pragma once

#include <filesystem>
#include <string>

namespace coppice {

// Where this build has things. In a source of its own, so that the tests compile to the same in every folder.
std::filesystem::path source_folder();
std::string runner_program();        ///< the program under test
std::string contributing_program();  ///< the same with the components of the documentation's examples
std::string compiler_program();      ///< the C++ compiler of this build
std::filesystem::path your_problem_folder();  ///< the files of docs/your-problem.md

}  // namespace coppice
