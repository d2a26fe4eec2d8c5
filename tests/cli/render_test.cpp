/// alhazen render, option by option, and what it says when something is wrong.
#include <csignal>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "image/codec.h"
#include "tests/cli/program.h"

namespace alhazen::testing {
namespace {

using ::testing::HasSubstr;

struct Render : ProgramTest {
    void SetUp() override {
        ProgramTest::SetUp();
        write_scene();
    }
    Image picture(const std::string& name) { return read_image(path(name)); }
    void expect_error(const std::string& arguments, const std::string& message) {
        Outcome o = alhazen(arguments);
        EXPECT_EQ(o.exit_code, 2) << arguments;
        EXPECT_THAT(o.err, HasSubstr(message)) << arguments;
    }
};

TEST_F(Render, WritesEveryFormatAskedFor) {
    Outcome o = alhazen("render scene.pbrt -o a.exr -o a.png -o a.jpg -o a.hdr -o a.pfm");
    EXPECT_EQ(o.exit_code, 0) << o.err;
    for (const char* name : {"a.exr", "a.png", "a.jpg", "a.hdr", "a.pfm"}) {
        ASSERT_TRUE(exists(name)) << name;
        EXPECT_EQ(picture(name).size(), (Vec2i{32, 24})) << name;
        EXPECT_THAT(o.out, HasSubstr(std::string(name) + ": 32 x 24, 4 spp"));
    }
    EXPECT_EQ(o.err, "");
}

TEST_F(Render, WithoutOutputTheScenesOwnNameIsUsed) {
    EXPECT_EQ(alhazen("render scene.pbrt").exit_code, 0);
    EXPECT_TRUE(exists("scene.exr"));
    write_scene("\"string filename\" \"mine.png\"");
    EXPECT_EQ(alhazen("render scene.pbrt").exit_code, 0);
    EXPECT_TRUE(exists("mine.png"));
}

TEST_F(Render, SizeCropAndSamples) {
    ASSERT_EQ(alhazen("render scene.pbrt --size 40x30 --spp 2 -o a.pfm").exit_code, 0);
    EXPECT_EQ(picture("a.pfm").size(), (Vec2i{40, 30}));
    ASSERT_EQ(alhazen("render scene.pbrt --size 40x30 --spp 2 --crop 10,5,30,20 -o b.pfm").exit_code, 0);
    Image whole = picture("a.pfm"), part = picture("b.pfm");
    ASSERT_EQ(part.size(), (Vec2i{20, 15}));
    for (int y = 0; y < 15; ++y)
        for (int x = 0; x < 20; ++x) EXPECT_EQ(part.rgb(x, y), whole.rgb(x + 10, y + 5));
}

TEST_F(Render, TextureMemoryDoesNotChangeThePicture) {
    Image image = Image::rgb_image(300, 200);
    for (int y = 0; y < 200; ++y)
        for (int x = 0; x < 300; ++x)
            image.set_rgb(x, y,
                          {0.001f * static_cast<float>(x * y % 997), 0.3f, 0.004f * static_cast<float>(y)});
    write_image(path("picture.png"), image);
    write("textured.pbrt", file_text(path("scene.pbrt")) + R"(
Texture "picture" "spectrum" "imagemap" "string filename" "picture.png" "string filter" "ewa"
Material "diffuse" "texture reflectance" "picture"
Shape "bilinearmesh" "point3 P" [ -4 -4 2  4 -4 2  -4 4 2  4 4 2 ]
)");
    ASSERT_EQ(alhazen("render textured.pbrt -o a.pfm --stats a.json").exit_code, 0);
    ASSERT_EQ(alhazen("render textured.pbrt -o b.pfm --stats b.json --texture-memory 10k").exit_code, 0);
    EXPECT_EQ(file_text(path("a.pfm")), file_text(path("b.pfm")));
    auto whole = nlohmann::json::parse(file_text(path("a.json")))["textures"];
    auto limited = nlohmann::json::parse(file_text(path("b.json")))["textures"];
    EXPECT_GE(whole["peak_bytes"], 300 * 200 * 12);
    EXPECT_EQ(limited["limit_bytes"], 10240);
    EXPECT_GT(limited["peak_bytes"], 0);
    EXPECT_GT(limited["tiles_made"], 0);
    EXPECT_GE(limited["temporary_file_bytes"], 300 * 200 * 12);
    for (const char* folder : {"none", "scene.pbrt"}) {
        Outcome o = shell(fmt::format("TMPDIR={} {} render textured.pbrt -o c.pfm --texture-memory 1M",
                                      folder, ALHAZEN_PROGRAM));
        EXPECT_EQ(o.exit_code, 2);
        EXPECT_THAT(o.err, HasSubstr("picture.png\": temporary file: there is no folder for it where"));
        EXPECT_FALSE(exists("c.pfm"));
    }
}

TEST_F(Render, QuietPrintsNothing) {
    Outcome o = alhazen("render scene.pbrt -o a.png --quiet");
    EXPECT_EQ(o.exit_code, 0);
    EXPECT_EQ(o.out + o.err, "");
}

TEST_F(Render, SeedChangesTheNoiseThreadsAndScheduleDoNot) {
    ASSERT_EQ(alhazen("render scene.pbrt -o a.pfm --threads 1").exit_code, 0);
    ASSERT_EQ(alhazen("render scene.pbrt -o b.pfm --threads 3 --tile-size 5").exit_code, 0);
    ASSERT_EQ(alhazen("render scene.pbrt -o c.pfm --seed 5").exit_code, 0);
    ASSERT_EQ(alhazen("render scene.pbrt -o d.pfm --in-flight 50").exit_code, 0);
    EXPECT_EQ(file_text(path("a.pfm")), file_text(path("b.pfm")));
    EXPECT_EQ(file_text(path("a.pfm")), file_text(path("d.pfm")));
    EXPECT_NE(file_text(path("a.pfm")), file_text(path("c.pfm")));
}

TEST_F(Render, CameraIntegratorColorAndSet) {
    ASSERT_EQ(alhazen("render scene.pbrt -o back.pfm --camera back").exit_code, 0);
    ASSERT_EQ(alhazen("render scene.pbrt -o last.pfm").exit_code, 0);
    ASSERT_EQ(alhazen("render scene.pbrt -o front.pfm --camera front").exit_code, 0);
    EXPECT_EQ(file_text(path("back.pfm")), file_text(path("last.pfm")));
    EXPECT_NE(file_text(path("back.pfm")), file_text(path("front.pfm")));
    ASSERT_EQ(alhazen("render scene.pbrt -o rgb.pfm --color rgb").exit_code, 0);
    EXPECT_NE(file_text(path("rgb.pfm")), file_text(path("last.pfm")));
    ASSERT_EQ(alhazen("render scene.pbrt -o ao.pfm --integrator ambientocclusion").exit_code, 0);
    ASSERT_EQ(alhazen("render scene.pbrt -o black.pfm --set material.Clay.reflectance='0 0 0' --set "
                      "integrator.maxdepth=1 --camera front --color rgb")
                  .exit_code,
              0);
    EXPECT_EQ(picture("black.pfm").rgb(16, 12), (Vec3{0, 0, 0}));
    EXPECT_GT(picture("front.pfm").rgb(16, 12).x, 0);
}

TEST_F(Render, SetReachesTheIntegratorThatIsAskedForAndSpectraByName) {
    EXPECT_EQ(
        alhazen("render scene.pbrt -o a.png --integrator ambientocclusion --set integrator.maxdistance=2")
            .exit_code,
        0);
    expect_error("render scene.pbrt -o a.png --integrator whitted --set integrator.regularize=true",
                 "integrator \"whitted\" has no parameter \"regularize\"");
    EXPECT_EQ(alhazen("render scene.pbrt -o a.png --set material.Clay.reflectance=stdillum-A").exit_code, 0);
    EXPECT_EQ(alhazen("render scene.pbrt -o a.pfm --set sampler.seed=16777216").exit_code, 0);
    EXPECT_EQ(alhazen("render scene.pbrt -o b.pfm --set sampler.seed=16777217").exit_code, 0);
    EXPECT_NE(file_text(path("a.pfm")), file_text(path("b.pfm")));
}

TEST_F(Render, NestedInstancesUpToTheLimit) {
    auto nested = [](int levels) {
        std::string text = "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\n"
                           "Translate 0 0 5\nCamera \"perspective\"\nWorldBegin\n"
                           "LightSource \"infinite\" \"rgb L\" [ 1 1 1 ]\n"
                           "ObjectBegin \"o1\"\nShape \"sphere\"\nObjectEnd\n";
        for (int i = 2; i <= levels; ++i)
            text += fmt::format("ObjectBegin \"o{}\"\nObjectInstance \"o{}\"\nObjectEnd\n", i, i - 1);
        return text + fmt::format("ObjectInstance \"o{}\"\n", levels);
    };
    write("nest.pbrt", nested(8));
    EXPECT_EQ(alhazen("render nest.pbrt -o a.pfm --spp 4").exit_code, 0);
    write("flat.pbrt", nested(1));
    EXPECT_EQ(alhazen("render flat.pbrt -o b.pfm --spp 4").exit_code, 0);
    // Each level may round once more.
    Image deep = picture("a.pfm"), flat = picture("b.pfm");
    for (std::size_t i = 0; i < deep.values().size(); ++i)
        EXPECT_NEAR(deep.values()[i], flat.values()[i], 1e-4f);
    write("nest.pbrt", nested(9));
    expect_error("render nest.pbrt -o a.pfm", "object \"o9\" nests instances 9 deep; at most 8 are possible");
}

TEST_F(Render, AStrandIsNoLamp) {
    write("glow.pbrt", "WorldBegin\nAreaLightSource \"diffuse\"\n"
                       "Shape \"curve\" \"point3 P\" [ 0 0 0 1 0 0 2 0 0 3 0 0 ]\n");
    expect_error("render glow.pbrt -o a.pfm",
                 "glow.pbrt:3:1: error: shape \"curve\" cannot be an area light");
}

TEST_F(Render, AFullDiskIsNoSuccess) {
    EXPECT_EQ(shell(ALHAZEN_PROGRAM " info scene.pbrt > /dev/full").exit_code, 2);
}

TEST_F(Render, StatsAreJson) {
    ASSERT_EQ(alhazen("render scene.pbrt -o a.png --stats s.json --threads 1").exit_code, 0);
    auto stats = nlohmann::json::parse(file_text(path("s.json")));
    for (const char* key : {"load_seconds", "build_seconds", "render_seconds", "mrays_per_second",
                            "peak_memory_bytes", "triangles", "warnings", "non_finite_samples"})
        EXPECT_TRUE(stats.contains(key)) << key;
    EXPECT_EQ(stats["rays"]["camera"], 32 * 24 * 4);
    EXPECT_EQ(stats["samples_per_pixel"], 4);
    EXPECT_EQ(stats["non_finite_samples"], 0);
}

TEST_F(Render, AnIntegralComesWithItsErrors) {
    write("f.pbrt", "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\n"
                    "Integrator \"function\" \"string imagefilename\" \"step.png\" \"string filename\" "
                    "\"errors.txt\"\nSampler \"sobol\"\nWorldBegin\n");
    const Outcome o = alhazen("render f.pbrt --spp 4 -o a.png --stats s.json");
    EXPECT_EQ(o.exit_code, 0) << o.err;
    EXPECT_THAT(o.out, HasSubstr("samples  mean squared error\n       1  1.000e+00\n       2  "));
    EXPECT_TRUE(exists("step.png"));
    EXPECT_THAT(file_text(path("errors.txt")), ::testing::StartsWith("1 1\n2 "));
    const auto errors = nlohmann::json::parse(file_text(path("s.json")))["quadrature_errors"];
    ASSERT_EQ(errors.size(), 3u);
    EXPECT_EQ(errors[0]["mean_squared_error"], 1);
    EXPECT_EQ(errors[2]["samples"], 4);
}

TEST_F(Render, LenientRendersOnAndSaysWhatWasReplaced) {
    write("new.pbrt", file_text(path("scene.pbrt")) + "Shape \"blob\" \"float size\" 3\n");
    expect_error("render new.pbrt -o a.png", "new.pbrt:15:1: error: unknown shape \"blob\"");
    EXPECT_FALSE(exists("a.png"));
    Outcome o = alhazen("render new.pbrt -o a.png --lenient");
    EXPECT_EQ(o.exit_code, 0) << o.err;
    EXPECT_THAT(o.err, HasSubstr("new.pbrt:15:1: warning: unknown shape \"blob\""));
    EXPECT_TRUE(exists("a.png"));
}

TEST_F(Render, ShowWithoutAScreenIsNoError) {
    Outcome o = shell("unset DISPLAY WAYLAND_DISPLAY; " ALHAZEN_PROGRAM " render scene.pbrt -o a.png --show");
    EXPECT_EQ(o.exit_code, 0) << o.err;
}

TEST_F(Render, InterruptWritesTheImageSoFar) {
    // Enough samples that it cannot be done before the signal. A slow machine may still be loading when it
    // comes, and loading simply ends: then there is more patience.
    // timeout sends the signal twice, to the program and to its group, which must count as one.
    for (int seconds : {2, 10, 50}) {
        Outcome o =
            shell(fmt::format("timeout --preserve-status -s INT {} {} render scene.pbrt --spp 4000000 "
                              "-o a.png --stats s.json",
                              seconds, ALHAZEN_PROGRAM));
        ASSERT_EQ(o.exit_code, 130) << o.err;
        if (exists("a.png")) break;
    }
    ASSERT_TRUE(exists("a.png"));
    EXPECT_EQ(picture("a.png").size(), (Vec2i{32, 24}));
    EXPECT_TRUE(nlohmann::json::parse(file_text(path("s.json")))["cancelled"]);
}

TEST_F(Render, ArgumentsThatAreWrong) {
    expect_error("render", "alhazen: error: SCENE is required");
    expect_error("render none.pbrt", "none.pbrt: error: cannot read the scene: no such file");
    expect_error("render .", "error: ");
    expect_error("render scene.pbrt -o a.gif", "cannot write \"a.gif\": the suffix must be one of .exr");
    expect_error("render scene.pbrt -o none/a.png", "there is no folder \"none\"");
    expect_error("render scene.pbrt --spp 0", "--spp");
    expect_error("render scene.pbrt --spp many", "--spp");
    expect_error("render scene.pbrt --size 10", "\"10\" is not a size; write it as 800x600");
    expect_error("render scene.pbrt --size 0x10", "is not a size");
    expect_error("render scene.pbrt --crop 1,2,3", "\"1,2,3\" is not a crop");
    expect_error("render scene.pbrt --crop 0,0,100,100", "outside the film of 32 x 24 pixels");
    expect_error("render scene.pbrt --integrator pth", "unknown integrator \"pth\" (did you mean \"path\"?)");
    expect_error("render scene.pbrt --camera fornt",
                 "no camera is named \"fornt\" (did you mean \"front\"?)");
    expect_error("render scene.pbrt --seed x", "--seed");
    expect_error("render scene.pbrt --threads -1", "--threads");
    expect_error("render scene.pbrt --tile-size 0", "--tile-size");
    expect_error("render scene.pbrt --in-flight 0", "--in-flight");
    expect_error("render scene.pbrt --color cmyk", "--color");
    for (const char* size : {"0", "-1", "2X", "1.5G", "M", "99999999999999T", "12MM", "\"\""})
        expect_error(fmt::format("render scene.pbrt --texture-memory {}", size),
                     "is not an amount of memory");
    expect_error("render scene.pbrt --stats none/s.json -o a.png", "cannot write \"none/s.json\"");
    expect_error("render scene.pbrt --seed 99999999999999999999", "is not a whole number from 0 to");
    expect_error("render scene.pbrt --set maxdepth=3", "write it as FAMILY.PARAMETER=VALUE");
    expect_error("render scene.pbrt --set integrator.maxdept=3",
                 "integrator \"path\" has no parameter \"maxdept\" (did you mean \"maxdepth\"?)");
    expect_error("render scene.pbrt --set integrator.maxdepth=deep",
                 "\"deep\" is not a value of type integer");
    expect_error("render scene.pbrt --set material.Wax.reflectance=1", "the scene has no \"material.Wax\"");
    expect_error("render scene.pbrt --frobnicate", "--frobnicate");
    expect_error("rendr scene.pbrt", "unknown command \"rendr\" (did you mean \"render\"?)");
    expect_error("render scene.pbrt --seed -1", "--seed");
    expect_error("render scene.pbrt --size 60000x60000", "is too large; at most");
}

TEST_F(Render, LosesNoFile) {
    const std::string scene = file_text(path("scene.pbrt"));
    expect_error("render scene.pbrt -o a.png --stats scene.pbrt", "it is what is read; give another name");
    expect_error("render scene.pbrt -o a.png --stats ./scene.pbrt", "it is what is read");
    EXPECT_EQ(file_text(path("scene.pbrt")), scene);
    expect_error("render scene.pbrt -o a.png --stats a.png", "cannot write \"a.png\" twice");
    expect_error("render scene.pbrt -o a.png -o ./a.png", "cannot write \"./a.png\" twice");
    expect_error("render scene.pbrt --stats scene.exr", "cannot write \"scene.exr\" twice");
    expect_error("render scene.pbrt -o a.png --stats .", "it is a folder");
    // A link leads to the same place afterwards.
    write("real.png", "");
    std::filesystem::create_symlink("real.png", path("link.png"));
    ASSERT_EQ(alhazen("render scene.pbrt -o link.png").exit_code, 0);
    EXPECT_TRUE(std::filesystem::is_symlink(path("link.png")));
    EXPECT_EQ(picture("real.png").size(), (Vec2i{32, 24}));
}

TEST_F(Render, PipesAreWrittenToAsTheyAre) {
    const Outcome o = alhazen("render scene.pbrt -o a.png --quiet --stats /dev/stdout | cat");
    EXPECT_EQ(o.err, "");
    EXPECT_EQ(nlohmann::json::parse(o.out)["samples_per_pixel"], 4);
    // Into a file that the shell has opened, too.
    EXPECT_EQ(alhazen("render scene.pbrt -o a.png --quiet --stats /dev/stdout").out.substr(0, 1), "{");
    const Outcome piped = shell("mkfifo p; cat p > read.json & " ALHAZEN_PROGRAM
                                " render scene.pbrt -o a.png --quiet --stats p; wait; test -p p");
    EXPECT_EQ(piped.exit_code, 0) << piped.err;
    EXPECT_EQ(nlohmann::json::parse(file_text(path("read.json")))["samples_per_pixel"], 4);
}

TEST_F(Render, TheNameOfTheSceneIsKeptWhole) {
    std::filesystem::rename(path("scene.pbrt"), path("my.scene.v2.pbrt"));
    ASSERT_EQ(alhazen("render my.scene.v2.pbrt").exit_code, 0);
    EXPECT_TRUE(exists("my.scene.v2.exr"));
    ASSERT_EQ(shell("gzip my.scene.v2.pbrt && rm my.scene.v2.exr").exit_code, 0);
    ASSERT_EQ(alhazen("render my.scene.v2.pbrt.gz").exit_code, 0);
    EXPECT_TRUE(exists("my.scene.v2.exr"));
}

TEST_F(Render, NamesMayHoldAnyBytes) {
    write("bytes.pbrt", file_text(path("scene.pbrt")) + "\nCoordSysTransform \"caf\xe9\"\n");
    const Outcome o = alhazen("render bytes.pbrt -o a.png --stats s.json");
    EXPECT_EQ(o.exit_code, 0) << o.err;
    const auto stats = nlohmann::json::parse(file_text(path("s.json")));
    EXPECT_EQ(stats["warnings"].size(), 1u);
    EXPECT_EQ(alhazen("info bytes.pbrt --json").exit_code, 0);
}

TEST_F(Render, SamplesThatAreNotNumbersCanBeSeenAgain) {
    write("a bright.pbrt", R"(Integrator "whitted"
Film "rgb" "integer xresolution" 8 "integer yresolution" 8
LookAt 0 0 -4  0 0 0  0 1 0
Camera "perspective" "float fov" 30
WorldBegin
LightSource "point" "point3 from" [ 0 0 -4 ] "rgb I" [ 3e38 3e38 3e38 ] "string falloff" "none"
LightSource "point" "point3 from" [ 0 1 -4 ] "rgb I" [ 3e38 3e38 3e38 ] "string falloff" "none"
Material "phong" "rgb diffuse" [ 1 1 1 ]
Shape "sphere"
)");
    const Outcome o = alhazen("render 'a bright.pbrt' --seed 5 --set integrator.maxdepth=2 -o a.pfm");
    ASSERT_THAT(o.err, HasSubstr("samples were not finite numbers"));
    const auto command = o.err.find("alhazen render"), end = o.err.find('\n', command);
    const std::string again = o.err.substr(command + 8, end - command - 8);
    EXPECT_THAT(again, HasSubstr("--seed 5 --set integrator.maxdepth=2"));
    EXPECT_THAT(alhazen(again + " -o b.pfm").err, HasSubstr("samples were not finite numbers"));
}

TEST_F(Render, SetNamesMediaAndCameras) {
    write("fog.pbrt", R"(Film "rgb" "integer xresolution" 4 "integer yresolution" 4
MakeNamedMedium "Fog" "string type" "homogeneous"
Camera "perspective" "float fov" 40
WorldBegin
LightSource "infinite"
)");
    ASSERT_EQ(alhazen("render fog.pbrt --set medium.Fog.g=.5 -o a.png").exit_code, 0);
    expect_error("render fog.pbrt --set medium.Fgo.g=.5", "did you mean \"medium.Fog\"?");
    expect_error("render fog.pbrt --set medium.Fog.g=5", "--set medium.Fog.g=5: error: parameter \"g\" is 5");
}

TEST_F(Render, ValuesOutOfRangeNameTheirPlace) {
    write("bad.pbrt", "Integrator \"path\" \"integer maxdepth\" -1\nWorldBegin\n");
    expect_error("render bad.pbrt", "bad.pbrt:1:19: error: parameter \"maxdepth\" is -1; it must be");
    write("bad.pbrt", "Integrator \"path\" \"integer maxdept\" 1\nWorldBegin\n");
    expect_error("render bad.pbrt",
                 "unknown parameter \"maxdept\" of integrator \"path\" (did you mean \"maxdepth\"?)");
    write("bad.pbrt", "Integrator \"path\" \"string maxdepth\" \"deep\"\nWorldBegin\n");
    expect_error("render bad.pbrt", "parameter \"maxdepth\" is declared as string, but must be integer");
}

} // namespace
} // namespace alhazen::testing
