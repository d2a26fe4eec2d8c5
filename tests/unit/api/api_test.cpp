#include <alhazen/alhazen.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <gmock/gmock.h>

namespace {

using alhazen::InputError;
using alhazen::Picture;
using alhazen::Pose;
using alhazen::RenderProgress;
using alhazen::RenderRequest;
using alhazen::rgb;
using alhazen::SceneModel;
using testing::ElementsAreArray;
using testing::HasSubstr;

const char* const scene_text = R"(
    Integrator "whitted"
    Sampler "independent" "integer pixelsamples" 1
    PixelFilter "box"
    Film "rgb" "integer xresolution" 24 "integer yresolution" 16
    LookAt 0 1 -5  0 1 0  0 1 0
    Camera "perspective" "float fov" 40
    WorldBegin
    LightSource "point" "string falloff" "none" "rgb I" [ 1 1 1 ] "point3 from" [ 2 5 -4 ]
    MakeNamedMaterial "clay" "string type" "phong" "rgb diffuse" [ .6 .4 .3 ]
    NamedMaterial "clay"
    Translate 0 1 0
    Shape "sphere" "float radius" 1
)";

// The same scene in code.
SceneModel coded_scene() {
    SceneModel scene;
    scene.integrator("whitted");
    scene.sampler("independent", {{"pixelsamples", 1}});
    scene.filter("box");
    scene.film("rgb", {{"xresolution", 24}, {"yresolution", 16}});
    scene.camera("perspective", {{"fov", 40}}, Pose::look_at({0, 1, -5}, {0, 1, 0}));
    scene.light("point", {{"falloff", "none"}, {"I", rgb(1, 1, 1)}, {"from", alhazen::point3(2, 5, -4)}});
    scene.material("clay", "phong", {{"diffuse", rgb(.6, .4, .3)}});
    scene.shape("sphere", {{"radius", 1}}, {.material = "clay", .pose = Pose::translate(0, 1, 0)});
    return scene;
}

double mean(const Picture& picture) {
    double sum = 0;
    for (float value : picture.pixels()) sum += static_cast<double>(value);
    return sum / static_cast<double>(picture.pixels().size());
}

// The notices of what rendering throws; none when it does not.
std::vector<alhazen::Notice> notices_of(const SceneModel& scene, const RenderRequest& request = {}) {
    try {
        scene.render(request);
    } catch (const InputError& error) {
        return error.notices();
    }
    return {};
}

TEST(Api, CodeAndTextGiveTheSamePicture) {
    Picture from_text = SceneModel::from_text(scene_text).render();
    Picture from_code = coded_scene().render();
    EXPECT_EQ(from_text.width(), 24);
    EXPECT_EQ(from_text.height(), 16);
    EXPECT_EQ(from_text.samples(), 1);
    EXPECT_GT(from_text.rays(), 24u * 16u);
    EXPECT_GT(mean(from_text), 0.02);
    EXPECT_THAT(from_code.pixels(), ElementsAreArray(from_text.pixels()));
}

TEST(Api, RequestOverridesTheScene) {
    RenderRequest request;
    request.width = 10;
    request.height = 20;
    request.spp = 3;
    request.overrides = {"material.clay.diffuse=0 0 0", "material.clay.ambient=0 0 0",
                         "material.clay.specular=0 0 0"};
    Picture picture = coded_scene().render(request);
    EXPECT_EQ(picture.width(), 10);
    EXPECT_EQ(picture.height(), 20);
    EXPECT_EQ(picture.samples(), 3);
    EXPECT_EQ(mean(picture), 0);
}

TEST(Api, TextureMemoryDoesNotChangeThePicture) {
    const auto file = std::filesystem::path(testing::TempDir()) / "alhazen-api-texture-memory.png";
    coded_scene().render().write(file);
    SceneModel scene = coded_scene();
    scene.color_texture("picture", "imagemap", {{"filename", file.string()}});
    scene.material("clay", "phong", {{"diffuse", alhazen::texture("picture")}});
    const Picture whole = scene.render(), limited = scene.render({.texture_memory = 1});
    std::filesystem::remove(file);
    EXPECT_GT(mean(whole), 0);
    EXPECT_TRUE(std::ranges::equal(whole.pixels(), limited.pixels()));
}

TEST(Api, NamesUsedAgainReplace) {
    SceneModel scene = coded_scene();
    Picture before = scene.render();
    SceneModel copy = scene;
    scene.material("clay", "phong", {{"diffuse", rgb(.1, .1, .1)}, {"specular", rgb(0, 0, 0)}});
    EXPECT_LT(mean(scene.render()), mean(before) / 2);
    EXPECT_EQ(mean(copy.render()), mean(before));
}

TEST(Api, MeshesEmittersAndInstances) {
    SceneModel scene;
    scene.integrator("path", {{"maxdepth", 2}});
    scene.film("rgb", {{"xresolution", 8}, {"yresolution", 8}});
    scene.camera("perspective", {{"fov", 90}}, Pose::look_at({0, 0, -1}, {0, 0, 0}));
    scene.emitter("lamp", "diffuse", {{"L", rgb(1, 1, 1)}, {"twosided", true}});
    alhazen::MeshInput square{.positions = {-9, -9, 0, 9, -9, 0, 9, 9, 0, -9, 9, 0},
                              .indices = {0, 1, 2, 0, 2, 3}};
    scene.mesh(square, {.emitter = "lamp"});
    // A square that fills the view and sends out radiance 1 is white.
    EXPECT_NEAR(mean(scene.render({.spp = 16})), 1, 0.05);

    // An object in front of it is not seen until there is an instance of it.
    scene.material("black", "diffuse", {{"reflectance", 0.0}});
    scene.mesh(square, {.material = "black", .object = "curtain"});
    EXPECT_NEAR(mean(scene.render({.spp = 16})), 1, 0.05);
    scene.instance("curtain", Pose::translate(0, 0, -0.5));
    EXPECT_EQ(mean(scene.render({.spp = 16})), 0);
}

TEST(Api, ErrorsNameTheThingAndAreToldTogether) {
    SceneModel scene = coded_scene();
    scene.material("gum", "difuse").shape("sphere", {{"radios", 1}});
    auto notices = notices_of(scene);
    ASSERT_EQ(notices.size(), 2u);
    EXPECT_EQ(notices[0].file, "material \"gum\"");
    EXPECT_THAT(notices[0].text, HasSubstr("did you mean \"diffuse\"?"));
    EXPECT_EQ(notices[1].file, "shape 2 (sphere)");
    EXPECT_THAT(notices[1].text, HasSubstr("did you mean \"radius\"?"));
    EXPECT_TRUE(notices[0].is_error);
}

TEST(Api, ErrorsOfTextHavePlaces) {
    try {
        SceneModel::from_text("WorldBegin\n  Shap \"sphere\"\n");
        FAIL() << "an unknown directive was accepted";
    } catch (const InputError& error) {
        ASSERT_FALSE(error.notices().empty());
        EXPECT_EQ(error.notices()[0].line, 2);
        EXPECT_EQ(error.notices()[0].column, 3);
        EXPECT_THAT(error.what(), HasSubstr("error: "));
    }
}

TEST(Api, MissingFileAndFolder) {
    EXPECT_THROW(SceneModel::from_file("/no/such/scene.pbrt"), InputError);
    Picture picture = coded_scene().render();
    EXPECT_THROW(picture.write("/no/such/folder/picture.png"), InputError);
    EXPECT_THROW(picture.write("picture.unknown"), InputError);
}

TEST(Api, WritesFiles) {
    Picture picture = coded_scene().render();
    for (const char* suffix : {".png", ".exr", ".pfm", ".hdr", ".jpg"}) {
        std::filesystem::path file =
            std::filesystem::path(testing::TempDir()) / (std::string("api_test") + suffix);
        picture.write(file);
        EXPECT_GT(std::filesystem::file_size(file), 100u) << suffix;
        std::filesystem::remove(file);
    }
}

TEST(Api, WrongUseIsToldAtOnce) {
    SceneModel scene;
    EXPECT_THROW(scene.shape("sphere", {}, {.emitter = "lamp"}), InputError);
    EXPECT_THROW(scene.material("", "diffuse"), InputError);
    EXPECT_THROW(scene.mesh({.positions = {0, 1}, .indices = {0, 1, 2}}), InputError);
    EXPECT_THROW(scene.shape("sphere", {{"radius", {alhazen::SettingType::number, std::vector<float>{}}}}),
                 InputError);
    EXPECT_THROW(Pose::look_at({0, 0, 0}, {0, 0, 0}), InputError);
    EXPECT_THROW(Pose::rotate(20, {0, 0, 0}), InputError);
    EXPECT_THROW(scene.render({.width = 10}), InputError);
    EXPECT_THROW(scene.render({.width = 10, .height = 0}), InputError);
    EXPECT_THROW(scene.render({.spp = 0}), InputError);
    EXPECT_THROW(scene.render({.texture_memory = 0}), InputError);
    EXPECT_THROW(scene.render({.threads = -1}), InputError);
    EXPECT_EQ(notices_of(scene, {.integrator = "pat"}).size(), 1u);
}

TEST(Api, ProgressGrowsAndCanStop) {
    RenderRequest request;
    request.spp = 4096;
    double last = 0;
    int calls = 0;
    request.progress = [&](const RenderProgress& progress) {
        EXPECT_EQ(progress.samples_total, 4096);
        EXPECT_GE(progress.fraction, 0);
        EXPECT_LE(progress.fraction, 1);
        last = progress.fraction;
        return ++calls < 3;
    };
    Picture picture = coded_scene().render(request);
    EXPECT_EQ(calls, 3);
    EXPECT_LT(last, 1);
    EXPECT_TRUE(picture.was_stopped());
    EXPECT_LT(picture.samples(), 4096);
    EXPECT_GE(picture.samples(), 1);
    EXPECT_GT(mean(picture), 0.02);
}

TEST(Api, AnExceptionOfTheCallbackComesOut) {
    RenderRequest request;
    request.progress = [](const RenderProgress&) -> bool { throw std::logic_error("enough"); };
    EXPECT_THROW(coded_scene().render(request), std::logic_error);
}

TEST(Api, PosesCompose) {
    Pose p = Pose::translate(1, 2, 3) * Pose::scale(2, 2, 2);
    EXPECT_EQ(p.matrix[0], 2);
    EXPECT_EQ(p.matrix[3], 1);
    EXPECT_EQ(p.matrix[11], 3);
    // A camera at the eye looks along +z.
    Pose camera = Pose::look_at({0, 0, -5}, {0, 0, 0});
    EXPECT_NEAR(camera.matrix[11], -5, 1e-12);
    EXPECT_NEAR(camera.matrix[10], 1, 1e-12);
    // A quarter turn about y takes z to x.
    Pose turn = Pose::rotate(90, {0, 1, 0});
    EXPECT_NEAR(turn.matrix[2], 1, 1e-12);
}

TEST(Api, Version) {
    EXPECT_THAT(std::string(alhazen::library_version()), testing::StartsWith("0."));
}

} // namespace
