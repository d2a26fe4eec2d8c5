#include "media/majorant_grid.h"

#include <gtest/gtest.h>

#include "base/hash.h"

namespace alhazen {
namespace {

const Bounds3 box{{-1, 0, 2}, {3, 2, 5}};

float random_density(const Bounds3& cell) {
    const Vec3 c = cell.centroid();
    const auto number = hash_of(std::lround(c.x * 64), std::lround(c.y * 64), std::lround(c.z * 64));
    return unit_float(number) < 0.3f ? 0 : unit_float(mix_bits(number));
}

MajorantGrid random_grid(Vec3i cells) {
    return MajorantGrid(box, cells, random_density);
}

Vec3 random_point(Rng& rng, float scale) {
    return Vec3(rng.uniform() - 0.5f, rng.uniform() - 0.5f, rng.uniform() - 0.5f) * scale;
}

// The density of the cell around a point, by division.
float density_at(const MajorantGrid& grid, Vec3 p) {
    if (!box.contains(p)) return 0;
    Vec3i cell;
    for (int i = 0; i < 3; ++i) {
        const float f = (p[i] - box.lo[i]) / (box.hi[i] - box.lo[i]) * static_cast<float>(grid.cells()[i]);
        cell[i] = std::clamp(static_cast<int>(f), 0, grid.cells()[i] - 1);
    }
    return grid.density(cell);
}

TEST(MajorantWalk, SegmentsJoinAndHaveTheDensityOfTheirCells) {
    Rng rng(1);
    for (Vec3i cells : {Vec3i{1, 1, 1}, Vec3i{4, 3, 5}, Vec3i{16, 16, 16}}) {
        const MajorantGrid grid = random_grid(cells);
        for (int k = 0; k < 2000; ++k) {
            Ray ray{box.centroid() + random_point(rng, 8), random_point(rng, 4)};
            if (k % 5 == 0) ray.d[k % 3] = 0;
            if (k % 3 == 0) ray.tmax = rng.uniform() * 3;
            MajorantWalk walk(grid, ray);
            float end = -1;
            int count = 0;
            while (const auto segment = walk.next()) {
                ASSERT_LE(segment->begin, segment->end);
                ASSERT_LE(segment->end, ray.tmax);
                if (end >= 0) {
                    ASSERT_EQ(segment->begin, end);
                }
                end = segment->end;
                ASSERT_LT(++count, 64);
                if (segment->end - segment->begin > 1e-4f) {
                    ASSERT_EQ(segment->density,
                              density_at(grid, ray.at((segment->begin + segment->end) / 2)));
                }
            }
        }
    }
}

TEST(MajorantWalk, CoversTheRaysWayThroughTheBox) {
    const MajorantGrid grid = random_grid({5, 4, 3});
    Rng rng(2);
    for (int k = 0; k < 2000; ++k) {
        const Vec3 inside = box.lo + box.diagonal() * Vec3(rng.uniform(), rng.uniform(), rng.uniform());
        Ray ray{inside + random_point(rng, 20), {}};
        ray.d = inside - ray.o;
        MajorantWalk walk(grid, ray);
        bool is_covered = false;
        while (const auto segment = walk.next())
            is_covered |= segment->begin <= 1 + 1e-5f && segment->end >= 1 - 1e-5f;
        ASSERT_TRUE(is_covered);
    }
}

TEST(MajorantWalk, WithoutABoxReachesTheRaysEnd) {
    const MajorantGrid everywhere;
    MajorantWalk walk(everywhere, {{1, 2, 3}, {0, 0, 1}, 7});
    const auto segment = walk.next();
    ASSERT_TRUE(segment);
    EXPECT_EQ(segment->begin, 0);
    EXPECT_EQ(segment->end, 7);
    EXPECT_EQ(segment->density, 1);
    EXPECT_FALSE(walk.next());
}

} // namespace
} // namespace alhazen
