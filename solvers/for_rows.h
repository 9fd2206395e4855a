#pragma once

#include <algorithm>
#include <cstddef>

#include "engine/vocabulary/parallel.h"

namespace coppice {

/// work(row) for all rows, in chunks over threads; the chunks change no result.
template <class Work>
void for_rows(std::size_t rows, Parallel& parallel, const Work& work) {
  constexpr std::size_t kChunk = 64;
  parallel.for_each((rows + kChunk - 1) / kChunk, [&](std::size_t chunk) {
    const std::size_t end = std::min(rows, (chunk + 1) * kChunk);
    for (std::size_t row = chunk * kChunk; row < end; ++row) work(row);
  });
}

}  // namespace coppice
