// Cameras that light can be brought to: the way back from a point is the camera ray's own, and importance is
// the density of camera rays and sums up to 1.
#include <gtest/gtest.h>

#include "cameras/camera.h"
#include "tests/support/density_test.h"
#include "tests/support/family.h"

namespace alhazen {
namespace {

using testing_support::chi_square_2d;
using testing_support::p_threshold;
using testing_support::random_pair;

constexpr Vec2i film_size{80, 60};
/// Turned, mirrored and stretched: directions are no longer those of camera space.
const Matrix4 stretched =
    Matrix4::translate({3, -2, 1}) * Matrix4::rotate(35, {1, 2, 3}) * Matrix4::scale({2, -1, 0.5});

/// The plane at distance z from a camera, with coordinates of camera space.
struct Plane {
    Transform world_from_camera;
    double z;

    Vec3 point(Vec2 p) const {
        return Vec3(world_from_camera.point(Vec3d(static_cast<double>(p.x), static_cast<double>(p.y), z)));
    }
    Vec3 normal() const { return normalize(world_from_camera.normal(Vec3(0, 0, 1))); }
    /// World area of a unit of camera space's.
    float area() const {
        return length(
            cross(world_from_camera.vector(Vec3(1, 0, 0)), world_from_camera.vector(Vec3(0, 1, 0))));
    }
    /// Where the ray meets it.
    Vec2 meet(const Ray& ray) const {
        Vec3d o = world_from_camera.inverse_point(Vec3d(ray.o)),
              d = world_from_camera.inverse_vector(Vec3d(ray.d));
        Vec3d p = o + d * ((z - o.z) / d.z);
        return {static_cast<float>(p.x), static_cast<float>(p.y)};
    }
    /// Importance of a unit of area of camera space at p; 0 where the film does not reach.
    double importance(const Camera& camera, Vec2 p, Vec2 lens) const {
        auto c = camera.sample_towards(point(p), lens, 0);
        if (!c || c->film.x < 0 || c->film.y < 0 || c->film.x > static_cast<float>(film_size.x) ||
            c->film.y > static_cast<float>(film_size.y))
            return 0;
        return static_cast<double>(c->density * abs_dot(c->d, normal()) * area());
    }
};

void check_way_back(const Camera& camera) {
    Rng rng(1);
    for (int i = 0; i < 500; ++i) {
        CameraSample s{{rng.uniform() * 80, rng.uniform() * 60}, random_pair(rng), 0};
        Ray ray = camera.ray(s)->ray;
        float t = 0.5f + 4 * rng.uniform();
        auto back = camera.sample_towards(ray.at(t), s.lens, 0);
        ASSERT_TRUE(back);
        ASSERT_LT(length(back->d - ray.d), 1e-5f);
        ASSERT_LT(length(back->p - ray.o), 1e-5f);
        ASSERT_LT(length(back->film - s.film), 1e-2f);
        ASSERT_NEAR(camera.ray_density(ray, t) / back->density, 1, 1e-4f);
        // What is behind the camera it does not see.
        ASSERT_FALSE(camera.sample_towards(ray.at(-t), s.lens, 0));
    }
}

void check_density(const Camera& camera, const Plane& plane) {
    Rng rng(2);
    for (int k = 0; k < 3; ++k) {
        const Vec2 lens = random_pair(rng);
        Vec2 lo{infinity, infinity}, hi{-infinity, -infinity};
        auto sample = [&](Vec2 u) { return plane.meet(camera.ray({{u.x * 80, u.y * 60}, lens, 0})->ray); };
        for (Vec2 corner : {Vec2(0, 0), Vec2(1, 0), Vec2(0, 1), Vec2(1, 1)}) {
            Vec2 p = sample(corner);
            lo = {std::min(lo.x, p.x), std::min(lo.y, p.y)};
            hi = {std::max(hi.x, p.x), std::max(hi.y, p.y)};
        }
        auto importance = [&](Vec2 p) { return plane.importance(camera, p, lens); };
        EXPECT_GT(chi_square_2d(sample, importance,
                                {static_cast<double>(lo.x), static_cast<double>(hi.x),
                                 static_cast<double>(lo.y), static_cast<double>(hi.y)},
                                50000),
                  p_threshold);
        // The window once more with a margin, where nothing may be.
        double sum = 0;
        constexpr int n = 300;
        const Vec2 size = (hi - lo) * 1.4f;
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x)
                sum += importance(
                    lo - size * (0.2f / 1.4f) +
                    Vec2(size.x * (static_cast<float>(x) + 0.5f), size.y * (static_cast<float>(y) + 0.5f)) /
                        n);
        EXPECT_NEAR(sum * static_cast<double>(size.x * size.y) / (n * n), 1, 0.01);
    }
}

TEST(CameraConnections, AreTheCamerasOwnRays) {
    int receiving = 0;
    for (const Matrix4& world : {Matrix4{}, stretched}) {
        auto prepare = [&](BuildContext& context) {
            context.base_folder = ALHAZEN_SOURCE_DIR "/scenes";
            context.film_resolution = film_size;
            context.world_from_node = Transform(world);
        };
        auto visit = [&](const std::string&, const std::string&, const Camera& camera) {
            if (!camera.receives_light()) return;
            ++receiving;
            check_way_back(camera);
            check_density(camera, {Transform(world), 2});
        };
        testing_support::for_each_example(camera_kinds(), visit, prepare);
        Parameter radius = make_float("lensradius", 0.2f), distance = make_float("focaldistance", 3);
        for (const char* kind : {"perspective", "orthographic"}) {
            SCOPED_TRACE(std::string(kind) + " with a lens");
            visit(kind, "lens",
                  *testing_support::make_member(camera_kinds(), kind, {radius, distance}, prepare));
        }
    }
    EXPECT_EQ(receiving, 2 * 6);
    EXPECT_FALSE(testing_support::make_member(camera_kinds(), "spherical", {}, [](BuildContext& context) {
                     context.film_resolution = film_size;
                 })->receives_light());
}

} // namespace
} // namespace alhazen
