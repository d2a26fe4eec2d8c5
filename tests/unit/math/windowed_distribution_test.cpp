#include "math/windowed_distribution.h"

#include <gtest/gtest.h>

#include "tests/support/density_test.h"

namespace alhazen {
namespace {

using testing_support::p_threshold;
using Window = WindowedPiecewiseConstant2D::Window;

constexpr int nx = 7, ny = 5;

std::vector<float> some_heights() {
    std::vector<float> h;
    Rng rng(3);
    for (int i = 0; i < nx * ny; ++i) h.push_back(rng.uniform() < 0.3f ? 0.0f : 1 + 9 * rng.uniform());
    h[10] = 200;
    h[16] = 3; // the only one in the third window
    return h;
}

// Integral of the heights over the window, cell by cell.
double brute_force(const std::vector<float>& h, const Window& w) {
    double sum = 0;
    for (int y = 0; y < ny; ++y)
        for (int x = 0; x < nx; ++x) {
            auto overlap = [](float lo, float hi, int i, int n) {
                return std::max(0.0, std::min(static_cast<double>(hi), (i + 1.0) / n) -
                                         std::max(static_cast<double>(lo), static_cast<double>(i) / n));
            };
            sum += static_cast<double>(h[static_cast<std::size_t>(y * nx + x)]) *
                   overlap(w.lo.x, w.hi.x, x, nx) * overlap(w.lo.y, w.hi.y, y, ny);
        }
    return sum;
}

const Window windows[] = {{{0, 0}, {1, 1}},
                          {{0.13f, 0.25f}, {0.81f, 0.93f}},
                          {{0.3f, 0.41f}, {0.35f, 0.44f}},    // within one cell
                          {{0.55f, 0.1f}, {0.58f, 0.99f}},    // within one column
                          {{1.0f / 7, 0.2f}, {3.0f / 7, 1}}}; // along the cells

TEST(WindowedDistribution, DensityIsTheHeightOverTheWindowsIntegral) {
    const auto h = some_heights();
    WindowedPiecewiseConstant2D d(h, nx, ny);
    Rng rng(4);
    for (const Window& w : windows) {
        const double total = brute_force(h, w);
        for (int i = 0; i < 200; ++i) {
            Vec2 p{rng.uniform(), rng.uniform()};
            int cell = static_cast<int>(p.y * ny) * nx + static_cast<int>(p.x * nx);
            double expected =
                w.contains(p) ? static_cast<double>(h[static_cast<std::size_t>(cell)]) / total : 0;
            EXPECT_NEAR(d.pdf(p, w), expected, 1e-5 * expected);
        }
    }
}

// p-value of the points' counts in 8 x 8 parts of the window.
double chi_square(const std::vector<float>& h, const Window& w, const std::vector<Vec2>& points) {
    constexpr int cells = 8;
    const Vec2 size = (w.hi - w.lo) * (1.0f / cells);
    std::vector<double> counts(cells * cells), expected(cells * cells);
    for (int i = 0; i < cells * cells; ++i) {
        const Vec2 lo =
            w.lo + Vec2{size.x * static_cast<float>(i % cells), size.y * static_cast<float>(i / cells)};
        expected[static_cast<std::size_t>(i)] =
            static_cast<double>(points.size()) * brute_force(h, {lo, lo + size}) / brute_force(h, w);
    }
    for (Vec2 p : points) {
        auto cell = [](float v, float lo, float width) {
            return std::clamp(static_cast<int>((v - lo) / width), 0, cells - 1);
        };
        counts[static_cast<std::size_t>(cell(p.y, w.lo.y, size.y) * cells + cell(p.x, w.lo.x, size.x))] += 1;
    }
    return testing_support::chi_square_test(counts, expected).p_value;
}

TEST(WindowedDistribution, SamplesFollowTheDensityWithinTheWindow) {
    const auto h = some_heights();
    WindowedPiecewiseConstant2D d(h, nx, ny);
    Rng rng(5);
    for (const Window& w : windows) {
        std::vector<Vec2> points;
        for (int i = 0; i < 100000; ++i) {
            const Vec2 u{rng.uniform(), rng.uniform()};
            auto s = d.sample(u, w);
            ASSERT_TRUE(s && w.contains(s->p));
            points.push_back(s->p);
            // The point itself may be rounded into the next cell.
            auto middle = [](int k, int n, float lo, float hi) {
                return (std::max(lo, static_cast<float>(k) / static_cast<float>(n)) +
                        std::min(hi, static_cast<float>(k + 1) / static_cast<float>(n))) /
                       2;
            };
            ASSERT_FLOAT_EQ(
                s->pdf,
                d.pdf({middle(s->cell.x, nx, w.lo.x, w.hi.x), middle(s->cell.y, ny, w.lo.y, w.hi.y)}, w));
        }
        EXPECT_GT(chi_square(h, w, points), p_threshold);
    }
}

TEST(WindowedDistribution, NothingComesOfWindowsThatAreBlackOrEmpty) {
    std::vector<float> h(nx * ny, 0.0f);
    h[0] = 1;
    WindowedPiecewiseConstant2D d(h, nx, ny);
    EXPECT_FALSE(d.sample({0.5f, 0.5f}, {{0.5f, 0.5f}, {1, 1}}));
    EXPECT_EQ(d.pdf({0.75f, 0.75f}, {{0.5f, 0.5f}, {1, 1}}), 0);
    EXPECT_FALSE(d.sample({0.5f, 0.5f}, {{0.1f, 0}, {0.1f, 0.2f}}));
    // Bad numbers count as 0.
    h[0] = -1;
    h[1] = infinity;
    h[2] = std::nanf("");
    h[34] = 2;
    WindowedPiecewiseConstant2D bad(h, nx, ny);
    auto s = bad.sample({0.5f, 0.5f}, {{0, 0}, {1, 1}});
    ASSERT_TRUE(s);
    EXPECT_EQ(s->cell, Vec2i(6, 4));
    EXPECT_FLOAT_EQ(s->pdf, 35);
}

} // namespace
} // namespace alhazen
