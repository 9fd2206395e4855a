#pragma once

#include <string>
#include <vector>

namespace coppice::cli {

/// What may stand in place of the last word, given the words before it: one candidate per line; then, where
/// files fit, a line ":config", ":file" or ":folder" for the shell. What the scripts of `runner completion`
/// ask for by `runner __complete WORD...`.
std::string complete(const std::vector<std::string>& words);

}  // namespace coppice::cli
