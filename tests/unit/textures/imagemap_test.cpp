/// Image textures: which texel, which colour, which error.
#include "base/threads.h"
#include "tests/unit/textures/support.h"
#include "textures/image_cache.h"

namespace alhazen {

namespace {

using testing::HasSubstr;

void expect_color(Spectrum c, Vec3 expected, float tolerance = 1e-5f) {
    EXPECT_NEAR(c[0], expected.x, tolerance);
    EXPECT_NEAR(c[1], expected.y, tolerance);
    EXPECT_NEAR(c[2], expected.z, tolerance);
}

// An image whose file is four.exr.
TextureNode four(std::vector<Parameter> parameters = {}, bool is_spectrum = true) {
    parameters.push_back(make_string("filename", "four.exr"));
    return texture_node("imagemap", std::move(parameters), is_spectrum);
}

TEST_F(TextureTest, OriginIsTheLowerLeftCorner) {
    save("four.exr", four_colors());
    build({four()}, ColorMode::rgb);
    ASSERT_EQ(messages.error_count(), 0u) << first_message();
    expect_color(color(at_uv(0.25f, 0.25f), rgb), {0, 0, 1});
    expect_color(color(at_uv(0.75f, 0.25f), rgb), {1, 1, 1});
    expect_color(color(at_uv(0.25f, 0.75f), rgb), {1, 0, 0});
    expect_color(color(at_uv(0.75f, 0.75f), rgb), {0, 1, 0});
}

TEST_F(TextureTest, FiltersAndWraps) {
    save("four.exr", four_colors());
    build({four()}, ColorMode::rgb);
    expect_color(color(at_uv(0.5f, 0.5f), rgb), {0.5f, 0.5f, 0.5f});
    // Repeated: the left border blends blue with white.
    expect_color(color(at_uv(0, 0.25f), rgb), {0.5f, 0.5f, 1});
    textures = {};
    build({four({make_string("wrap", "clamp")})}, ColorMode::rgb);
    expect_color(color(at_uv(0, 0.25f), rgb), {0, 0, 1});
    textures = {};
    build({four({make_string("wrap", "black")})}, ColorMode::rgb);
    expect_color(color(at_uv(0, 0.25f), rgb), {0, 0, 0.5f});
    expect_color(color(at_uv(5, 0.25f), rgb), {0, 0, 0});
    textures = {};
    build({four({make_string("filter", "point")})}, ColorMode::rgb);
    expect_color(color(at_uv(0.49f, 0.49f), rgb), {0, 0, 1});
    EXPECT_EQ(messages.error_count(), 0u) << first_message();
}

TEST_F(TextureTest, ScaleAndInvert) {
    save("four.exr", four_colors());
    build({four({make_float("scale", 0.5f)})}, ColorMode::rgb);
    expect_color(color(at_uv(0.25f, 0.25f), rgb), {0, 0, 0.5f});
    textures = {};
    build({four({make_float("scale", 0.75f), make_bool("invert", true)})}, ColorMode::rgb);
    expect_color(color(at_uv(0.25f, 0.25f), rgb), {1, 1, 0.25f});
    textures = {};
    build({four({make_float("scale", 0.75f), make_bool("invert", true)}, false)});
    EXPECT_NEAR(textures.find_float("t")->eval(at_uv(0.25f, 0.25f)), 0.75f, 1e-6f); // 1 - 0.75 / 3
}

// In spectral mode a texel is the spectrum that a constant of the same colour has, and blends are blends of
// those.
TEST_F(TextureTest, FilteringCommutesWithUpsampling) {
    Image image = Image::rgb_image(2, 1);
    Vec3 left{0.7f, 0.2f, 0.1f}, right{0.1f, 0.5f, 0.9f};
    image.set_rgb(0, 0, left);
    image.set_rgb(1, 0, right);
    save("two.exr", image);
    build({texture_node("imagemap", {make_string("filename", "two.exr")}, true)});
    for (SpectrumRole role : {SpectrumRole::albedo, SpectrumRole::unbounded, SpectrumRole::illuminant}) {
        Spectrum l = SpectrumValue::rgb(srgb_space(), left, role).eval(some);
        Spectrum r = SpectrumValue::rgb(srgb_space(), right, role).eval(some);
        Spectrum half = (l + r) * 0.5f;
        for (int i = 0; i < 4; ++i) {
            EXPECT_NEAR(color(at_uv(0.25f, 0.5f), some, role)[i], l[i], 1e-4f * std::max(1.0f, l[i]));
            EXPECT_NEAR(color(at_uv(0.5f, 0.5f), some, role)[i], half[i], 1e-4f * std::max(1.0f, half[i]));
        }
    }
}

TEST_F(TextureTest, LightMayBeBrighterThanOne) {
    Image image = Image::rgb_image(1, 1);
    image.set_rgb(0, 0, {8, 4, 2});
    save("bright.exr", image);
    build({texture_node("imagemap", {make_string("filename", "bright.exr")}, true)});
    EXPECT_GT(color(at_uv(0.5f, 0.5f), some, SpectrumRole::unbounded).max(), 4);
    EXPECT_LE(color(at_uv(0.5f, 0.5f), some, SpectrumRole::albedo).max(), 1);
    EXPECT_EQ(messages.error_count(), 0u) << first_message();
}

TEST_F(TextureTest, GreyImagesAreFlatSpectra) {
    Image image = Image::grey_image(1, 1);
    image.at(0, 0) = 0.3f;
    save("grey.exr", image);
    build({texture_node("imagemap", {make_string("filename", "grey.exr")}, true)});
    for (int i = 0; i < 4; ++i)
        EXPECT_NEAR(color(at_uv(0.5f, 0.5f), some, SpectrumRole::illuminant)[i], 0.3f, 1e-6f);
}

TEST_F(TextureTest, EncodingOfIntegerFiles) {
    Image image = Image::grey_image(1, 1);
    image.at(0, 0) = 128.0f / 255;
    save("half.png", image, Transfer::linear);
    auto value = [&](std::vector<Parameter> parameters) {
        textures = {};
        parameters.push_back(make_string("filename", "half.png"));
        return number("imagemap", parameters, at_uv(0.5f, 0.5f));
    };
    EXPECT_NEAR(value({make_string("encoding", "linear")}), 128.0f / 255, 1e-5f);
    // IEC 61966-2-1 of 128 / 255.
    EXPECT_NEAR(value({}), 0.2158605f, 1e-5f);
    EXPECT_NEAR(value({make_string("encoding", "sRGB")}), 0.2158605f, 1e-5f);
    EXPECT_NEAR(value({make_string("encoding", "gamma 2")}), sqr(128.0f / 255), 1e-5f);
    value({make_string("encoding", "gamma -1")});
    EXPECT_THAT(first_message(), HasSubstr("encoding \"gamma -1\" is not known"));
}

TEST_F(TextureTest, FloatsTakeAlphaWhereThereIsAny) {
    Image image(2, 1, {"R", "G", "B", "A"});
    for (int x = 0; x < 2; ++x)
        for (int c = 0; c < 4; ++c) image.at(x, 0, c) = c == 3 ? 1 : 0.3f * static_cast<float>(c);
    save("opaque.exr", image);
    image.at(1, 0, 3) = 0.25f;
    save("glassy.exr", image);
    auto node = [&](const std::string& file) {
        textures = {};
        return number("imagemap", {make_string("filename", file)}, at_uv(0.75f, 0.5f));
    };
    EXPECT_NEAR(node("opaque.exr"), 0.3f, 1e-6f);
    EXPECT_NEAR(node("glassy.exr"), 0.25f, 1e-6f);
}

// As pbrt-v4: encoded like colours in files of integers; beside grey it is not looked at.
TEST_F(TextureTest, AlphaOfIntegerFiles) {
    Image image(1, 1, {"R", "G", "B", "A"});
    image.at(0, 0, 3) = 128.0f / 255;
    save("half.png", image);
    Image grey(1, 1, {"Y", "A"});
    grey.at(0, 0, 0) = 1;
    grey.at(0, 0, 1) = 128.0f / 255;
    save("grey.png", grey);
    auto value = [&](const char* file, const char* encoding) {
        textures = {};
        return number("imagemap", {make_string("filename", file), make_string("encoding", encoding)},
                      at_uv(0.5f, 0.5f));
    };
    EXPECT_NEAR(value("half.png", "auto"), 0.2158605f, 1e-5f);
    EXPECT_NEAR(value("half.png", "linear"), 128.0f / 255, 1e-5f);
    EXPECT_NEAR(value("grey.png", "auto"), 1, 1e-5f);
}

TEST_F(TextureTest, OneFileIsReadOnce) {
    save("four.exr", four_colors());
    ImageCache cache;
    ImageSource source{folder() / "four.exr", Encoding{}, WrapMode::repeat};
    auto a = cache.colors(source, {}, SpectrumRole::albedo, ColorMode::spectral);
    source.path = folder() / "." / "four.exr";
    EXPECT_EQ(cache.colors(source, {}, SpectrumRole::albedo, ColorMode::spectral), a);
    cache.colors(source, {}, SpectrumRole::illuminant, ColorMode::spectral);
    cache.numbers(source);
    EXPECT_EQ(cache.decoded(), 1u);
    source.encoding = Encoding::linear();
    cache.image(source);
    EXPECT_EQ(cache.decoded(), 2u);
}

TEST_F(TextureTest, ThreadsShareWhatOneOfThemReads) {
    save("four.exr", four_colors());
    const ImageSource source{folder() / "four.exr", Encoding{}, WrapMode::repeat};
    ImageCache cache;
    std::vector<std::shared_ptr<const ColorTexels>> colors(64);
    std::vector<std::shared_ptr<const FloatTexels>> numbers(64);
    with_threads(4, [&] {
        parallel_for(colors.size(), 1, [&](std::size_t i) {
            colors[i] = cache.colors(source, {}, SpectrumRole::albedo, ColorMode::spectral);
            numbers[i] = cache.numbers(source);
            cache.bytes();
        });
    });
    EXPECT_THAT(colors, testing::Each(colors[0]));
    EXPECT_THAT(numbers, testing::Each(numbers[0]));
    EXPECT_EQ(cache.decoded(), 1u);
}

TEST_F(TextureTest, ForgettingImagesKeepsTextures) {
    save("four.exr", four_colors());
    build({four()}, ColorMode::rgb);
    expect_color(color(at_uv(0.25f, 0.25f), rgb), {0, 0, 1});
    textures.forget_images();
    std::filesystem::remove(folder() / "four.exr");
    expect_color(color(at_uv(0.25f, 0.25f), rgb), {0, 0, 1});
}

TEST_F(TextureTest, MissingFilesAreErrorsAtTheirPlace) {
    Parameter filename = make_string("filename", "nowhere.png");
    filename.place = Place::of_file("scene.pbrt");
    filename.place.line = 7;
    filename.place.column = 3;
    build({texture_node("imagemap", {filename}, true)});
    ASSERT_EQ(messages.error_count(), 1u);
    EXPECT_THAT(messages.list()[0].full_text(), HasSubstr("scene.pbrt:7:3: error: image \""));
    EXPECT_THAT(messages.list()[0].full_text(), HasSubstr("nowhere.png\": no such file"));
}

TEST_F(TextureTest, FilesThatAreNoImagesAreErrors) {
    std::filesystem::create_directories(folder() / "pictures");
    build({texture_node("imagemap", {make_string("filename", "pictures")}, true, "a"),
           texture_node("imagemap", {}, true, "b")});
    ASSERT_EQ(messages.error_count(), 2u);
    EXPECT_THAT(messages.list()[0].text, HasSubstr("directory"));
    EXPECT_THAT(messages.list()[1].text, HasSubstr("needs the parameter \"string filename\""));
}

TEST_F(TextureTest, SaysHowLargeItsImagesAre) {
    Image wide = Image::rgb_image(3, 2);
    save("four.exr", wide);
    TextureNode a = four(), b = four(), numbers = four({}, false);
    a.node.name = "a";
    b.node.name = "b";
    numbers.node.name = "numbers";
    build({a, b, numbers, texture_node("scale", {}, true, "plain")}, ColorMode::rgb);
    ASSERT_EQ(messages.error_count(), 0u) << first_message();
    for (const char* name : {"a", "b", "numbers"}) {
        ASSERT_TRUE(textures.image_size(name)) << name;
        EXPECT_EQ(*textures.image_size(name), (Vec2i{3, 2})) << name;
    }
    EXPECT_FALSE(textures.image_size("plain"));
    EXPECT_FALSE(textures.image_size("absent"));
}

TEST_F(TextureTest, CountsSharedTexelsOnce) {
    save("four.exr", four_colors());
    TextureNode a = four(), b = four();
    a.node.name = "a";
    b.node.name = "b";
    build({a, b}, ColorMode::rgb);
    EXPECT_EQ(textures.bytes(), 4 * 3 * sizeof(float)) << "the image";
    auto first = textures.find_spectrum("a", SpectrumRole::albedo);
    auto second = textures.find_spectrum("b", SpectrumRole::albedo);
    textures.forget_images();
    EXPECT_EQ(textures.bytes(), (4 + 1) * sizeof(Vec3)) << "the texels of both levels";
}

} // namespace

} // namespace alhazen
