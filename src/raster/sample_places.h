/// Where in a pixel the samples are, in sixteenths of it from the top left.
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace alhazen {

struct SamplePlace {
    std::int8_t x, y;
};

/// For 1, 4, 8 or 16 samples. Each row and column of sixteenths (eighths for 8, quarters for 4) holds one
/// sample, as rooks that do not attack each other, and no two are close (the search for such patterns:
/// Shirley 1991 on n-rooks; the places are a rank-1 lattice's points, Dammertz and Keller 2008).
std::span<const SamplePlace> sample_places(int samples);

} // namespace alhazen
