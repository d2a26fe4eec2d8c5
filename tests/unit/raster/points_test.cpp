/// Matte points by the kernels for every instruction set this processor has: the same bits.
#include <gtest/gtest.h>

#include <cstring>
#include <memory>

#include "base/hash.h"
#include "raster/dispatch.h"

namespace alhazen {
namespace {

using Array = RasterPoints::Array;

std::unique_ptr<RasterPoints> random_points(std::uint32_t count, std::uint64_t seed) {
    auto points = std::make_unique<RasterPoints>();
    Rng rng(seed);
    auto fill = [&](Array& a, float lo, float hi) {
        for (float& v : a) v = lo + (hi - lo) * rng.uniform();
    };
    points->count = count;
    fill(points->film_x, 0, 1280);
    fill(points->film_y, 0, 720);
    fill(points->nearness, 1e-3f, 2);
    for (Array* a : {&points->nx, &points->ny, &points->nz}) fill(*a, -1, 1);
    return points;
}

const RasterRays perspective{{1, 2, 3}, {-1, 0.5f, 2}, {1e-3f, 2e-4f, 0}, {0, -1e-3f, 1e-4f}, true};
const RasterRays parallel{{1, 2, 3}, {-1, 0.5f, 2}, {1e-3f, 2e-4f, 0}, {0, -1e-3f, 1e-4f}, false};
const RasterLight lights[] = {
    {{}, {0.6f, 0, 0.8f}, 0, true, false, false},              // distant
    {{2, 3, -1}, {}, 0.5f, false, false, false},               // round
    {{2, 3, -1}, {0, -1, 0}, 0.5f, false, true, false},        // flat
    {{-4, 0.1f, 7}, {0.6f, -0.8f, 0}, 2.0f, false, true, true} // flat, of two sides
};

TEST(RasterPoints, KernelsGiveTheSameBits) {
    for (const RasterRays& rays : {perspective, parallel})
        for (std::uint32_t count : {1u, 15u, 17u, RasterPoints::capacity}) {
            const auto expected = random_points(count, count);
            supported_raster_kernels().back()->place(rays, *expected);
            for (const RasterKernel* kernel : supported_raster_kernels()) {
                SCOPED_TRACE(kernel->name);
                const auto points = random_points(count, count);
                kernel->place(rays, *points);
                auto expect_same = [&](const Array& a, const Array& b) {
                    EXPECT_EQ(std::memcmp(a, b, count * sizeof(float)), 0);
                };
                expect_same(points->px, expected->px);
                expect_same(points->pz, expected->pz);
                expect_same(points->ny, expected->ny);
                for (const RasterLight& light : lights) {
                    alignas(64) Array part, expected_part;
                    kernel->light(light, *points, part);
                    supported_raster_kernels().back()->light(light, *expected, expected_part);
                    expect_same(part, expected_part);
                }
            }
        }
}

// Against the formulas of FilmRays and LocalLight, in double precision.
TEST(RasterPoints, AreWhereTheirRaysLeadAndLitByTheDistance) {
    const auto points = random_points(RasterPoints::capacity, 5);
    const auto before = std::make_unique<RasterPoints>(*points);
    const RasterKernel& kernel = *supported_raster_kernels().front();
    kernel.place(perspective, *points);
    alignas(64) Array part;
    kernel.light(lights[1], *points, part);
    std::size_t lit = 0;
    for (std::size_t i = 0; i < points->count; ++i) {
        const float* const p[3] = {points->px, points->py, points->pz};
        const float* const n[3] = {points->nx, points->ny, points->nz};
        double facing = 0, d2 = 0, received = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double d = double{perspective.ahead[axis]} +
                             double{perspective.across[axis]} * before->film_x[i] +
                             double{perspective.down[axis]} * before->film_y[i];
            EXPECT_NEAR(p[axis][i], double{perspective.start[axis]} + d / before->nearness[i],
                        1e-5 * (3 + std::abs(d / before->nearness[i])));
            facing += d * n[axis][i];
            const double way = double{lights[1].p[axis]} - p[axis][i];
            d2 += way * way;
            received += way * n[axis][i];
        }
        EXPECT_LE(facing, 1e-5);
        const double value = received / std::sqrt(d2) * 0.5 / (d2 + 0.5 / 3.14159265358979);
        EXPECT_NEAR(part[i], std::max(value, 0.0), 1e-5 * (1 + std::abs(value)));
        lit += part[i] > 0;
    }
    EXPECT_GT(lit, 20u);
    EXPECT_LT(lit, points->count);
}

} // namespace
} // namespace alhazen
