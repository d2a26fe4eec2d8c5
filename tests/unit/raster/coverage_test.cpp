/// Which samples a triangle covers, against exact arithmetic: signs of determinants in 128-bit integers, ties
/// broken by moving the sample a little to the right and much less down, which is what the top-left rule
/// amounts to.
#include <set>

#include <gtest/gtest.h>

#include "base/hash.h"
#include "raster/dispatch.h"
#include "raster/sample_places.h"
#include "raster/setup.h"

namespace alhazen::testing {
namespace {

__extension__ using Exact = __int128;
using Triangle = std::array<Vec2d, 3>;

/// A picture of tiles, as the rasteriser keeps them, with a count for each sample.
class Canvas {
  public:
    Canvas(Vec2i size, int samples, const RasterKernel& kernel)
        : size_(size), samples_(samples), kernel_(kernel) {
        covered.resize(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) *
                       static_cast<std::size_t>(samples));
    }

    std::size_t index(int x, int y, int s) const {
        return (static_cast<std::size_t>(y) * static_cast<std::size_t>(size_.x) +
                static_cast<std::size_t>(x)) *
                   static_cast<std::size_t>(samples_) +
               static_cast<std::size_t>(s);
    }

    /// Draws one triangle on an empty picture and counts where it comes to lie.
    void draw(const Triangle& t) {
        std::array<RasterCorner, 3> corners;
        for (std::size_t i = 0; i < 3; ++i) corners[i] = make_corner(t[i].x, t[i].y, 1);
        const std::array<std::uint8_t, 3> sides{};
        const std::array<std::uint16_t, 3> numbers{0, 1, 2};
        std::array<RasterTriangle, 2> kept;
        const RasterPart part{0, 0, size_.x, size_.y, samples_ == 1};
        if (kernel_.cull(part, corners.data(), sides.data(), numbers.data(), 1, kept.data()) == 0) return;
        for (int y = 0; y < size_.y; y += raster_tile)
            for (int x = 0; x < size_.x; x += raster_tile) draw_tile(kept[0], corners.data(), x, y);
    }

    std::vector<int> covered;

  private:
    void draw_tile(const RasterTriangle& triangle, const RasterCorner* corners, int x0, int y0) {
        const std::size_t count = std::size_t{raster_tile} * raster_tile * static_cast<std::size_t>(samples_);
        std::vector<float> nearness(count, -infinity);
        std::vector<std::uint32_t> fragment(count, raster_nothing);
        RasterTarget target{};
        target.x = x0;
        target.y = y0;
        target.samples = static_cast<std::uint32_t>(samples_);
        target.nearness = nearness.data();
        target.fragment = fragment.data();
        std::fill(std::begin(target.block_nearness), std::end(target.block_nearness), -infinity);
        std::size_t s = 0;
        for (SamplePlace place : sample_places(samples_)) {
            target.sample_x[s] = place.x * (raster_subpixels / 16);
            target.sample_y[s++] = place.y * (raster_subpixels / 16);
        }
        const std::uint32_t list = 0;
        kernel_.draw(target, {&triangle, corners, nullptr, &list, 1, 7, triangle.q_max, nullptr, nullptr});
        for (int y = y0; y < std::min(y0 + raster_tile, size_.y); ++y)
            for (int x = x0; x < std::min(x0 + raster_tile, size_.x); ++x)
                for (int i = 0; i < samples_; ++i) {
                    const int block = (y - y0) / raster_block * raster_blocks + (x - x0) / raster_block;
                    const std::size_t place = static_cast<std::size_t>(
                        (block * samples_ + i) * raster_block_pixels +
                        (y - y0) % raster_block * raster_block + (x - x0) % raster_block);
                    covered[index(x, y, i)] += fragment[place] == 7;
                }
    }

    Vec2i size_;
    int samples_;
    const RasterKernel& kernel_;
};

struct FixedPoint {
    std::int32_t x, y;
};

/// Twice the signed area of p, q and the sample, and its sign after the tie is broken.
int side(FixedPoint p, FixedPoint q, FixedPoint sample) {
    const Exact dx = q.x - p.x, dy = q.y - p.y;
    const Exact area = dx * (Exact{sample.y} - p.y) - dy * (Exact{sample.x} - p.x);
    if (area != 0) return area > 0 ? 1 : -1;
    // How the area changes to the right; else how it changes downwards.
    const Exact change = dy != 0 ? -dy : dx;
    return change > 0 ? 1 : change < 0 ? -1 : 0;
}

bool covers(const Triangle& t, FixedPoint sample) {
    std::array<FixedPoint, 3> p;
    for (std::size_t i = 0; i < 3; ++i) {
        const RasterCorner corner = make_corner(t[i].x, t[i].y, 1);
        p[i] = {corner.fixed_x, corner.fixed_y};
    }
    const Exact area =
        Exact{p[1].x - p[0].x} * (p[2].y - p[0].y) - Exact{p[2].x - p[0].x} * (p[1].y - p[0].y);
    if (area == 0) return false;
    const int inside = area > 0 ? 1 : -1;
    for (std::size_t i = 0; i < 3; ++i)
        if (side(p[i], p[(i + 1) % 3], sample) != inside) return false;
    return true;
}

class Coverage : public ::testing::TestWithParam<int> {};

Vec2d random_corner(Rng& rng, int kind, Vec2i size) {
    auto u = [&] { return static_cast<double>(rng.uniform()); };
    switch (kind % 5) {
    case 0: // in and around the picture
        return {(u() * 1.5 - 0.25) * size.x, (u() * 1.5 - 0.25) * size.y};
    case 1: // on samples and pixels' borders, where ties are
        return {std::floor(u() * size.x * 2) / 2, std::floor(u() * size.y * 2) / 2};
    case 2: // on a grid of sixteenths within a few pixels
        return {20 + std::floor(u() * 64) / 16, 30 + std::floor(u() * 64) / 16};
    case 3: // as far as corners may lie
        return {raster_guard_low + u() * (raster_guard_high - raster_guard_low),
                raster_guard_low + u() * (raster_guard_high - raster_guard_low)};
    default: // slivers
        return {u() * size.x, 24 + u() * 1e-2};
    }
}

TEST_P(Coverage, IsExactOnRandomTriangles) {
    const Vec2i size{75, 50};
    const int samples = GetParam();
    std::size_t covered = 0;
    for (const RasterKernel* kernel : supported_raster_kernels()) {
        Rng rng(31);
        for (int n = 0; n < 4000 / (samples + 2); ++n) {
            Triangle t;
            for (Vec2d& corner : t) corner = random_corner(rng, n, size);
            Canvas canvas(size, samples, *kernel);
            canvas.draw(t);
            for (int y = 0; y < size.y; ++y)
                for (int x = 0; x < size.x; ++x)
                    for (int s = 0; s < samples; ++s) {
                        const SamplePlace place = sample_places(samples)[static_cast<std::size_t>(s)];
                        constexpr int unit = raster_subpixels / 16;
                        const FixedPoint at{x * raster_subpixels + place.x * unit,
                                            y * raster_subpixels + place.y * unit};
                        const int drawn = canvas.covered[canvas.index(x, y, s)];
                        covered += static_cast<std::size_t>(drawn);
                        ASSERT_EQ(drawn, covers(t, at))
                            << kernel->name << " triangle " << n << " pixel " << x << "," << y;
                    }
        }
    }
    EXPECT_GT(covered, 100000u);
}

// A grid whose inner points are moved about, each cell cut along a random diagonal, in random winding.
TEST_P(Coverage, SharedEdgesGiveEachSampleToOneTriangle) {
    const Vec2i size{64, 64};
    constexpr int cells = 12;
    for (const RasterKernel* kernel : supported_raster_kernels()) {
        Rng rng(5);
        for (int repeat = 0; repeat < 20; ++repeat) {
            // Every other time corners are on samples and pixels' borders.
            const bool ties = repeat % 2 == 1;
            std::array<std::array<Vec2d, cells + 1>, cells + 1> p;
            for (int j = 0; j <= cells; ++j)
                for (int i = 0; i <= cells; ++i) {
                    const double step = 80.0 / cells;
                    Vec2d at{-8 + step * i, -8 + step * j};
                    if (i > 0 && i < cells && j > 0 && j < cells)
                        at += Vec2d(Vec2{rng.uniform() - 0.5f, rng.uniform() - 0.5f}) * (0.8 * step);
                    if (ties) at = {std::round(at.x * 2) / 2, std::round(at.y * 2) / 2};
                    p[static_cast<std::size_t>(j)][static_cast<std::size_t>(i)] = at;
                }
            Canvas canvas(size, GetParam(), *kernel);
            auto draw = [&](Vec2d a, Vec2d b, Vec2d c) {
                if (rng.below(2)) std::swap(b, c);
                canvas.draw({a, b, c});
            };
            for (std::size_t j = 0; j < cells; ++j)
                for (std::size_t i = 0; i < cells; ++i) {
                    const Vec2d a = p[j][i], b = p[j][i + 1], c = p[j + 1][i + 1], d = p[j + 1][i];
                    // Along a diagonal that lies inside of the cell.
                    const bool is_convex_at_b = (b.x - a.x) * (c.y - b.y) - (c.x - b.x) * (b.y - a.y) > 0;
                    const bool is_convex_at_d = (d.x - c.x) * (a.y - d.y) - (a.x - d.x) * (d.y - c.y) > 0;
                    if (is_convex_at_b && is_convex_at_d) {
                        draw(a, b, c);
                        draw(a, c, d);
                    } else {
                        draw(b, c, d);
                        draw(b, d, a);
                    }
                }
            for (int y = 0; y < size.y; ++y)
                for (int x = 0; x < size.x; ++x)
                    for (int s = 0; s < GetParam(); ++s)
                        ASSERT_EQ(canvas.covered[canvas.index(x, y, s)], 1)
                            << kernel->name << " " << x << "," << y;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Samples, Coverage, ::testing::Values(1, 4, 8, 16));

// Two triangles on each other, of which the second reaches farther: whichever is drawn first.
TEST(CoverageOrder, OfTheEquallyNearTheLowestNumberShows) {
    const std::array<RasterCorner, 4> corners{make_corner(0, 0, 1), make_corner(20, 0, 1),
                                              make_corner(0, 20, 1), make_corner(30, 0, 1)};
    const std::array<std::uint8_t, 4> sides{};
    const std::array<std::uint16_t, 6> numbers{0, 1, 2, 0, 3, 2};
    std::array<RasterTriangle, 3> triangles;
    for (const RasterKernel* kernel : supported_raster_kernels())
        for (const std::array<std::uint32_t, 2>& order : {std::array{0u, 1u}, std::array{1u, 0u}}) {
            ASSERT_EQ(kernel->cull({0, 0, 32, 32, true}, corners.data(), sides.data(), numbers.data(), 2,
                                   triangles.data()),
                      2u);
            std::vector<float> nearness(raster_tile * raster_tile, -infinity);
            std::vector<std::uint32_t> fragment(raster_tile * raster_tile, raster_nothing);
            RasterTarget target{};
            target.samples = 1;
            target.sample_x[0] = target.sample_y[0] = raster_subpixels / 2;
            target.nearness = nearness.data();
            target.fragment = fragment.data();
            std::fill(std::begin(target.block_nearness), std::end(target.block_nearness), -infinity);
            for (const std::uint32_t& number : order)
                kernel->draw(target,
                             {triangles.data(), corners.data(), nullptr, &number, 1, 0, 1, nullptr, nullptr});
            // The first row: middles at x + 1/2, the edges' ends at 19.5 and 29.25.
            for (std::size_t x = 0; x < raster_tile; ++x) {
                const std::size_t place = x / raster_block * raster_block_pixels + x % raster_block;
                EXPECT_EQ(fragment[place], x < 19 ? 0 : x < 29 ? 1 : raster_nothing) << kernel->name << x;
            }
        }
}

TEST(SamplePlaces, OneInEachRowAndColumn) {
    for (int n : {4, 8, 16}) {
        std::set<int> columns, rows;
        for (SamplePlace p : sample_places(n)) {
            columns.insert(p.x * n / 16);
            rows.insert(p.y * n / 16);
        }
        EXPECT_EQ(columns.size(), static_cast<std::size_t>(n));
        EXPECT_EQ(rows.size(), static_cast<std::size_t>(n));
    }
}

} // namespace
} // namespace alhazen::testing
