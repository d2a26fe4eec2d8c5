/// Rays through sampled fields against dense marches, and cubics against their known roots.

#include <gtest/gtest.h>

#include "base/hash.h"
#include "sdf/voxel_field.h"
#include "tests/support/sdf_world.h"

namespace alhazen {
namespace {

using namespace testing_support;

double uniform(Rng& rng, double lo, double hi) {
    return lo + (hi - lo) * static_cast<double>(rng.uniform());
}

TEST(Cubics, FirstSignChangeIsTheLeastRoot) {
    Rng rng(1);
    int found = 0;
    for (int i = 0; i < 20000; ++i) {
        double a = uniform(rng, -1, 3), b = uniform(rng, -1, 3), c = uniform(rng, -1, 3);
        double k = std::pow(10.0, uniform(rng, -6, 6)) * (i % 2 ? 1 : -1);
        if (std::min({std::abs(a - b), std::abs(b - c), std::abs(a - c)}) < 1e-3) continue;
        // k (s - a) (s - b) (s - c)
        Cubic cubic{-k * a * b * c, k * (a * b + b * c + c * a), -k * (a + b + c), k};
        double sign = cubic[0] < 0 ? -1 : 1, least = Box::far;
        for (double root : {a, b, c})
            if (root > 0 && root < 2) least = std::min(least, root);
        auto at = first_sign_change(cubic, 2, sign);
        ASSERT_EQ(at.has_value(), least < 2);
        if (!at) continue;
        ++found;
        ASSERT_NEAR(*at, least, 1e-11);
    }
    EXPECT_GT(found, 5000);
    EXPECT_FALSE(first_sign_change({1, 0, 0, 0}, 5, 1));
    EXPECT_NEAR(*first_sign_change({1, -0.5, 0, 0}, 5, 1), 2, 1e-15);
    EXPECT_NEAR(*first_sign_change({-1, 0, 0.25, 0}, 5, -1), 2, 1e-15);
    EXPECT_FALSE(first_sign_change({1, -1, 0.25, 0}, 5, 1)); // touches, and does not cross
}

// A field of noise is the hardest: every cell has surface, and cubics have up to three roots.
GridData noise(int n) {
    GridData data = sampled(*example_sdfs().find("pebble"), n);
    Rng rng(2);
    for (GridBrick& b : data.bricks)
        for (float& v : b.values) v = 2 * rng.uniform() - 1;
    // The samples beyond the last are none of the grid's.
    return data;
}

void expect_dense_agreement(const GridData& data, int rays) {
    VoxelField field(data);
    Rng rng(3);
    Vec3d hi(data.hi);
    int hits = 0;
    for (int i = 0; i < rays; ++i) {
        Vec3d o, target;
        for (int k = 0; k < 3; ++k) {
            o[k] = i % 2 ? uniform(rng, 0, hi[k]) : uniform(rng, -hi[k], 2 * hi[k]);
            target[k] = uniform(rng, 0, hi[k]);
        }
        if (i % 7 == 0) target.x = o.x; // along the planes of the grid
        if (i % 14 == 0) target.y = o.y;
        Vec3d d = target - o;
        auto met = field.first_crossing(o, d, 3);
        auto inside = [&](double t) {
            Vec3d p = o + d * t;
            for (int k = 0; k < 3; ++k)
                if (p[k] < field.bounds().lo[k] || p[k] > field.bounds().hi[k]) return 0;
            return field.value(p) < 0 ? -1 : 1;
        };
        double end = met ? *met * (1 - 1e-9) : 3.0, step = 0.01 / length(d);
        int sign = 0;
        for (double t = 0; t < end; t += step) {
            int here = inside(t);
            if (here == 0) continue;
            if (sign == 0) sign = here;
            ASSERT_EQ(here, sign) << "ray " << i << " at " << t << ", met " << (met ? *met : -1.0);
        }
        if (!met) continue;
        ++hits;
        ASSERT_NEAR(field.value(o + d * *met), 0, 1e-11) << "ray " << i;
    }
    EXPECT_GT(hits, rays / 8);
}

TEST(VoxelFields, RaysMeetWhatADenseMarchMeets) {
    expect_dense_agreement(example_grid(), 3000);
}

TEST(VoxelFields, RaysMeetWhatADenseMarchMeetsInNoise) {
    expect_dense_agreement(noise(17), 2000);
}

TEST(VoxelFields, SmoothNormalsAreContinuousAndNearTheTrueOnes) {
    const PlacedSdf& pebble = *example_sdfs().find("pebble");
    const GridData& data = example_grid();
    VoxelField field(data);
    Rng rng(4);
    int compared = 0;
    for (int i = 0; i < 4000; ++i) {
        Vec3d p{uniform(rng, 2, data.hi.x - 2.0), uniform(rng, 2, data.hi.y - 2.0),
                uniform(rng, 2, data.hi.z - 2.0)};
        if (std::abs(field.value(p)) > 0.05) continue;
        p = field.move_to_surface(p);
        ++compared;
        Vec3d n = normalize(field.smooth_gradient(p));
        Vec3d truth = normalize(pebble.value(dual_point(data.object_from_index.point(p))).d);
        ASSERT_GT(dot(n, truth), 0.998);
        // Across the nearest side of a cell nothing jumps.
        int k = static_cast<int>(rng.below(3));
        Vec3d a = p, b = p;
        a[k] = std::round(p[k]) - 1e-9;
        b[k] = std::round(p[k]) + 1e-9;
        ASSERT_LT(length(normalize(field.smooth_gradient(a)) - normalize(field.smooth_gradient(b))), 1e-6);
    }
    EXPECT_GT(compared, 50);
}

TEST(VoxelFields, KeepOnlyWhatIsNextToTheSurface) {
    GridData data = sampled(*example_sdfs().find("pebble"), 97);
    VoxelField field(data);
    EXPECT_LT(field.bytes(), data.bricks.size() * sizeof(GridBrick) * 7 / 10);
    for (GridBrick& b : data.bricks)
        for (float& v : b.values) v = 1;
    EXPECT_TRUE(VoxelField(data).bounds().is_empty());
    EXPECT_FALSE(VoxelField(data).first_crossing({-1, 5, 5}, {1, 0, 0}, 100));
}

} // namespace
} // namespace alhazen
