/// Does what a function samples follow the density it claims? Chi-square tests of a warp over a rectangle or
/// a line. Tests use fixed seeds, so that a false alarm can only happen when a test is written or its seed is
/// changed; the rate over all the tests of one program is kept below 0.001 for up to 10000 of them (Sidak).
#pragma once

#include <functional>

#include "base/hash.h"
#include "base/vec.h"
#include "tests/support/chi_square.h"

namespace alhazen::testing_support {

/// Two random numbers.
inline Vec2 random_pair(Rng& rng) {
    return {rng.uniform(), rng.uniform()};
}

/// A test fails when its p-value is below this.
inline const double p_threshold = sidak_level(1e-3, 10000);

/// A rectangle, for densities over it.
struct Box2 {
    double x0 = 0, x1 = 1, y0 = 0, y1 = 1;
};

/// p-value of the points that sample makes of n random pairs against a density over the box (its integral, by
/// the midpoint rule with sub x sub points a cell, must be 1; the part that is missing counts as points
/// outside the box).
inline double chi_square_2d(const std::function<Vec2(Vec2)>& sample,
                            const std::function<double(Vec2)>& density, Box2 box, int n = 200000,
                            int cells = 16, int sub = 8, std::uint64_t seed = 1) {
    const auto size = static_cast<std::size_t>(cells);
    std::vector<double> counts(size * size + 1), expected(size * size + 1);
    const double wx = (box.x1 - box.x0) / cells, wy = (box.y1 - box.y0) / cells;
    double total = 0;
    for (int y = 0; y < cells * sub; ++y)
        for (int x = 0; x < cells * sub; ++x) {
            Vec2 p(static_cast<float>(box.x0 + wx * (x + 0.5) / sub),
                   static_cast<float>(box.y0 + wy * (y + 0.5) / sub));
            double mass = density(p) * wx * wy / (sub * sub);
            expected[static_cast<std::size_t>(y / sub) * size + static_cast<std::size_t>(x / sub)] +=
                n * mass;
            total += mass;
        }
    expected.back() = std::max(0.0, n * (1 - total));
    if (expected.back() < 1e-3 * n) expected.back() = 0; // the midpoint rule's own error
    Rng rng(seed);
    for (int i = 0; i < n; ++i) {
        float u = rng.uniform(), v = rng.uniform();
        Vec2 p = sample({u, v});
        double cx = std::floor((static_cast<double>(p.x) - box.x0) / wx),
               cy = std::floor((static_cast<double>(p.y) - box.y0) / wy);
        // A point on the far edge, by rounding, belongs to the last cell.
        if (cx == cells && static_cast<double>(p.x) <= box.x1 + 1e-5 * (box.x1 - box.x0)) --cx;
        if (cy == cells && static_cast<double>(p.y) <= box.y1 + 1e-5 * (box.y1 - box.y0)) --cy;
        bool inside = cx >= 0 && cx < cells && cy >= 0 && cy < cells;
        counts[inside ? static_cast<std::size_t>(cy) * size + static_cast<std::size_t>(cx) : size * size] +=
            1;
    }
    for (std::size_t i = 0; i < counts.size(); ++i)
        if (expected[i] < 1e-9 && counts[i] > 0) return 0;
    return chi_square_test(counts, expected).p_value;
}

/// The same along a line.
inline double chi_square_1d(const std::function<float(float)>& sample,
                            const std::function<double(float)>& density, double lo, double hi,
                            int n = 100000) {
    return chi_square_2d([&](Vec2 u) { return Vec2(sample(u.x), u.y); }, [&](Vec2 p) { return density(p.x); },
                         {lo, hi, 0, 1}, n, 32, 8);
}

} // namespace alhazen::testing_support
