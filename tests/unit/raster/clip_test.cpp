/// Clipping before the division by w.
#include <gtest/gtest.h>

#include "base/hash.h"
#include "raster/clip.h"
#include "raster/setup.h"

namespace alhazen::testing {
namespace {

ClipCorner random_corner(Rng& rng) {
    auto u = [&](double scale) { return static_cast<double>(rng.uniform() * 2 - 1) * scale; };
    const double w = u(3);
    return {u(30000), u(30000), w, w};
}

TEST(Clip, KeepsWhatIsInsideAndNothingElse) {
    Rng rng(3);
    constexpr double near_depth = 1e-3;
    int cut = 0;
    for (int n = 0; n < 20000; ++n) {
        const std::array<ClipCorner, 3> t{random_corner(rng), random_corner(rng), random_corner(rng)};
        const ClipPolygon polygon = clip_triangle(t, near_depth);
        cut += polygon.count > 3;
        for (std::size_t i = 0; i < polygon.count; ++i) {
            const ClipCorner& c = polygon.corners[i];
            ASSERT_GE(c.depth, near_depth * (1 - 1e-9));
            ASSERT_GE(c.x / c.w, raster_guard_low);
            ASSERT_LE(c.x / c.w, raster_guard_high);
            ASSERT_GE(c.y / c.w, raster_guard_low);
            ASSERT_LE(c.y / c.w, raster_guard_high);
        }
        // A random point of the triangle that is inside is on the polygon's side of all its edges, in (x, y,
        // w).
        double a = static_cast<double>(rng.uniform()), b = static_cast<double>(rng.uniform()) * (1 - a);
        auto mix = [&](double p, double q, double r) { return p * a + q * b + r * (1 - a - b); };
        const Vec3d p{mix(t[0].x, t[1].x, t[2].x), mix(t[0].y, t[1].y, t[2].y), mix(t[0].w, t[1].w, t[2].w)};
        const bool inside = p.z >= near_depth * 1.01 && p.x > (raster_guard_low + 2) * p.z &&
                            p.x < (raster_guard_high - 2) * p.z && p.y > (raster_guard_low + 2) * p.z &&
                            p.y < (raster_guard_high - 2) * p.z;
        if (!inside) continue;
        ASSERT_GE(polygon.count, 3u);
        int positive = 0, negative = 0;
        for (std::size_t i = 0; i < polygon.count; ++i) {
            auto vector = [](const ClipCorner& c) { return Vec3d{c.x, c.y, c.w}; };
            const Vec3d q = vector(polygon.corners[i]), r = vector(polygon.corners[(i + 1) % polygon.count]);
            const double volume = dot(p, cross(q, r)), size = length(p) * length(q) * length(r);
            positive += volume > 1e-12 * size;
            negative += volume < -1e-12 * size;
        }
        ASSERT_TRUE(positive == 0 || negative == 0) << n;
    }
    EXPECT_GT(cut, 1000);
}

TEST(Clip, NeighboursKeepTheirEdge) {
    Rng rng(4);
    constexpr double near_depth = 1;
    // Where w is 1, such corners are within the guard band.
    auto corner = [&rng] {
        ClipCorner c = random_corner(rng);
        c.x /= 10;
        c.y /= 10;
        return c;
    };
    int found = 0;
    for (int n = 0; n < 2000; ++n) {
        const ClipCorner a = corner(), b = corner();
        const ClipPolygon left = clip_triangle({a, b, corner()}, near_depth);
        const ClipPolygon right = clip_triangle({b, a, corner()}, near_depth);
        // Where the near plane cuts the edge, both have the same corner to the last bit.
        if ((a.depth < near_depth) == (b.depth < near_depth)) continue;
        const ClipCorner& in = a.depth < near_depth ? b : a;
        const ClipCorner& out = a.depth < near_depth ? a : b;
        const double at = (in.depth - near_depth) / ((in.depth - near_depth) - (out.depth - near_depth));
        const double x = in.x + (out.x - in.x) * at;
        auto has = [&](const ClipPolygon& polygon) {
            for (std::size_t i = 0; i < polygon.count; ++i)
                if (polygon.corners[i].x == x) return true;
            return false;
        };
        EXPECT_TRUE(has(left) && has(right)) << n;
        ++found;
    }
    EXPECT_GT(found, 500);
}

} // namespace
} // namespace alhazen::testing
