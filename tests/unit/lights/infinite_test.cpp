#include <fstream>

#include "image/codec.h"
#include "lights/environment_map.h"
#include "math/equal_area.h"
#include "tests/support/light_probe.h"

namespace alhazen {
namespace {

// A folder of its own for each test, removed at the end.
struct InfiniteLightTest : testing::Test {
    std::filesystem::path folder =
        std::filesystem::temp_directory_path() /
        ("alhazen_lights_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));

    InfiniteLightTest() { std::filesystem::create_directories(folder); }
    ~InfiniteLightTest() override { std::filesystem::remove_all(folder); }

    std::unique_ptr<Light> light_of(const Image& image, ColorMode mode = ColorMode::rgb,
                                    std::vector<Parameter> more = {}, const Matrix4& world = {}) {
        write_image(folder / "sky.pfm", image);
        more.push_back(make_string("filename", "sky.pfm"));
        auto light = make_light("infinite", std::move(more), {mode, world, folder});
        if (light) light->prepare(unit_scene);
        return light;
    }
};

// Every texel another colour, some black, one a hundred times as bright.
Image varied_sky(int width, int height) {
    Image image = Image::rgb_image(width, height);
    Rng rng(11);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            image.set_rgb(x, y,
                          rng.uniform() < 0.2f ? Vec3(0) : Vec3{rng.uniform(), rng.uniform(), rng.uniform()});
    image.set_rgb(width / 3, height / 4, {100, 90, 80});
    return image;
}

TEST_F(InfiniteLightTest, UniformSkyGivesAnySurfacePiTimesItsRadiance) {
    for (ColorMode mode : both_modes) {
        auto light = make_light("infinite", {make_rgb("L", .2f, .4f, .8f), make_float("scale", 2)}, {mode});
        light->prepare(unit_scene);
        LightReceiver at{{0, 0, 0}, normalize(Vec3(1, 2, -3))};
        Vec3 e =
            film_color(mode, [&](const Wavelengths& l) { return sampled_irradiance(*light, at, l, 60); });
        expect_color(e, Vec3(.4f, .8f, 1.6f) * pi, 3e-3f);
        Vec3 seen = film_color(mode, [&](const Wavelengths& l) { return light->escaped({}, {0, 0, 1}, l); });
        expect_color(seen, {.4f, .8f, 1.6f}, 2e-3f);
        // 4 pi L through a disk of area 3 pi.
        Vec3 power = film_color(mode, [&](const Wavelengths& l) { return light->power(l); });
        expect_color(power, Vec3(.4f, .8f, 1.6f) * (12 * pi * pi), 2e-3f);
    }
}

TEST_F(InfiniteLightTest, IlluminanceIsThatOfASurfaceFacingUp) {
    auto sky = make_light("infinite", {make_float("illuminance", 5)});
    EXPECT_NEAR(sky->escaped({}, {0, 0, 1}, Wavelengths::rgb())[1], 5 / pi, 1e-5f);
    for (Vec2i size : {Vec2i{32, 32}, Vec2i{64, 32}}) {
        auto light = light_of(varied_sky(size.x, size.y), ColorMode::rgb, {make_float("illuminance", 5)});
        Spectrum e = sampled_irradiance(*light, {{0, 0, 0}, {0, 0, 1}}, Wavelengths::rgb(), 600);
        // pbrt-v4 counts half of an image's illuminance, hence shows it twice as bright.
        EXPECT_NEAR(0.2126f * e[0] + 0.7152f * e[1] + 0.0722f * e[2], 10, 0.1f);
    }
}

TEST_F(InfiniteLightTest, ImageTexelsLieWhereTheirMappingSays) {
    // Octahedral: each texel's middle, mapped to the sphere.
    Image square = varied_sky(16, 16);
    auto light = light_of(square);
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) {
            Vec3 d = equal_area_to_sphere(
                {(static_cast<float>(x) + 0.5f) / 16, (static_cast<float>(y) + 0.5f) / 16});
            EXPECT_FLOAT_EQ(light->escaped({}, d, Wavelengths::rgb())[0], square.rgb(x, y).x);
        }
    // Equirectangular: rows by the angle from +z, columns by that from +x towards +y.
    Image wide = varied_sky(32, 16);
    light = light_of(wide);
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 32; ++x) {
            float theta = pi * (static_cast<float>(y) + 0.5f) / 16,
                  phi = 2 * pi * (static_cast<float>(x) + 0.5f) / 32;
            Vec3 d{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
            EXPECT_FLOAT_EQ(light->escaped({}, d, Wavelengths::rgb())[1], wide.rgb(x, y).y);
        }
}

// Irradiance by integration over a fine grid of directions, linear sRGB.
Vec3 integrated_irradiance(const Light& light, Vec3 n) {
    Vec3d sum;
    constexpr int side = 1024;
    for (int i = 0; i < side * side; ++i) {
        Vec3 d = sample_sphere(
            {(static_cast<float>(i % side) + 0.5f) / side, (static_cast<float>(i / side) + 0.5f) / side});
        if (dot(d, n) <= 0) continue;
        Spectrum l = light.escaped({}, d, Wavelengths::rgb()) * dot(d, n);
        sum += {l[0], l[1], l[2]};
    }
    return Vec3(sum * (4 * static_cast<double>(pi) / (side * side)));
}

TEST_F(InfiniteLightTest, SampledImageLightIsTheSumOverItsTexels) {
    for (Vec2i size : {Vec2i{16, 16}, Vec2i{32, 16}}) {
        Image image = varied_sky(size.x, size.y);
        LightReceiver at{{0, 0, 0}, normalize(Vec3(0.3f, -1, 0.5f))};
        auto light = light_of(image, ColorMode::rgb, {make_float("scale", 3)});
        Vec3 expected = integrated_irradiance(*light, at.ns);
        Spectrum e = sampled_irradiance(*light, at, Wavelengths::rgb(), 400);
        expect_color({e[0], e[1], e[2]}, expected, 0.01f);
        auto spectral = light_of(image, ColorMode::spectral, {make_float("scale", 3)});
        std::uint64_t seed = 0;
        Vec3 seen = film_color(ColorMode::spectral, [&](const Wavelengths& l) {
            return sampled_irradiance(*spectral, at, l, 30, ++seed);
        });
        expect_color(seen, expected, 0.01f);
    }
}

TEST_F(InfiniteLightTest, DensityIsThatOfTheSamplesEvenWhenStretched) {
    Matrix4 stretch = Matrix4::rotate(30, {1, 2, 3}) * Matrix4::scale({2, -1, 0.5});
    for (const Matrix4& world : {Matrix4{}, stretch})
        for (Vec2i size : {Vec2i{8, 8}, Vec2i{16, 8}}) {
            auto light = light_of(varied_sky(size.x, size.y), ColorMode::rgb, {}, world);
            LightReceiver at{};
            Rng rng(5);
            int misplaced = 0;
            for (int i = 0; i < 20000; ++i) {
                auto s = light->sample(at, {rng.uniform(), rng.uniform()}, Wavelengths::rgb());
                ASSERT_TRUE(s);
                EXPECT_NEAR(length(s->wi), 1, 1e-5f);
                bool same = std::abs(light->pdf_escaped(at, s->wi) - s->pdf) <= 1e-3f * s->pdf &&
                            light->escaped({}, s->wi, Wavelengths::rgb()) == s->L;
                misplaced += !same; // a direction on the edge of a texel may be rounded into the next one
            }
            EXPECT_LE(misplaced, 20);
            // The density integrates to 1 over the sphere, and 1 / pdf over the samples gives the solid angle
            // of the texels that are not black.
            double sum = 0;
            int side = 1000;
            for (int i = 0; i < side * side; ++i)
                sum += static_cast<double>(
                    light->pdf_escaped(at, sample_sphere({(static_cast<float>(i % side) + 0.5f) / 1000,
                                                          (static_cast<float>(i / side) + 0.5f) / 1000})));
            EXPECT_NEAR(sum * 4 * static_cast<double>(pi) / (side * side), 1, 0.02);
        }
}

// Irradiance by directions from the cosine and from the light, weighed by the balance heuristic.
Vec3 irradiance_with_cosine_sampling(const Light& light, const LightReceiver& at) {
    Rng rng(3);
    Vec3d sum;
    const Frame frame = Frame::from_z(at.ns);
    constexpr int n = 400000;
    auto add = [&](Vec3 d, Spectrum L, float light_pdf) {
        float cosine = std::max(0.0f, dot(d, at.ns));
        if (cosine > 0) sum += Vec3d(Vec3(L[0], L[1], L[2]) * (cosine / (light_pdf + cosine * inv_pi) / n));
    };
    for (int i = 0; i < n; ++i) {
        Vec3 d = frame.to_world(sample_cosine_hemisphere({rng.uniform(), rng.uniform()}));
        add(d, light.escaped(at.p, d, Wavelengths::rgb()), light.pdf_escaped_beside_bsdf(at, d));
        auto s = light.sample_beside_bsdf(at, {rng.uniform(), rng.uniform()}, Wavelengths::rgb());
        if (s) add(s->wi, s->L, s->pdf);
    }
    return Vec3(sum);
}

TEST_F(InfiniteLightTest, BesideBsdfsOnlyWhatIsBrightIsDrawnAndNothingIsLost) {
    LightReceiver at{{0, 0, 0}, normalize(Vec3(0.3f, -1, 0.5f))};
    for (Vec2i size : {Vec2i{16, 16}, Vec2i{32, 16}}) {
        Image image = varied_sky(size.x, size.y);
        image.set_rgb(size.x / 3, size.y / 4, {10, 9, 8});
        auto light = light_of(image, ColorMode::rgb, {}, Matrix4::rotate(20, {1, 1, 0}));
        Rng rng(6);
        int misplaced = 0;
        for (int i = 0; i < 5000; ++i) {
            auto s = light->sample_beside_bsdf(at, {rng.uniform(), rng.uniform()}, Wavelengths::rgb());
            ASSERT_TRUE(s);
            ASSERT_GT(s->L[0] + s->L[1] + s->L[2], 3 * 0.4f); // the mean is about 0.8 * 0.5
            misplaced += std::abs(light->pdf_escaped_beside_bsdf(at, s->wi) - s->pdf) > 1e-3f * s->pdf;
        }
        EXPECT_LE(misplaced, 10); // on the edges of texels
        expect_color(irradiance_with_cosine_sampling(*light, at), integrated_irradiance(*light, at.ns),
                     0.01f);
    }
    // All of a uniform sky is left to BSDFs.
    auto sky = make_light("infinite", {make_rgb("L", 1, 2, 3)});
    sky->prepare(unit_scene);
    EXPECT_FALSE(sky->sample_beside_bsdf(at, {0.5f, 0.5f}, Wavelengths::rgb()));
    expect_color(irradiance_with_cosine_sampling(*sky, at), Vec3(1, 2, 3) * pi, 0.01f);
}

TEST_F(InfiniteLightTest, WithoutCompensationBsdfsChangeNothing) {
    LightReceiver at{{0, 0, 0}, normalize(Vec3(0.3f, -1, 0.5f))};
    const Parameter all = make_bool("compensate", false);
    auto picture = light_of(varied_sky(16, 16), ColorMode::rgb, {all}, Matrix4::rotate(20, {1, 1, 0}));
    auto sky = make_light("infinite", {make_rgb("L", 1, 2, 3), all});
    sky->prepare(unit_scene);
    Rng rng(6);
    for (const Light* light : {&*picture, &*sky})
        for (int i = 0; i < 1000; ++i) {
            const Vec2 u{rng.uniform(), rng.uniform()};
            auto alone = light->sample(at, u, Wavelengths::rgb());
            auto beside = light->sample_beside_bsdf(at, u, Wavelengths::rgb());
            ASSERT_EQ(alone.has_value(), beside.has_value());
            if (!alone) continue;
            EXPECT_EQ(alone->wi, beside->wi);
            EXPECT_EQ(alone->pdf, beside->pdf);
            EXPECT_EQ(light->pdf_escaped(at, alone->wi), light->pdf_escaped_beside_bsdf(at, alone->wi));
        }
}

TEST_F(InfiniteLightTest, PowerOfAnImageIsThatOfItsMean) {
    Image image = varied_sky(32, 16);
    for (ColorMode mode : both_modes) {
        auto light = light_of(image, mode);
        Vec3d mean;
        for (int y = 0; y < 16; ++y) {
            double omega = 2 * static_cast<double>(pi) / 32 *
                           (std::cos(static_cast<double>(pi) * y / 16) -
                            std::cos(static_cast<double>(pi) * (y + 1) / 16));
            for (int x = 0; x < 32; ++x) mean += Vec3d(image.rgb(x, y)) * omega;
        }
        Vec3 power = film_color(mode, [&](const Wavelengths& l) { return light->power(l); });
        expect_color(power, Vec3(mean) * (3 * pi), 3e-3f);
    }
}

TEST_F(InfiniteLightTest, BlackImagesGiveNoSamples) {
    auto light = light_of(Image::rgb_image(8, 8));
    EXPECT_FALSE(light->sample({}, {0.5f, 0.5f}, Wavelengths::rgb()));
    EXPECT_TRUE(light->escaped({}, {0, 0, 1}, Wavelengths::rgb()).is_black());
}

TEST_F(InfiniteLightTest, SaysWhatIsWrongWithAnImage) {
    auto error_of = [&](std::vector<Parameter> parameters) {
        return build_error(light_kinds(), make_node("infinite", std::move(parameters)), folder);
    };
    EXPECT_EQ(error_of({make_string("filename", "none.exr")}),
              "cannot read image \"none.exr\" of light \"infinite\": no such file");
    write_image(folder / "odd.pfm", Image::rgb_image(30, 20));
    EXPECT_EQ(error_of({make_string("filename", "odd.pfm")}),
              "image \"odd.pfm\" of light \"infinite\" has 30 x 20 pixels; it must be square (an equal-area "
              "octahedral "
              "map) or twice as wide as high (equirectangular)");
    EXPECT_EQ(error_of({make_string("filename", "odd.pfm"), make_rgb("L", 1, 1, 1)}),
              "light \"infinite\" has both \"L\" and \"filename\"; it takes one of them");
    Image broken = Image::rgb_image(4, 4);
    broken.at(1, 1, 0) = infinity;
    broken.at(2, 1, 0) = std::nanf("");
    write_image(folder / "broken.pfm", broken);
    EXPECT_EQ(
        error_of({make_string("filename", "broken.pfm")}),
        "image \"broken.pfm\" of light \"infinite\" has 2 values that are not finite; light must be finite");
    EXPECT_EQ(error_of({make_string("filename", ".")}),
              "cannot read image \".\" of light \"infinite\": is a directory, not a file");
}

} // namespace
} // namespace alhazen
