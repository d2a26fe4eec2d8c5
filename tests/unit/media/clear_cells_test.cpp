#include "media/clear_cells.h"

#include <gtest/gtest.h>

#include "media/collisions.h"

namespace alhazen {
namespace {

/// As dense as its majorants are, cells of a cube of side 4 that is turned and placed.
struct Blocks final : Medium {
    explicit Blocks(bool has_cells = true) {
        world_from_medium_ = Transform(Matrix4::translate({1, 2, 3}) * Matrix4::rotate(30, {1, 1, 0}));
        if (!has_cells) return;
        majorants_ = MajorantGrid({{0, 0, 0}, {4, 4, 4}}, {8, 8, 8}, [](const Bounds3& cell) {
            const Vec3 c = cell.centroid();
            return c.x > 1 && c.x < 2 ? 0.0f : 0.1f + c.y * 0.4f;
        });
    }
    MediumColors colors(const Wavelengths&) const override { return {0.1f, 0.9f, 0}; }
    MediumPoint at(Vec3, const MediumColors& c, const Wavelengths&) const override {
        return {c.sigma_a * 0.05f, c.sigma_s * 0.05f, 0};
    }
    bool is_emissive() const override { return false; }
    Vec3 to_world(Vec3 p) const { return world_from_medium_.point(p); }
};

struct Outcome {
    std::vector<float> places;
    Spectrum transmittance = 0;
    bool asked = false; ///< for the surface
};

Outcome outcome_of(Collisions collisions, float surface) {
    Outcome outcome;
    for (;;) {
        while (const auto collision = collisions.next()) {
            outcome.places.push_back(collision->t);
            if (outcome.places.size() == 3) return outcome;
        }
        if (!collisions.needs_surface()) break;
        EXPECT_FALSE(outcome.asked);
        outcome.asked = true;
        collisions.meet(surface);
    }
    outcome.transmittance = collisions.transmittance();
    return outcome;
}

// Where a ray meets the plane piece that fills a box which is flat along x; infinity where it does not.
float meet(const Ray& ray, const Bounds3& piece) {
    const float t = (piece.lo.x - ray.o.x) / ray.d.x;
    Vec3 p = ray.at(t);
    p.x = piece.lo.x;
    return t > 0 && piece.contains(p) ? t : infinity;
}

TEST(ClearCells, SurfacesAreKnownWhereTheyMatter) {
    const Blocks medium;
    // In the world, as large as the medium is, and through its midst.
    const Vec3 midst = medium.to_world({2, 2, 2});
    const Bounds3 piece{midst - Vec3(0, 0.7f, 0.7f), midst + Vec3(0, 0.7f, 0.7f)};
    ClearCells clear(medium);
    clear.add_surface(piece);
    clear.add_surface({}); // nothing
    Rng rng(7);
    int asked = 0, met = 0;
    constexpr int rays = 4000;
    for (int i = 0; i < rays; ++i) {
        // Some begin outside.
        const Vec3 from = Vec3(rng.uniform(), rng.uniform(), rng.uniform()) * 5 - Vec3(0.5f);
        const Vec3 to = Vec3(rng.uniform(), rng.uniform(), rng.uniform()) * 4;
        Ray ray{medium.to_world(from), medium.to_world(to) - medium.to_world(from), infinity, 0};
        if (i % 3 == 0) ray.tmax = 1; // a lamp's
        const float surface = std::min(meet(ray, piece), ray.tmax);
        const float u = rng.uniform();
        Ray known = ray;
        known.tmax = surface;
        const Wavelengths lambda;
        const MediumColors colors = medium.colors(lambda);
        const Rng numbers(static_cast<std::uint64_t>(i));
        const Outcome lazy =
            outcome_of(Collisions(medium, ray, lambda, colors, 0, u, numbers, &clear), surface);
        const Outcome eager = outcome_of(Collisions(medium, known, lambda, colors, 0, u, numbers), surface);
        ASSERT_EQ(lazy.places, eager.places) << i;
        ASSERT_EQ(lazy.transmittance, eager.transmittance) << i;
        asked += lazy.asked;
        met += surface < ray.tmax;
    }
    EXPECT_GT(met, rays / 50);
    EXPECT_GT(asked, rays / 5);
    EXPECT_LT(asked, rays * 9 / 10);
}

TEST(ClearCells, WithoutCellsSurfacesMustBeKnownAtOnce) {
    const Blocks medium(false);
    ClearCells clear(medium);
    clear.add_surface({{0, 0, 0}, {1, 1, 1}});
    const Wavelengths lambda;
    Collisions collisions(medium, {{}, {1, 0, 0}, infinity, 0}, lambda, medium.colors(lambda), 0, 0.5f,
                          Rng(1), &clear);
    EXPECT_FALSE(collisions.next());
    EXPECT_TRUE(collisions.needs_surface());
    collisions.meet(1e-3f);
    EXPECT_FALSE(collisions.next());
    EXPECT_FALSE(collisions.needs_surface());
}

} // namespace
} // namespace alhazen
