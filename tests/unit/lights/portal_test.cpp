/// The sky through a window.
#include "image/codec.h"
#include "lights/environment_map.h"
#include "lights/portal_map.h"
#include "math/equal_area.h"
#include "tests/support/density_test.h"
#include "tests/support/light_probe.h"

namespace alhazen {
namespace {

// 3 wide and 2 high, in the plane z = 2 and looked through towards +z.
const std::vector<Vec3> corners{{-1, -1, 2}, {-1, 1, 2}, {2, 1, 2}, {2, -1, 2}};

Parameter portal_of(std::vector<Vec3> points) {
    return make_array<Vec3>("portal", ValueType::point3, std::move(points));
}
PortalCorners portal_corners() {
    return {corners[0], corners[1], corners[2], corners[3]};
}
// Smooth, and another in each direction.
Vec3 smooth_sky(Vec3 w) {
    return {1 + w.x, 1 + 0.5f * w.y + std::max(0.0f, w.z), 2 - w.x * w.y};
}

// Whether the ray passes through the window.
bool passes(Vec3 p, Vec3 d) {
    if (d.z <= 0 || p.z >= 2) return false;
    Vec3 q = p + d * ((2 - p.z) / d.z);
    return q.x > -1 && q.x < 2 && q.y > -1 && q.y < 1;
}

TEST(Portal, IsSeenWhereRaysPassThroughTheWindow) {
    auto light = make_light("infinite", {make_rgb("L", 1, 2, 3), portal_of(corners)});
    light->prepare(unit_scene);
    Rng rng(1);
    int seen = 0;
    for (int i = 0; i < 20000; ++i) {
        Vec3 p = Vec3(rng.uniform(), rng.uniform(), rng.uniform()) * 5.0f - Vec3(2.5f);
        Vec3 d = sample_sphere({rng.uniform(), rng.uniform()});
        Spectrum L = light->escaped(p, d, Wavelengths::rgb());
        ASSERT_EQ(!L.is_black(), passes(p, d)) << p.x << " " << p.y << " " << p.z;
        ASSERT_EQ(light->pdf_escaped({p, {}}, d) > 0, passes(p, d));
        seen += !L.is_black();
        if (!L.is_black()) {
            ASSERT_NEAR(L[0], 1, 1e-5f);
            ASSERT_NEAR(L[2], 3, 1e-5f);
        }
    }
    EXPECT_GT(seen, 500);
    // From the other side, or with the corners the other way round, there is nothing.
    EXPECT_FALSE(light->sample({{0, 0, 3}, {}}, {0.5f, 0.5f}, Wavelengths::rgb()));
    auto reversed = make_light("infinite", {portal_of({corners[3], corners[2], corners[1], corners[0]})});
    EXPECT_TRUE(reversed->escaped({}, {0, 0, 1}, Wavelengths::rgb()).is_black());
}

TEST(Portal, SamplesFollowTheirDensityFromEveryPlace) {
    PortalMap map(portal_corners(), 32, smooth_sky, srgb_space(), ColorMode::rgb);
    Rng rng(2);
    for (Vec3 p : {Vec3(0, 0, 0), Vec3(4, -3, 1), Vec3(0.1f, 0.2f, 1.9f)}) {
        // On the window, where the density over area is that over solid angle times cos / distance^2.
        auto sample = [&](Vec2 u) {
            auto s = map.sample(p, u);
            if (!s) return Vec2{-100, -100};
            Vec3 q = p + s->w * ((2 - p.z) / s->w.z);
            return Vec2{q.x, q.y};
        };
        auto density = [&](Vec2 at) {
            Vec3 d = Vec3{at.x, at.y, 2} - p;
            float l2 = length_squared(d), l = std::sqrt(l2);
            return static_cast<double>(map.pdf(p, d / l) * (d.z / l) / l2);
        };
        EXPECT_GT(testing_support::chi_square_2d(sample, density, {-1, 2, -1, 1}, 100000, 12, 48),
                  testing_support::p_threshold);
        int misplaced = 0;
        for (int i = 0; i < 5000; ++i) {
            auto s = map.sample(p, {rng.uniform(), rng.uniform()});
            if (!s) continue;
            auto texel = map.texel_seen(p, s->w);
            misplaced +=
                !texel || !(*texel == s->texel) || std::abs(map.pdf(p, s->w) - s->pdf) > 1e-3f * s->pdf;
        }
        EXPECT_LE(misplaced, 10); // a direction on the edge of a texel may be rounded into the next one
    }
}

// Light through the window onto a surface, by points spread over the window.
Vec3 irradiance_by_area(const LightReceiver& at, const std::function<Vec3(Vec3)>& sky) {
    Vec3d sum;
    constexpr int n = 600;
    for (int i = 0; i < n * n; ++i) {
        Vec3 q{-1 + 3 * (static_cast<float>(i % n) + 0.5f) / n,
               -1 + 2 * (static_cast<float>(i / n) + 0.5f) / n, 2};
        Vec3 d = q - at.p;
        float l2 = length_squared(d);
        d = d / std::sqrt(l2);
        float weight = std::max(0.0f, dot(d, at.ns)) * d.z / l2;
        sum += Vec3d(sky(d) * (weight * 6 / (n * n)));
    }
    return Vec3(sum);
}

TEST(Portal, SampledLightIsThatOfTheImageBehindTheWindow) {
    auto folder = std::filesystem::temp_directory_path() / "alhazen_lights_portal";
    std::filesystem::create_directories(folder);
    const Matrix4 world = Matrix4::rotate(50, {1, 2, 3});
    const Transform turned(world);
    for (bool octahedral : {true, false}) {
        const Vec2i size = octahedral ? Vec2i{128, 128} : Vec2i{256, 128};
        Image image = Image::rgb_image(size.x, size.y);
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                Vec2 uv{(static_cast<float>(x) + 0.5f) / static_cast<float>(size.x),
                        (static_cast<float>(y) + 0.5f) / static_cast<float>(size.y)};
                float theta = pi * uv.y, phi = 2 * pi * uv.x;
                Vec3 w = octahedral ? equal_area_to_sphere(uv)
                                    : Vec3{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                                           std::cos(theta)};
                image.set_rgb(x, y, smooth_sky(w));
            }
        write_image(folder / "sky.pfm", image);
        auto light = make_light("infinite", {make_string("filename", "sky.pfm"), portal_of(corners)},
                                {ColorMode::rgb, world, folder});
        ASSERT_TRUE(light);
        light->prepare(unit_scene);
        auto sky = [&](Vec3 d) { return smooth_sky(turned.inverse_vector(d)); };
        for (LightReceiver at : {LightReceiver{{0, 0, 0}, normalize(Vec3(0.3f, 0.1f, 1))},
                                 LightReceiver{{3, 2, 0}, normalize(Vec3(-1, -1, 1))}}) {
            Spectrum e = sampled_irradiance(*light, at, Wavelengths::rgb(), 200);
            expect_color({e[0], e[1], e[2]}, irradiance_by_area(at, sky), 0.01f);
        }
    }
    std::filesystem::remove_all(folder);
}

TEST(Portal, ShowsTheColoursOfTheImagesOwnSpace) {
    const RgbColorSpace& space = *find_color_space("rec2020");
    const Vec3 rgb{0.5f, 1, 0.25f};
    const Vec3 expected = convert_rgb(space, srgb_space()) * rgb;
    for (ColorMode mode : both_modes) {
        PortalMap map(
            portal_corners(), 16, [&](Vec3) { return rgb; }, space, mode);
        const auto seen = map.texel_seen({}, {0, 0, 1});
        ASSERT_TRUE(seen);
        expect_color(
            film_color(mode, [&](const Wavelengths& l) { return map.eval(*seen, l) * map.light_scale(); }),
            expected, 5e-3f);
        // Through an area of 6, from all directions of the half space: 6 pi; the square has 16 x 16 of them.
        expect_color(map.flux(), expected * (6 * pi), 0.02f);
    }
}

TEST(Portal, ReadsTheSpaceFromTheFile) {
    auto folder = std::filesystem::temp_directory_path() / "alhazen_lights_portal_space";
    std::filesystem::create_directories(folder);
    Image image = Image::rgb_image(16, 16);
    const Vec3 rgb{0.5f, 1, 0.25f};
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) image.set_rgb(x, y, rgb);
    image.info.metadata["color_space"] = "rec2020";
    write_image(folder / "sky.exr", image);
    for (ColorMode mode : both_modes) {
        auto through_all = make_light("infinite", {make_string("filename", "sky.exr")}, {mode, {}, folder});
        auto through_window = make_light("infinite", {make_string("filename", "sky.exr"), portal_of(corners)},
                                         {mode, {}, folder});
        ASSERT_TRUE(through_all && through_window);
        auto color_of = [&](const Light& light) {
            return film_color(mode, [&](const Wavelengths& l) { return light.escaped({}, {0, 0, 1}, l); });
        };
        expect_color(color_of(*through_window), color_of(*through_all), 1e-3f);
        expect_color(color_of(*through_window), convert_rgb(*find_color_space("rec2020"), srgb_space()) * rgb,
                     5e-3f);
    }
    std::filesystem::remove_all(folder);
}

TEST(Portal, PowerIsTheFluxThroughTheWindow) {
    // Radiance 1 through an area of 6: 6 pi.
    for (ColorMode mode : both_modes) {
        auto light = make_light("infinite", {make_rgb("L", 1, .5f, 2), portal_of(corners)}, {mode});
        expect_color(film_color(mode, [&](const Wavelengths& l) { return light->power(l); }),
                     Vec3(1, .5f, 2) * (6 * pi), 3e-3f);
    }
}

TEST(Portal, IlluminanceCountsAsInPbrt) {
    // Half of that of all the sky: 2 pi where a sky of luminance 1 gives pi from above.
    auto light = make_light("infinite", {make_float("illuminance", 4 * pi), portal_of(corners)});
    EXPECT_NEAR(light->escaped({}, {0, 0, 1}, Wavelengths::rgb())[1], 2, 1e-4f);
}

TEST(Portal, SaysWhatIsWrongWithItsCorners) {
    auto error_of = [](std::vector<Vec3> points) {
        return build_error(light_kinds(), make_node("infinite", {portal_of(std::move(points))}));
    };
    EXPECT_EQ(error_of({corners[0], corners[1], corners[2]}),
              "parameter \"portal\" has 3 points; it must have four, the corners of a rectangle");
    const std::string no_rectangle =
        "parameter \"portal\" must give the corners of a rectangle, in order round its "
        "edge; these points do not";
    EXPECT_EQ(error_of({corners[0], corners[2], corners[1], corners[3]}), no_rectangle);
    EXPECT_EQ(error_of({corners[0], corners[1], corners[2], {2, -1.2f, 2}}), no_rectangle);
    EXPECT_EQ(error_of({corners[0], corners[0], corners[2], corners[3]}), no_rectangle);
}

} // namespace
} // namespace alhazen
