/// alhazen sdf, and scenes that show what it made.
#include <gmock/gmock.h>

#include "formats/grids.h"
#include "image/codec.h"
#include "image/metrics.h"
#include "tests/cli/program.h"

namespace alhazen::testing {
namespace {

using ::testing::HasSubstr;

struct SdfCommand : ProgramTest {
    void SetUp() override {
        ProgramTest::SetUp();
        // A cube, and a scene that shows it as a mesh or as a grid.
        std::ofstream(path("cube.ply")) << R"(ply
format ascii 1.0
element vertex 8
property float x
property float y
property float z
element face 6
property list uchar int vertex_indices
end_header
-1 -1 -1
1 -1 -1
1 1 -1
-1 1 -1
-1 -1 1
1 -1 1
1 1 1
-1 1 1
4 0 3 2 1
4 4 5 6 7
4 0 1 5 4
4 1 2 6 5
4 2 3 7 6
4 3 0 4 7
)";
        for (const char* shape :
             {"plymesh\" \"string filename\" \"cube.ply\"",
              "sdfgrid\" \"string filename\" \"cube.vol\" \"string normals\" \"analytic\""}) {
            bool is_mesh = shape[0] == 'p';
            std::ofstream(path(is_mesh ? "mesh.pbrt" : "grid.pbrt")) << R"(
Integrator "whitted" "rgb ambient" [ .1 .1 .1 ]
Sampler "independent" "integer pixelsamples" 1
Film "rgb" "integer xresolution" 60 "integer yresolution" 40
LookAt 3 4 -6  0 0 0  0 1 0
Camera "perspective" "float fov" 35
WorldBegin
LightSource "point" "string falloff" "none" "point3 from" [ 5 9 -12 ] "rgb I" [ 1 1 1 ]
Material "phong" "rgb diffuse" [ .6 .5 .3 ]
Rotate 25 0 1 0
Shape ")" << shape << "\n";
        }
    }
};

TEST_F(SdfCommand, MakesAGridThatLooksLikeTheMesh) {
    Outcome o = alhazen("sdf cube.ply -o cube.vol --resolution 64");
    ASSERT_EQ(o.exit_code, 0) << o.err;
    EXPECT_THAT(o.out, HasSubstr("71 x 71 x 71 samples"));
    ASSERT_EQ(alhazen("render mesh.pbrt -o mesh.pfm -q").exit_code, 0);
    Outcome shown = alhazen("render grid.pbrt -o grid.pfm -q");
    ASSERT_EQ(shown.exit_code, 0) << shown.err;
    // The edges are a little rounder.
    EXPECT_LT(flip(read_image(path("grid.pfm")), read_image(path("mesh.pfm"))).value, 0.03);
}

TEST_F(SdfCommand, MakesLevelSets) {
    Outcome o = alhazen("sdf cube.ply -o cube.nvdb --resolution 96");
    if (!has_nanovdb()) {
        EXPECT_EQ(o.exit_code, 2);
        EXPECT_THAT(o.err, HasSubstr("built without NanoVDB"));
        return;
    }
    ASSERT_EQ(o.exit_code, 0) << o.err;
    GridData grid = read_grid(path("cube.nvdb"), "");
    EXPECT_TRUE(grid.is_level_set);
    EXPECT_LT(grid.bricks.size(), 13u * 13u * 13u * 7 / 10); // of 103 samples along each axis
}

// The same cube in a file, and in a scene as one of its halves and an instance of an instance of it.
TEST_F(SdfCommand, MakesAGridOfAScene) {
    write("scene.pbrt", R"(WorldBegin
ObjectBegin "half"
Shape "trianglemesh" "point3 P" [ -1 -1 -1  0 -1 -1  0 1 -1  -1 1 -1  -1 -1 1  0 -1 1  0 1 1  -1 1 1 ]
    "integer indices" [ 0 2 1 0 3 2  4 5 6 4 6 7  0 1 5 0 5 4  2 3 7 2 7 6  3 0 4 3 4 7 ]
ObjectEnd
ObjectBegin "other"
Scale -1 1 1
ObjectInstance "half"
ObjectEnd
ObjectInstance "half"
ObjectInstance "other"
Shape "curve" "point3 P" [ 0 0 0  .1 0 0  .2 0 0  .3 0 0 ]
)");
    for (const char* input : {"cube.ply", "scene.pbrt"}) {
        Outcome o = alhazen(fmt::format("sdf {} -o {}.vol --resolution 24", input, input));
        ASSERT_EQ(o.exit_code, 0) << o.err;
        EXPECT_THAT(o.out, HasSubstr("31 x 31 x 31 samples"));
        EXPECT_EQ(o.err, input[0] == 'c' ? ""
                                         : "scene.pbrt:12:1: warning: shape \"curve\" cannot be cut into "
                                           "triangles; it is left out\n");
    }
    GridData mesh = read_grid(path("cube.ply.vol"), ""), scene = read_grid(path("scene.pbrt.vol"), "");
    ASSERT_EQ(mesh.bricks.size(), scene.bricks.size());
    for (std::size_t i = 0; i < mesh.bricks.size(); ++i)
        for (std::size_t k = 0; k < GridBrick::samples; ++k)
            ASSERT_NEAR(mesh.bricks[i].values[k], scene.bricks[i].values[k], 1e-6f);
}

TEST_F(SdfCommand, SaysWhatIsWrong) {
    write("empty.pbrt", "WorldBegin\n");
    write("bad.ply", "no mesh\n");
    for (auto [arguments, text] :
         {std::pair{"none.ply -o a.vol", "none.ply: no such file"},
          {"cube.ply -o a.raw", "the suffix must be one of .vol"},
          {"cube.ply -o none/a.vol", "there is no folder \"none\""},
          {"grid.pbrt -o a.vol", "grid.pbrt:11:17: error: grid file \"cube.vol\": no such"},
          {"empty.pbrt -o a.vol", "empty.pbrt: error: the scene has no surfaces\n"},
          {"mesh.pbrt -o a.vol --max-triangles 11",
           "mesh.pbrt: error: the scene's surfaces would be 12 triangles, instances "
           "repeated; at most 11 are made (--max-triangles)\n"},
          {"cube.txt -o a.vol", "cube.txt: error: unknown scene format \".txt\""},
          {"bad.ply -o a.vol", "bad.ply: "},
          {"cube.ply", "--output is required"},
          {"cube.ply -o a.vol --resolution 1", "--resolution"}}) {
        SCOPED_TRACE(arguments);
        Outcome o = alhazen(std::string("sdf ") + arguments);
        EXPECT_EQ(o.exit_code, 2);
        EXPECT_THAT(o.err, HasSubstr(text));
        EXPECT_FALSE(std::filesystem::exists(path("a.vol")));
    }
    Outcome missing = alhazen("render grid.pbrt");
    EXPECT_EQ(missing.exit_code, 2);
    EXPECT_THAT(missing.err, HasSubstr("grid.pbrt:11:17"));
    EXPECT_THAT(missing.err, HasSubstr("grid file \"cube.vol\": no such file"));
}

// Wherever a scene names one: as a shape and as a medium, from the folder that the program runs in.
TEST_F(SdfCommand, SaysHowToConvertOpenVdbFiles) {
    std::filesystem::create_directories(path("scenes"));
    write("scenes/shape.pbrt", R"(WorldBegin
Shape "sdfgrid" "string filename" "wisp.vdb"
)");
    write("scenes/medium.pbrt", R"(Integrator "volpath"
WorldBegin
MakeNamedMedium "wisp" "string type" "nanovdb" "string filename" "wisp.vdb"
)");
    const std::string is_read =
        has_nanovdb() ? "is" : "is by programs built with NanoVDB (package libnanovdb-dev)";
    const std::string text = ": error: grid file \"wisp.vdb\": it is an OpenVDB file, which is not read; a "
                             "NanoVDB file " +
                             is_read +
                             ", and this command (Debian's package libnanovdb-tools) makes one of it: "
                             "nanovdb_convert scenes/wisp.vdb scenes/wisp.nvdb\n";
    for (const char* place : {"scenes/shape.pbrt:2:17", "scenes/medium.pbrt:3:48"}) {
        const std::string scene = std::string(place).substr(0, std::string(place).find(':'));
        Outcome o = alhazen("render " + scene);
        EXPECT_EQ(o.exit_code, 2);
        EXPECT_EQ(o.err, place + text);
    }
}

} // namespace
} // namespace alhazen::testing
