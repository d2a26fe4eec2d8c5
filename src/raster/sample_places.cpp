#include "raster/sample_places.h"

namespace alhazen {

namespace {

/// The points (i, i g mod n) / n of a lattice, each in the middle of its cell.
template <std::size_t n>
constexpr std::array<SamplePlace, n> lattice(int g) {
    constexpr int cell = 16 / static_cast<int>(n);
    std::array<SamplePlace, n> places{};
    for (int i = 0; i < static_cast<int>(n); ++i)
        places[static_cast<std::size_t>(i)] = {
            static_cast<std::int8_t>(i * cell + cell / 2),
            static_cast<std::int8_t>((i * g % static_cast<int>(n)) * cell + cell / 2)};
    return places;
}

} // namespace

std::span<const SamplePlace> sample_places(int samples) {
    static constexpr std::array<SamplePlace, 1> one{{{8, 8}}};
    // The rotated grid, which no lattice on four points is.
    static constexpr std::array<SamplePlace, 4> four{{{2, 6}, {6, 14}, {10, 2}, {14, 10}}};
    static constexpr auto eight = lattice<8>(3);
    static constexpr auto sixteen = lattice<16>(7);
    switch (samples) {
    case 4:
        return four;
    case 8:
        return eight;
    case 16:
        return sixteen;
    default:
        return one;
    }
}

} // namespace alhazen
