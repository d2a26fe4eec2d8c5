// What every camera promises, for each kind and each documented example, and the kinds against closed forms.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cameras/camera.h"
#include "tests/support/density_test.h"
#include "tests/support/family.h"

namespace alhazen {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing_support::chi_square_2d;
using testing_support::messages_of;
using testing_support::p_threshold;

constexpr Vec2i large_film{800, 600};

std::unique_ptr<Camera> make_camera(std::string type, std::vector<Parameter> parameters,
                                    Matrix4 world_from_camera = {}, Vec2i size = large_film) {
    return testing_support::make_member(camera_kinds(), std::move(type), std::move(parameters),
                                        [&](BuildContext& context) {
                                            context.world_from_node = Transform(world_from_camera);
                                            context.film_resolution = size;
                                        });
}

CameraSample at(float x, float y, Vec2 lens = {.5f, .5f}, float time = 0) {
    return {{x, y}, lens, time};
}

void expect_near(Vec3 a, Vec3 b, float tolerance) {
    EXPECT_NEAR(a.x, b.x, tolerance);
    EXPECT_NEAR(a.y, b.y, tolerance);
    EXPECT_NEAR(a.z, b.z, tolerance);
}

TEST(CameraConformance, RaysHaveUnitDirectionsAndTimesInTheShutter) {
    auto prepare = [](BuildContext& context) {
        context.base_folder = ALHAZEN_SOURCE_DIR "/scenes";
        context.film_resolution = large_film;
        context.world_from_node = Transform(Matrix4::translate({3, -2, 1}) * Matrix4::rotate(35, {1, 2, 3}) *
                                            Matrix4::scale({2, 2, 2}));
    };
    auto visit = [](const std::string& kind, const std::string&, Camera& camera) {
        camera.shutteropen = 0.25f;
        camera.shutterclose = 0.75f;
        // Glass stops rays, and lets more or less through.
        const bool is_glass = kind == "realistic";
        int arrived = 0;
        Rng rng(1);
        for (int i = 0; i < 500; ++i) {
            CameraSample s{
                {rng.uniform() * 800, rng.uniform() * 600}, {rng.uniform(), rng.uniform()}, rng.uniform()};
            auto r = camera.ray(s);
            if (is_glass && !r) continue;
            ASSERT_TRUE(r);
            ++arrived;
            ASSERT_NEAR(length(r->ray.d), 1, 1e-6f);
            ASSERT_TRUE(is_finite(r->ray.o));
            ASSERT_EQ(r->ray.tmax, infinity);
            ASSERT_NEAR(r->ray.time, 0.25f + 0.5f * s.time, 1e-6f);
            if (is_glass)
                ASSERT_TRUE(r->weight[0] > 0 && r->weight[0] < pi);
            else
                ASSERT_TRUE(r->weight == Spectrum(1));
        }
        EXPECT_GT(arrived, 250);
    };
    testing_support::for_each_example(camera_kinds(), visit, prepare);
}

TEST(Perspective, CornersAndCentre) {
    auto camera = make_camera("perspective", {make_float("fov", 60)});
    // The shorter side, the height, covers 60 degrees; y is up, the film's first row is the highest.
    const float h = std::tan(radians(30)), w = h * 800 / 600;
    expect_near(camera->ray(at(400, 300))->ray.d, {0, 0, 1}, 1e-7f);
    expect_near(camera->ray(at(0, 0))->ray.d, normalize(Vec3(-w, h, 1)), 1e-7f);
    expect_near(camera->ray(at(800, 0))->ray.d, normalize(Vec3(w, h, 1)), 1e-7f);
    expect_near(camera->ray(at(0, 600))->ray.d, normalize(Vec3(-w, -h, 1)), 1e-7f);
    expect_near(camera->ray(at(100.5f, 200.5f))->ray.d,
                normalize(Vec3(-w * 299.5f / 400, h * 99.5f / 300, 1)), 2e-7f);
    EXPECT_EQ(camera->ray(at(1, 2))->ray.o, Vec3(0, 0, 0));
}

TEST(Perspective, TallPicturesTakeTheWidth) {
    auto camera = make_camera("perspective", {make_float("fov", 60)}, {}, {600, 800});
    const float w = std::tan(radians(30)), h = w * 800 / 600;
    expect_near(camera->ray(at(0, 0))->ray.d, normalize(Vec3(-w, h, 1)), 1e-7f);
}

TEST(Perspective, HalfFovWindowAndAspect) {
    auto half = make_camera("perspective", {make_float("halffov", 30)});
    auto full = make_camera("perspective", {make_float("fov", 60)});
    EXPECT_EQ(half->ray(at(7, 9))->ray.d, full->ray(at(7, 9))->ray.d);
    auto window = make_camera(
        "perspective", {make_array("screenwindow", ValueType::real, std::vector<float>{0, 1, -0.5f, 0.25f})});
    expect_near(window->ray(at(0, 0))->ray.d, normalize(Vec3(0, 0.25f, 1)), 1e-7f);
    expect_near(window->ray(at(800, 600))->ray.d, normalize(Vec3(1, -0.5f, 1)), 1e-7f);
    auto aspect = make_camera("perspective", {make_float("frameaspectratio", 2)});
    expect_near(aspect->ray(at(0, 0))->ray.d, normalize(Vec3(-2, 1, 1)), 1e-7f);
}

TEST(Perspective, LooksWhereItIsPut) {
    auto camera_from_world = Matrix4::look_at({1, 2, 3}, {4, 2, 3}, {0, 1, 0});
    auto camera = make_camera("perspective", {}, *camera_from_world->inverse());
    CameraRay centre = *camera->ray(at(400, 300));
    expect_near(centre.ray.o, {1, 2, 3}, 1e-6f);
    expect_near(centre.ray.d, {1, 0, 0}, 1e-6f);
    // Left-handed: looking along +x with y up, +x of the camera is towards -z.
    EXPECT_LT(camera->ray(at(800, 300))->ray.d.z, 0);
    EXPECT_GT(camera->ray(at(400, 0))->ray.d.y, 0);
}

TEST(Perspective, AllRaysOfAPlaceMeetAtTheFocalPlane) {
    auto camera =
        make_camera("perspective", {make_float("lensradius", 0.2f), make_float("focaldistance", 5)});
    auto pinhole = make_camera("perspective", {});
    Rng rng(2);
    for (Vec2 film : {Vec2(400, 300), Vec2(10, 590), Vec2(700, 33)}) {
        Vec3 d = pinhole->ray({film, {}, 0})->ray.d;
        Vec3 focus = d * (5 / d.z);
        float farthest = 0;
        for (int i = 0; i < 200; ++i) {
            Ray r = camera->ray({film, {rng.uniform(), rng.uniform()}, 0})->ray;
            expect_near(r.at((5 - r.o.z) / r.d.z), focus, 1e-5f);
            EXPECT_NEAR(r.o.z, 0, 1e-7f);
            farthest = std::max(farthest, length(r.o));
        }
        EXPECT_LE(farthest, 0.2f * 1.000001f);
        EXPECT_GT(farthest, 0.19f);
    }
}

TEST(Orthographic, RaysAreParallelAndFillTheWindow) {
    auto camera = make_camera("orthographic", {});
    const float w = 800 / 600.0f;
    expect_near(camera->ray(at(0, 0))->ray.o, {-w, 1, 0}, 1e-6f);
    expect_near(camera->ray(at(800, 600))->ray.o, {w, -1, 0}, 1e-6f);
    expect_near(camera->ray(at(123, 456))->ray.d, {0, 0, 1}, 0);
}

// Thin lenses: all rays of a place on the film pass through a disk of radius r around the axis and meet at
// focal distance f. So they cut the plane at distance z in a disk of radius r |1 - z / f|, uniformly, around
// z / f times the place where they meet (z = 0: the lens itself; z = f: one sharp point).
void expect_circles_of_confusion(const Camera& camera, Vec2 film, Vec2 focus, float r, float f) {
    constexpr int n = 2000;
    for (float z : {0.0f, 0.5f * f, f, 1.5f * f, 3 * f}) {
        SCOPED_TRACE(z);
        Rng rng(4);
        float radius = r * std::abs(1 - z / f), widest = 0;
        Vec2 sum;
        double squares = 0;
        for (int i = 0; i < n; ++i) {
            Ray ray = camera.ray({film, {rng.uniform(), rng.uniform()}, 0})->ray;
            EXPECT_EQ(ray.o.z, 0);
            Vec3 p = ray.at(z / ray.d.z);
            Vec2 off = Vec2(p.x, p.y) - focus * (z / f);
            sum += off;
            squares += static_cast<double>(dot(off, off));
            widest = std::max(widest, std::sqrt(dot(off, off)));
        }
        EXPECT_LE(widest, radius + 1e-5f);
        EXPECT_GE(widest, 0.98f * radius);
        // Of a uniform disk: each axis' variance is radius^2 / 4 and the mean of the squared distance
        // radius^2 / 2, with variance radius^4 / 12. Five standard deviations; a false alarm in 10^5 for all.
        float deviation = 5 * radius / (2 * std::sqrt(static_cast<float>(n)));
        expect_near({sum.x / n, sum.y / n, 0}, {}, deviation + 1e-5f);
        EXPECT_NEAR(squares / n, sqr(radius) / 2, 5 * sqr(radius) / std::sqrt(12.0f * n) + 1e-9f);
    }
}

TEST(Perspective, LensGivesTheThinLensCirclesOfConfusion) {
    auto camera =
        make_camera("perspective", {make_float("lensradius", 0.2f), make_float("focaldistance", 5)});
    expect_circles_of_confusion(*camera, {400, 300}, {0, 0}, 0.2f, 5);
    // The upper left corner at fov 90: the window at z = 1 reaches from -4/3 to 4/3 and from -1 to 1.
    expect_circles_of_confusion(*camera, {0, 0}, {-20 / 3.0f, 5}, 0.2f, 5);
}

TEST(Orthographic, LensGivesTheThinLensCirclesOfConfusion) {
    auto camera =
        make_camera("orthographic", {make_float("lensradius", 0.1f), make_float("focaldistance", 4)});
    expect_circles_of_confusion(*camera, {400, 300}, {0, 0}, 0.1f, 4);
    // The plane of focus shows what it would without a lens.
    expect_circles_of_confusion(*camera, {0, 0}, {-4 / 3.0f, 1}, 0.1f, 4);
    auto plain = make_camera("orthographic", {});
    Rng rng(3);
    for (int i = 0; i < 100; ++i) {
        CameraSample s = at(rng.uniform() * 800, rng.uniform() * 600, {rng.uniform(), rng.uniform()});
        Ray r = camera->ray(s)->ray;
        expect_near(r.at(4 / r.d.z), plain->ray(s)->ray.at(4), 1e-5f);
    }
}

TEST(Spherical, EqualAreaCoversTheSphereUniformly) {
    auto camera = make_camera("spherical", {}, {}, {64, 64});
    EXPECT_GT(chi_square_2d(
                  [&](Vec2 u) {
                      Vec3 d = camera->ray(at(u.x * 64, u.y * 64))->ray.d;
                      float phi = std::atan2(d.z, d.x);
                      return Vec2(d.y, phi < 0 ? phi + 2 * pi : phi);
                  },
                  [](Vec2) { return inv_pi / 4; }, {-1, 1, 0, 2 * static_cast<double>(pi)}),
              p_threshold);
    expect_near(camera->ray(at(32, 32))->ray.d, {0, 1, 0}, 1e-6f);
}

TEST(Spherical, EqualAreaWrapsBeyondTheEdge) {
    // Filters reach over the picture's edge; the sphere goes on there.
    auto camera = make_camera("spherical", {}, {}, {64, 64});
    for (float y : {3.0f, 20.0f, 50.0f}) {
        Vec3 inside = camera->ray(at(0.01f, y))->ray.d, outside = camera->ray(at(-0.01f, y))->ray.d;
        EXPECT_LT(length(inside - outside), 0.01f);
    }
}

TEST(Spherical, EquirectangularIsAWorldMap) {
    auto camera = make_camera("spherical", {make_string("mapping", "equirectangular")}, {}, {360, 180});
    expect_near(camera->ray(at(10, 0))->ray.d, {0, 1, 0}, 1e-6f);
    expect_near(camera->ray(at(10, 180))->ray.d, {0, -1, 0}, 1e-6f);
    expect_near(camera->ray(at(0, 90))->ray.d, {1, 0, 0}, 1e-6f);
    expect_near(camera->ray(at(90, 90))->ray.d, {0, 0, 1}, 1e-6f);
    expect_near(camera->ray(at(180, 90))->ray.d, {-1, 0, 0}, 1e-6f);
}

TEST(Cameras, BadParametersAreErrors) {
    auto window = [](std::vector<float> v) {
        return make_array("screenwindow", ValueType::real, std::move(v));
    };
    EXPECT_THAT(messages_of(camera_kinds(), "perspective", {make_float("fov", 180)}),
                ElementsAre(HasSubstr("parameter \"fov\" is 180; it must be less")));
    EXPECT_THAT(messages_of(camera_kinds(), "perspective", {make_float("halffov", 90)}),
                ElementsAre(HasSubstr("parameter \"halffov\" is 90; it must be less")));
    EXPECT_THAT(messages_of(camera_kinds(), "perspective", {make_float("fov", 0)}),
                ElementsAre(HasSubstr("\"fov\"")));
    EXPECT_THAT(messages_of(camera_kinds(), "perspective", {make_float("fov", 200)}),
                ElementsAre(HasSubstr("\"fov\" is 200")));
    EXPECT_THAT(messages_of(camera_kinds(), "perspective", {make_float("lensradius", -1)}),
                ElementsAre(HasSubstr("\"lensradius\" is -1")));
    EXPECT_THAT(messages_of(camera_kinds(), "orthographic", {window({1, 2, 3})}),
                ElementsAre(HasSubstr("has 3 values, but must have 4")));
    EXPECT_THAT(messages_of(camera_kinds(), "orthographic", {window({1, 1, 0, 2})}),
                ElementsAre(HasSubstr("must have a width and a height")));
    EXPECT_THAT(messages_of(camera_kinds(), "spherical", {make_string("mapping", "cube")}),
                ElementsAre(HasSubstr("known: equalarea, equirectangular")));
    EXPECT_THAT(messages_of(camera_kinds(), "perspectiv", {}), ElementsAre(HasSubstr("perspective")));
}

TEST(Cameras, AShutterThatClosesFirstIsTurnedRound) {
    auto parameters = {make_float("shutteropen", 2), make_float("shutterclose", 1)};
    EXPECT_THAT(messages_of(camera_kinds(), "perspective", parameters), ElementsAre(HasSubstr("exchanged")));
    auto camera = make_camera("perspective", parameters);
    EXPECT_EQ(camera->shutteropen, 1);
    EXPECT_EQ(camera->shutterclose, 2);
}

} // namespace
} // namespace alhazen
