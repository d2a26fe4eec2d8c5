/// Lights without size that shine through pictures: goniometric and projection.
#include "image/codec.h"
#include "math/equal_area.h"
#include "tests/support/light_probe.h"

namespace alhazen {
namespace {

// A folder of its own for each test, removed at the end.
struct ImageLightTest : testing::Test {
    std::filesystem::path folder =
        std::filesystem::temp_directory_path() /
        ("alhazen_lights_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));

    ImageLightTest() { std::filesystem::create_directories(folder); }
    ~ImageLightTest() override { std::filesystem::remove_all(folder); }

    std::unique_ptr<Light> light_of(const std::string& kind, const Image& image,
                                    ColorMode mode = ColorMode::rgb, std::vector<Parameter> more = {},
                                    const Matrix4& world = {}) {
        write_image(folder / "light.pfm", image);
        more.push_back(make_string("filename", "light.pfm"));
        return make_light(kind, std::move(more), {mode, world, folder});
    }
    std::string error_of(const std::string& kind, std::vector<Parameter> parameters) {
        return build_error(light_kinds(), make_node(kind, std::move(parameters)), folder);
    }
};

Image varied_image(int width, int height) {
    Image image = Image::rgb_image(width, height);
    Rng rng(11);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            image.set_rgb(x, y, Vec3{rng.uniform(), rng.uniform(), rng.uniform()} * 2.0f);
    return image;
}

// Of what arrives at a distance of 1 in direction w from p.
Vec3 intensity_towards(const Light& light, Vec3 p, Vec3 w, ColorMode mode) {
    return film_color(mode, [&](const Wavelengths& lambda) {
        auto s = light.sample({p + w, {}}, {}, lambda);
        return s ? s->L : Spectrum(0);
    });
}

using GoniometricLight = ImageLightTest;

TEST_F(GoniometricLight, ShinesAsTheImageSaysWithItsMiddleTowardsY) {
    Image image = varied_image(8, 8);
    const Matrix4 world = Matrix4::translate({1, 2, 3}) * Matrix4::rotate(70, {1, 1, 0});
    for (ColorMode mode : both_modes) {
        auto light = light_of("goniometric", image, mode, {make_rgb("I", 3, 2, 1)}, world);
        for (int y = 0; y < 8; ++y)
            for (int x = 0; x < 8; ++x) {
                Vec3 m = equal_area_to_sphere(
                    {(static_cast<float>(x) + 0.5f) / 8, (static_cast<float>(y) + 0.5f) / 8});
                Vec3 w = Transform(world).vector(Vec3{m.x, m.z, m.y});
                Vec3 c = image.rgb(x, y);
                expect_color(intensity_towards(*light, {1, 2, 3}, w, mode),
                             Vec3(3, 2, 1) * ((c.x + c.y + c.z) / 3), 3e-3f);
            }
    }
}

TEST_F(GoniometricLight, OfOneChannelTakesIt) {
    Image image = Image::grey_image(1, 1);
    image.at(0, 0) = 0.25f;
    auto light =
        light_of("goniometric", image, ColorMode::rgb, {make_rgb("I", 4, 4, 4), make_float("scale", 2)});
    EXPECT_FLOAT_EQ(intensity_towards(*light, {}, {0, 1, 0}, ColorMode::rgb).x, 2);
    // A white map is a point light.
    EXPECT_FLOAT_EQ(light->power(Wavelengths::rgb())[0], 8 * pi);
    EXPECT_NEAR(light->bounds()->power, 8 * pi, 1e-4f);
}

TEST_F(GoniometricLight, PowerIsTheMeanOverAllDirectionsAndMayBeAskedFor) {
    Image image = varied_image(16, 16);
    auto light = light_of("goniometric", image, ColorMode::rgb, {make_rgb("I", 1, 1, 1)});
    double mean = 0;
    for (float v : image.values()) mean += static_cast<double>(v) / (3 * 256);
    EXPECT_NEAR(light->power(Wavelengths::rgb())[1], 4 * pi * static_cast<float>(mean), 1e-3f);
    auto lumens =
        light_of("goniometric", image, ColorMode::rgb, {make_float("power", 100), make_float("scale", 3)});
    EXPECT_NEAR(lumens->power(Wavelengths::rgb())[1], 300, 0.01);
    EXPECT_NEAR(flux_through_sphere(*lumens, {0, 0, 0}, 1, Wavelengths::rgb(), 400, 1), 300, 3.0);
}

TEST_F(GoniometricLight, SaysWhatIsWrong) {
    write_image(folder / "wide.pfm", Image::rgb_image(4, 2));
    EXPECT_EQ(
        error_of("goniometric", {make_string("filename", "wide.pfm")}),
        "image \"wide.pfm\" of light \"goniometric\" has 4 x 2 pixels; it must be square (an equal-area "
        "octahedral map)");
    EXPECT_NE(error_of("goniometric", {}).find("filename"), std::string::npos);
    EXPECT_NE(error_of("goniometric", {make_string("filename", "none.exr")}).find("no such file"),
              std::string::npos);
}

using ProjectionLight = ImageLightTest;

TEST_F(ProjectionLight, ThrowsItsImageUprightAndUnmirrored) {
    // 2 wide and 1 high over 4 x 2 pixels, at a distance of 1: fov 2 atan(1/2).
    Image image = varied_image(4, 2);
    const float fov = degrees(2 * std::atan(0.5f));
    const Matrix4 world = Matrix4::translate({1, 2, 3}) * Matrix4::rotate(70, {1, 1, 0});
    for (ColorMode mode : both_modes) {
        auto light =
            light_of("projection", image, mode, {make_float("fov", fov), make_float("scale", 2)}, world);
        for (int y = 0; y < 2; ++y)
            for (int x = 0; x < 4; ++x) {
                // Seen from the projector x is to the right (left-handed), y upwards.
                Vec3 w = normalize(Vec3{-1 + (static_cast<float>(x) + 0.5f) / 2,
                                        0.5f - (static_cast<float>(y) + 0.5f) / 2, 1});
                expect_color(intensity_towards(*light, {1, 2, 3}, Transform(world).vector(w), mode),
                             image.rgb(x, y) * 2.0f, 3e-3f);
            }
        for (Vec3 beside : {Vec3(1.01f, 0, 1), Vec3(-1.01f, 0, 1), Vec3(0, 0.51f, 1), Vec3(0, -0.51f, 1),
                            Vec3(0, 0, -1), Vec3(1, 0, 0)})
            EXPECT_EQ(intensity_towards(*light, {1, 2, 3}, Transform(world).vector(normalize(beside)), mode),
                      Vec3());
    }
}

TEST_F(ProjectionLight, PowerIsTheIntegralOverTheImage) {
    for (Vec2i size : {Vec2i{6, 4}, Vec2i{3, 9}})
        for (float fov : {20.0f, 100.0f}) {
            Image image = varied_image(size.x, size.y);
            std::vector<Parameter> parameters{make_float("fov", fov)};
            auto light = light_of("projection", image, ColorMode::rgb, parameters);
            auto power = static_cast<double>(light->power(Wavelengths::rgb())[0]);
            EXPECT_NEAR(flux_through_sphere(*light, {0, 0, 0}, 1, Wavelengths::rgb(), 800, 1) / power, 1,
                        0.02);
            parameters.push_back(make_float("power", 50));
            parameters.push_back(make_float("scale", 2));
            Spectrum flux =
                light_of("projection", image, ColorMode::rgb, parameters)->power(Wavelengths::rgb());
            EXPECT_NEAR(0.2126f * flux[0] + 0.7152f * flux[1] + 0.0722f * flux[2], 100, 0.01f);
        }
    // A white square that covers 90 degrees is a sixth of all directions.
    Image white = Image::rgb_image(512, 512);
    for (float& v : white.values()) v = 1;
    EXPECT_NEAR(light_of("projection", white)->power(Wavelengths::rgb())[0], 4 * pi / 6, 1e-4f);
}

TEST_F(ProjectionLight, BoundsHoldAllOfTheImage) {
    const Matrix4 world = Matrix4::translate({1, 2, 3}) * Matrix4::rotate(70, {1, 1, 0});
    auto light = light_of("projection", varied_image(5, 2), ColorMode::rgb, {make_float("fov", 50)}, world);
    LightBounds b = *light->bounds();
    const float widest = std::acos(b.cos_normals) + std::acos(b.cos_falloff);
    Rng rng(3);
    float found = 0;
    for (int i = 0; i < 100000; ++i) {
        Vec3 d = sample_sphere({rng.uniform(), rng.uniform()});
        if (!light->sample({Vec3(1, 2, 3) + d, {}}, {}, Wavelengths::rgb())) continue;
        found = std::max(found, std::acos(std::clamp(dot(d, b.axis), -1.0f, 1.0f)));
    }
    EXPECT_LE(found, widest);
    EXPECT_GT(found, widest - 0.05f);
    auto stretched =
        light_of("projection", varied_image(5, 2), ColorMode::rgb, {}, Matrix4::scale({5, 1, 1}));
    EXPECT_EQ(stretched->bounds()->cos_normals, -1);
}

TEST_F(ProjectionLight, SaysWhatIsWrong) {
    EXPECT_EQ(
        error_of("projection", {make_string("filename", "x.png"), make_float("fov", 180)}),
        "parameter \"fov\" is 180; it must be less, since a flat image cannot cover half of all directions");
    EXPECT_NE(error_of("projection", {make_float("fov", 50)}).find("filename"), std::string::npos);
}

} // namespace
} // namespace alhazen
