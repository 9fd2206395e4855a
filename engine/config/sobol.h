#pragma once

#include <cstddef>
#include <cstdint>

namespace coppice::config {

inline constexpr std::size_t kSobolDimensions = 10;

/// Coordinate `dimension` (from 0) of point `index` of the Sobol' sequence, in [0, 1), a multiple of 2^-32.
/// The first point is the origin: leaving it out would cost the balance of the first 2^k points (Owen 2020,
/// On dropping the first Sobol' point). Direction numbers of Joe and Kuo 2008 (Constructing Sobol' sequences
/// with better two-dimensional projections, SIAM J. Sci. Comput. 30), in the order of Gray codes (Antonov and
/// Saleev 1979).
double sobol(std::uint32_t index, std::size_t dimension);

}  // namespace coppice::config
