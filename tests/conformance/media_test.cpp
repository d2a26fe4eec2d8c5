/// What every participating medium owes the integrators, whatever its kind: checked for all that the registry
/// documents.
#include "media/collisions.h"
#include "tests/support/density_test.h"
#include "tests/support/family.h"
#include "tests/support/smoke.h"

namespace alhazen {
namespace {

const GridReader grid_reader = testing_support::smoke;
const Matrix4 placement =
    Matrix4::translate({0.3, -0.2, 1}) * Matrix4::rotate(40, {1, 2, 3}) * Matrix4::scale({2, 1.5, 0.8});

template <class Visit>
void for_each_medium(Visit visit) {
    for (const ColorMode mode : {ColorMode::rgb, ColorMode::spectral}) {
        const Wavelengths lambda =
            mode == ColorMode::rgb ? Wavelengths::rgb() : Wavelengths::sample_visible(0.3f);
        testing_support::for_each_example(
            medium_kinds(),
            [&](const std::string&, const std::string&, const Medium& medium) { visit(medium, lambda); },
            [&](BuildContext& context) {
                context.color_mode = mode;
                context.grid_reader = &grid_reader;
                context.world_from_node = Transform(placement);
            });
    }
}

Vec3 random_vector(Rng& rng) {
    return Vec3(rng.uniform() - 0.5f, rng.uniform() - 0.5f, rng.uniform() - 0.5f);
}

// Along random rays, in the medium's own space.
TEST(Media, MajorantsBoundWhatIsThere) {
    for_each_medium([](const Medium& medium, const Wavelengths& lambda) {
        const MediumColors colors = medium.colors(lambda);
        ASSERT_TRUE(colors.sigma_a.is_finite() && colors.sigma_s.is_finite() && colors.Le.is_finite());
        ASSERT_GE(std::min(colors.sigma_a.min(), colors.sigma_s.min()), 0);
        Rng rng(1);
        bool is_anything = false, glows = false;
        for (int k = 0; k < 400; ++k) {
            Ray ray{random_vector(rng) * 3, random_vector(rng), 20};
            MajorantWalk walk(medium.majorants(), ray);
            while (const auto segment = walk.next()) {
                const float t = lerp(rng.uniform(), segment->begin, segment->end);
                const MediumPoint at = medium.at(ray.at(t), colors, lambda);
                const Spectrum bound = colors.sigma_t() * segment->density;
                ASSERT_TRUE(at.sigma_a.is_finite() && at.sigma_s.is_finite() && at.Le.is_finite());
                ASSERT_GE(std::min(at.sigma_a.min(), at.sigma_s.min()), 0);
                ASSERT_GE(at.Le.sum(), 0);
                ASSERT_GE((bound * 1.0001f + 1e-6f - at.sigma_a - at.sigma_s).min(), 0);
                is_anything |= !(at.sigma_a + at.sigma_s).is_black();
                glows |= !at.Le.is_black();
            }
        }
        EXPECT_TRUE(is_anything);
        EXPECT_EQ(glows, medium.is_emissive());
    });
}

// Of rays through the medium, those that come through without a real collision: the transmittance, by a fine
// sum along the ray. Every lane is the hero once.
TEST(Media, CollisionsFollowTheTransmittance) {
    for_each_medium([](const Medium& medium, const Wavelengths& lambda) {
        const MediumColors colors = medium.colors(lambda);
        const Ray ray{Transform(placement).point(Vec3{0.1f, 0.3f, -3}),
                      Transform(placement).vector(Vec3{0.05f, 0.02f, 0.7f}), 8};
        const Ray local = medium.to_medium(ray);
        Spectrum depth = 0;
        constexpr int steps = 20000;
        for (int i = 0; i < steps; ++i) {
            const float t = (static_cast<float>(i) + 0.5f) / steps * ray.tmax;
            const Vec3 p = local.at(t);
            const MajorantGrid& grid = medium.majorants();
            if (!grid.is_everywhere() && !grid.box().contains(p)) continue;
            const MediumPoint at = medium.at(p, colors, lambda);
            depth += (at.sigma_a + at.sigma_s) * (ray.tmax / steps * length(ray.d));
        }
        Rng rng(2);
        for (int hero = 0; hero < 3; ++hero) {
            constexpr int rays = 4000;
            int through = 0;
            for (int i = 0; i < rays; ++i) {
                Collisions collisions(medium, ray, lambda, colors, hero, rng.uniform(),
                                      Rng(static_cast<std::uint64_t>(i), 7));
                bool is_stopped = false;
                while (const auto c = collisions.next()) {
                    const float real = c->at.sigma_a[hero] + c->at.sigma_s[hero];
                    is_stopped = collisions.uniform() * c->sigma_maj[hero] < real;
                    if (is_stopped) break;
                }
                through += !is_stopped;
            }
            const double expected = std::exp(-static_cast<double>(depth[hero]));
            const double deviation = std::sqrt(expected * (1 - expected) / rays);
            // 5 standard deviations, and the sum's own error.
            EXPECT_NEAR(static_cast<double>(through) / rays, expected, 5 * deviation + 1e-3);
        }
    });
}

} // namespace
} // namespace alhazen
