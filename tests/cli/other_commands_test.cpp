/// alhazen info, compare, convert, diff and help.
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "image/codec.h"
#include "tests/cli/program.h"

namespace alhazen::testing {
namespace {

using ::testing::HasSubstr;

struct Commands : ProgramTest {
    void SetUp() override {
        ProgramTest::SetUp();
        write_scene();
        Image grey = Image::rgb_image(16, 12), brighter = grey;
        for (int y = 0; y < 12; ++y)
            for (int x = 0; x < 16; ++x) {
                grey.set_rgb(x, y, Vec3(0.25f));
                brighter.set_rgb(x, y, Vec3(0.5f));
            }
        write_image(path("a.pfm"), grey);
        write_image(path("b.pfm"), brighter);
    }
};

TEST_F(Commands, InfoTellsWhatIsThere) {
    Outcome o = alhazen("info scene.pbrt");
    ASSERT_EQ(o.exit_code, 0) << o.err;
    for (const char* text : {"32 x 24, 4 spp", "1 sphere", "1 diffuse", "1 infinite, 1 point",
                             "bounds       (-1, -1, -1) to (1, 1, 1)", "memory"})
        EXPECT_THAT(o.out, HasSubstr(text));
    auto json = nlohmann::json::parse(alhazen("info scene.pbrt --json").out);
    EXPECT_EQ(json["primitives"], 1);
    EXPECT_EQ(json["light_count"], 2);
    EXPECT_GT(json["shape_bytes"], 100);
    EXPECT_NEAR(json["bounds"]["max"][0], 1, 1e-6);
    EXPECT_EQ(alhazen("info none.pbrt").exit_code, 2);
}

TEST_F(Commands, InfoNamesMedia) {
    std::ofstream(path("fog.pbrt")) << "WorldBegin\n"
                                       "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\"\n"
                                       "MakeNamedMedium \"steam\" \"string type\" \"cloud\"\n";
    EXPECT_THAT(alhazen("info fog.pbrt").out, HasSubstr("media        2\n    fog "));
    auto media = nlohmann::json::parse(alhazen("info fog.pbrt --json").out)["media"];
    ASSERT_EQ(media.size(), 2u);
    EXPECT_EQ(media[1]["name"], "steam");
    EXPECT_EQ(media[1]["type"], "cloud");
}

TEST_F(Commands, ConvertChangesFormatExposureAndCurve) {
    ASSERT_EQ(alhazen("convert a.pfm a.exr").exit_code, 0);
    EXPECT_EQ(read_image(path("a.exr")).rgb(3, 3), Vec3(0.25f));
    ASSERT_EQ(alhazen("convert a.pfm c.pfm --exposure 1").exit_code, 0);
    EXPECT_EQ(read_image(path("c.pfm")).rgb(3, 3), Vec3(0.5f));
    for (const char* curve : {"srgb", "aces", "agx"}) {
        ASSERT_EQ(alhazen(std::string("convert a.pfm d.pfm --exposure 10 --tonemap ") + curve).exit_code, 0);
        EXPECT_LE(read_image(path("d.pfm")).rgb(3, 3).x, 1.0f) << curve;
        EXPECT_GT(read_image(path("d.pfm")).rgb(3, 3).x, 0.7f) << curve;
    }
    ASSERT_EQ(alhazen("convert a.pfm e.png --transfer linear").exit_code, 0);
    ASSERT_EQ(alhazen("convert a.pfm f.jpg --quality 50").exit_code, 0);
    ASSERT_EQ(alhazen("convert a.pfm g.exr --float").exit_code, 0);
    EXPECT_EQ(alhazen("convert a.pfm a.xyz").exit_code, 2);
    EXPECT_THAT(alhazen("convert none.png b.png").err, HasSubstr("none.png: no such file"));
    EXPECT_THAT(alhazen("convert scene.pbrt b.png").err, HasSubstr("scene.pbrt: "));
    EXPECT_EQ(alhazen("convert a.pfm b.png --tonemap film").exit_code, 2);
}

TEST_F(Commands, ConvertTakesALayer) {
    Image image(4, 3, {"R", "G", "B", "N.X", "N.Y", "N.Z", "u"});
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 4; ++x)
            for (int c = 0; c < 7; ++c) image.at(x, y, c) = static_cast<float>(c) * 0.125f;
    write_image(path("layers.exr"), image);
    ASSERT_EQ(alhazen("convert layers.exr n.pfm --layer N").exit_code, 0);
    EXPECT_EQ(read_image(path("n.pfm")).rgb(1, 2), Vec3(.375f, .5f, .625f));
    ASSERT_EQ(alhazen("convert layers.exr u.pfm --layer u").exit_code, 0);
    EXPECT_EQ(read_image(path("u.pfm")).rgb(1, 2), Vec3(.75f));
    Outcome o = alhazen("convert layers.exr z.pfm --layer Albedo");
    EXPECT_EQ(o.exit_code, 2);
    EXPECT_THAT(o.err, HasSubstr("layers.exr: there is no layer \"Albedo\"; the channels are "));
}

TEST_F(Commands, CompareShowsOneSceneInSeveralWays) {
    Outcome o = alhazen(
        "compare scene.pbrt --integrators whitted,path:lbvh/stack,path --spp 2 -o c.png --json c.json");
    ASSERT_EQ(o.exit_code, 0) << o.err;
    for (const char* text : {"whitted", "path:lbvh/stack", "FLIP to path", "c.png: 3 pictures side by side"})
        EXPECT_THAT(o.out, HasSubstr(text));
    Image sheet = read_image(path("c.png"));
    EXPECT_GT(sheet.width(), 2 * 32);
    EXPECT_GT(sheet.height(), 2 * 24);
    auto json = nlohmann::json::parse(file_text(path("c.json")));
    ASSERT_EQ(json.size(), 3u);
    EXPECT_EQ(json[1]["integrator"], "path:lbvh/stack");
    EXPECT_EQ(json[1]["samples_per_pixel"], 2);
    // Another structure, the same bits; another integrator, another picture.
    EXPECT_EQ(json[1]["flip"], 0);
    EXPECT_GT(json[0]["flip"], 0.01);
}

TEST_F(Commands, CompareSaysWhatIsWrong) {
    auto expect_error = [&](const std::string& arguments, const std::string& message) {
        Outcome o = alhazen("compare " + arguments);
        EXPECT_EQ(o.exit_code, 2) << arguments;
        EXPECT_THAT(o.err, HasSubstr(message)) << arguments;
    };
    expect_error("scene.pbrt --integrators whited",
                 "unknown integrator \"whited\" (did you mean \"whitted\"?)");
    expect_error("scene.pbrt --integrators path:sahh", "\"path:sahh\": unknown builder \"sahh\"");
    expect_error("scene.pbrt --integrator path", "--integrator names one");
    expect_error("scene.pbrt -o c.txt", "cannot write \"c.txt\"");
    expect_error("none.pbrt", "none.pbrt");
    EXPECT_FALSE(exists("compare.png"));
}

TEST_F(Commands, DiffPrintsEveryMetricAndJudges) {
    Outcome o = alhazen("diff a.pfm b.pfm");
    ASSERT_EQ(o.exit_code, 0) << o.err;
    // (1/4)^2 and (1/4)^2 / (1/2^2 + 0.01)
    EXPECT_THAT(o.out, HasSubstr("mse    0.0625\n"));
    EXPECT_THAT(o.out, HasSubstr("relmse 0.240385"));
    EXPECT_THAT(o.out, HasSubstr("largest 0.1 % left out"));
    for (const char* name : {"psnr", "ssim", "flip"}) EXPECT_THAT(o.out, HasSubstr(name));
    EXPECT_EQ(alhazen("diff a.pfm b.pfm --metric mse --max 0.07").exit_code, 0);
    EXPECT_EQ(alhazen("diff a.pfm b.pfm --metric mse --max 0.06").exit_code, 1);
    EXPECT_EQ(alhazen("diff a.pfm a.pfm --max 0").exit_code, 0);
    EXPECT_EQ(alhazen("diff a.pfm a.pfm --metric psnr --max 90").exit_code, 0);
    EXPECT_EQ(alhazen("diff a.pfm b.pfm --metric psnr --max 90").exit_code, 1);
    ASSERT_EQ(alhazen("diff a.pfm b.pfm -o heat.png").exit_code, 0);
    EXPECT_EQ(read_image(path("heat.png")).size(), (Vec2i{16, 12}));
    EXPECT_EQ(alhazen("diff a.pfm none.pfm").exit_code, 2);
    EXPECT_EQ(alhazen("diff a.pfm b.pfm --metric lpips").exit_code, 2);
    write_image(path("small.pfm"), Image::rgb_image(3, 3));
    EXPECT_THAT(alhazen("diff a.pfm small.pfm").err, HasSubstr("differ in size"));
}

TEST_F(Commands, CompareLeavesOutWhatTheFilmCannotTake) {
    write_scene();
    std::string scene = file_text(path("scene.pbrt"));
    scene.replace(scene.find("Film \"rgb\""), 10, "Film \"gbuffer\"");
    write("layers.pbrt", scene);
    const Outcome o = alhazen("compare layers.pbrt -o a.png --json a.json --spp 1");
    EXPECT_EQ(o.exit_code, 0) << o.err;
    EXPECT_EQ(alhazen("compare layers.pbrt -o a.png --json none/a.json --spp 1").exit_code, 2);
}

TEST_F(Commands, HelpKnowsCommandsFromTypes) {
    const Outcome o = alhazen("help render");
    EXPECT_EQ(o.exit_code, 2);
    EXPECT_THAT(o.err, HasSubstr("\"render\" is a command; alhazen render --help explains it"));
    EXPECT_EQ(alhazen("help spectrum gold").exit_code, 2);
    EXPECT_THAT(alhazen("help material").out, HasSubstr("diffusetransmission  "));
}

TEST_F(Commands, HelpExplainsEverythingRegistered) {
    Outcome all = alhazen("help");
    for (const char* family :
         {"integrator", "camera", "film", "filter", "sampler", "accelerator", "shape", "material", "medium",
          "float-texture", "spectrum-texture", "light", "area-light"}) {
        EXPECT_THAT(all.out, HasSubstr(family));
        Outcome list = alhazen(std::string("help ") + family);
        EXPECT_EQ(list.exit_code, 0);
    }
    Outcome phong = alhazen("help material phong");
    EXPECT_EQ(phong.exit_code, 0);
    for (const char* word : {"shininess", "reflectivity", "transparency", "default 50", "eta"})
        EXPECT_THAT(phong.out, HasSubstr(word));
    EXPECT_THAT(alhazen("help spectrum").out, HasSubstr("metal-Cu-eta"));
    EXPECT_THAT(alhazen("help texture imagemap").out, HasSubstr("filename"));
    EXPECT_EQ(alhazen("convert a.pfm b.exr --exposure nan").exit_code, 2);
    EXPECT_THAT(alhazen("help matrial").err, HasSubstr("did you mean \"material\"?"));
    EXPECT_THAT(alhazen("help material phnog").err, HasSubstr("did you mean \"phong\"?"));
    EXPECT_EQ(alhazen("help material phnog").exit_code, 2);
}

TEST_F(Commands, TheReferencePagesInDocsAreUpToDate) {
    ASSERT_EQ(alhazen("help --markdown reference").exit_code, 0);
    std::filesystem::path docs(ALHAZEN_SOURCE_DIR "/docs/reference");
    for (const auto& entry : std::filesystem::directory_iterator(path("reference")))
        EXPECT_EQ(file_text(docs / entry.path().filename()), file_text(entry.path()))
            << "run: alhazen help --markdown docs/reference";
}

TEST_F(Commands, HelpAndVersionAreShort) {
    Outcome o = alhazen("--help");
    EXPECT_EQ(o.exit_code, 0);
    for (const char* command : {"render", "info", "accel", "convert", "diff", "help"}) {
        EXPECT_THAT(o.out, HasSubstr(command));
        Outcome help = alhazen(std::string(command) + " --help");
        EXPECT_EQ(help.exit_code, 0);
        EXPECT_LT(std::count(help.out.begin(), help.out.end(), '\n'), 45);
    }
    EXPECT_THAT(alhazen("--version").out, HasSubstr("Alhazen 0.1.0"));
    EXPECT_EQ(alhazen("").exit_code, 0);
}

} // namespace
} // namespace alhazen::testing
