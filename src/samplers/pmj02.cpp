#include "samplers/pmj02.h"

#include "samplers/sobol_sequence.h"

namespace alhazen {

namespace {

// In y, the number by which that of the earlier point differs whose strip the point 2^k + i shares. Helmer,
// Christensen and Kensler 2021 tabulate such numbers; those of Pascal's matrix modulo 2, which is its own
// inverse, are the digits r < k for which C(k, r) is odd: where r has no digit that k lacks. In x they are 0.
constexpr std::uint32_t xor_value(std::uint32_t k) {
    std::uint32_t value = 0;
    for (std::uint32_t r = 0; r < k; ++r)
        if ((r & ~k) == 0) value |= 1u << r;
    return value;
}

/// Of a point, 32 after the binary point.
struct Digits {
    std::uint32_t x, y;
};

} // namespace

// Stochastic generation (Helmer et al. 2021, section 4): each point goes into the empty half, in x and in y,
// of the strip of an earlier one, and there anywhere.
std::vector<Vec2> pmj02_points(int log2_count, std::uint64_t seed) {
    Rng rng(seed);
    std::vector<Digits> places{{rng.next(), rng.next()}};
    for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(log2_count); ++k) {
        const std::uint32_t half = 0x80000000u >> k, below = half - 1, count = 1u << k;
        for (std::uint32_t i = 0; i < count; ++i) {
            const std::uint32_t x = places[i].x ^ half, y = places[i ^ xor_value(k)].y ^ half;
            const std::uint32_t new_x = (x & ~below) | (rng.next() & below);
            places.push_back({new_x, (y & ~below) | (rng.next() & below)});
        }
    }
    const auto key = static_cast<std::uint32_t>(mix_bits(seed));
    std::vector<Vec2> points(places.size());
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        // Digits of the number depend on higher ones only, by Owen's scrambling: runs of 2^k stay runs of
        // 2^k.
        const std::uint32_t mask = static_cast<std::uint32_t>(points.size()) - 1;
        const Digits& p = places[reverse_bits(hash_owen(reverse_bits(i), key)) & mask];
        points[i] = {unit_float(p.x), unit_float(p.y)};
    }
    return points;
}

} // namespace alhazen
