/// alhazen accel, and --accel of alhazen render.
#include <set>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/cli/program.h"

namespace alhazen::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

struct Accel : ProgramTest {
    void SetUp() override {
        ProgramTest::SetUp();
        write_scene();
        write("mesh.pbrt", R"(Film "rgb" "integer xresolution" 32 "integer yresolution" 24
LookAt 0 2 -5  0 0 0  0 1 0
Camera "perspective" "float fov" 50 "string name" "front"
WorldBegin
LightSource "point" "point3 from" [ 2 3 -4 ]
Shape "trianglemesh" "point3 P" [ -3 0 -3  3 0 -3  3 0 3  -3 0 3 ] "integer indices" [ 0 1 2 0 2 3 ]
Shape "trianglemesh" "point3 P" [ -1 0 0  1 0 0  0 1 0  0 0 1 ] "integer indices" [ 0 1 2 0 1 3 1 2 3 0 2 3 ]
)");
    }
    void expect_error(const std::string& arguments, const std::string& message) {
        Outcome o = alhazen(arguments);
        EXPECT_EQ(o.exit_code, 2) << arguments;
        EXPECT_THAT(o.err, HasSubstr(message)) << arguments;
        EXPECT_EQ(o.out, "") << arguments;
    }
    nlohmann::json json_of(const std::string& arguments) {
        Outcome o = alhazen("accel " + arguments + " --rays 64 --repeat 1 --json out.json");
        EXPECT_EQ(o.exit_code, 0) << o.err;
        return nlohmann::json::parse(file_text(path("out.json")));
    }
};

TEST_F(Accel, PrintsATableAndWritesRecords) {
    Outcome o = alhazen(
        "accel mesh.pbrt --builder sah,lbvh --walk stack --walk cwbvh --rays 64 --repeat 2 --json a.json");
    ASSERT_EQ(o.exit_code, 0) << o.err;
    EXPECT_EQ(o.err, "");
    for (const char* text : {"sah/stack", "sah/cwbvh", "lbvh/stack", "lbvh/cwbvh", "SAH cost",
                             "primary, closest", "diffuse, any", "Million rays a second"})
        EXPECT_THAT(o.out, HasSubstr(text));
    auto json = nlohmann::json::parse(file_text(path("a.json")));
    ASSERT_TRUE(json.is_array());
    // Two builders, two walks, six questions, two modes.
    EXPECT_EQ(json.size(), 2u * 2 * 6 * 2);
    std::set<std::string> builders, walks, rays, queries, modes;
    for (const auto& r : json) {
        builders.insert(r["builder"]);
        walks.insert(r["walk"]);
        rays.insert(r["rays"]);
        queries.insert(r["query"]);
        modes.insert(r["mode"]);
        EXPECT_EQ(r["scene"], "mesh.pbrt");
        EXPECT_EQ(r["triangles"], 6);
        for (const char* key : {"mrays_per_s", "build_s", "bytes_per_triangle", "sah_cost"})
            EXPECT_GT(r[key].get<double>(), 0) << key;
        for (const char* key : {"nodes_per_ray", "leaves_per_ray", "spread", "end_point_overlap"})
            EXPECT_GE(r[key].get<double>(), 0) << key;
        EXPECT_TRUE(r["embree_ratio"].is_null() || r["embree_ratio"].get<double>() > 0);
    }
    EXPECT_EQ(builders, (std::set<std::string>{"lbvh", "sah"}));
    EXPECT_EQ(walks, (std::set<std::string>{"cwbvh", "stack"}));
    EXPECT_EQ(rays, (std::set<std::string>{"ao", "diffuse", "primary", "shadow"}));
    EXPECT_EQ(queries, (std::set<std::string>{"any", "closest"}));
    EXPECT_EQ(modes, (std::set<std::string>{"batch", "single"}));
}

TEST_F(Accel, WithoutNamesEveryPairIsMeasured) {
    std::set<std::string> pairs;
    for (const auto& r : json_of("mesh.pbrt"))
        pairs.insert(r["builder"].get<std::string>() + "/" + r["walk"].get<std::string>());
    EXPECT_GE(pairs.size(), 25u);
    for (const char* pair :
         {"sah/stack", "lbvh/stackless", "kdtree/guthe", "octree/shortstack", "ploc/cwbvh"})
        EXPECT_TRUE(pairs.contains(pair)) << pair;
}

TEST_F(Accel, OptionsReachTheMeasurement) {
    auto one = json_of(
        "mesh.pbrt --builder ploc+reinsertion --walk shortstack --stack-entries 1 --threads 2 --seed 5");
    for (const auto& r : one) {
        EXPECT_EQ(r["builder"], "ploc+reinsertion");
        EXPECT_LE(r["max_stack"], 1);
        EXPECT_EQ(r["threads"], 2);
    }
    auto camera = json_of("mesh.pbrt --builder sah --walk stack --camera front");
    EXPECT_EQ(camera[0]["threads"], 1);
    // Counts are the same in every run.
    auto again = json_of("mesh.pbrt --builder sah --walk stack");
    for (std::size_t i = 0; i < again.size(); ++i)
        EXPECT_EQ(again[i]["nodes_per_ray"], camera[i]["nodes_per_ray"]);
}

TEST_F(Accel, ScenesOfOtherShapesHaveNoRatio) {
    for (const auto& r : json_of("scene.pbrt --builder sah --walk guthe,stack")) {
        EXPECT_TRUE(r["embree_ratio"].is_null());
        EXPECT_EQ(r["triangles"], 0);
    }
    EXPECT_THAT(alhazen("accel scene.pbrt --builder sah --walk stack --rays 64 --repeat 1").out,
                HasSubstr("nothing to compare with"));
}

TEST_F(Accel, ThePageNeedsNothingElse) {
    Outcome o = alhazen(
        "accel mesh.pbrt --builder lbvh --walk stack,stackless --rays 64 --repeat 1 --html a.html --quiet");
    ASSERT_EQ(o.exit_code, 0) << o.err;
    EXPECT_EQ(o.out + o.err, "");
    std::string html = file_text(path("a.html"));
    EXPECT_THAT(html, Not(HasSubstr("http")));
    EXPECT_THAT(html, Not(HasSubstr("src=\"a")));
    for (const char* text : {"<!doctype html>", "<svg", "src=\"data:image/png;base64,", "lbvh/stackless",
                             "Morton", "mesh.pbrt", "</html>"})
        EXPECT_THAT(html, HasSubstr(text));
    // Nothing is left of the temporary names.
    for (const auto& entry : std::filesystem::directory_iterator(path("")))
        EXPECT_THAT(entry.path().filename().string(), Not(HasSubstr("tmp")));
}

TEST_F(Accel, SaysWhatIsWrong) {
    expect_error("accel mesh.pbrt --builder lbhv", "unknown builder \"lbhv\" (did you mean \"lbvh\"?)");
    expect_error("accel mesh.pbrt --builder sah,,lbvh", "--builder: a name is missing");
    expect_error("accel mesh.pbrt --walk stak", "unknown walk \"stak\" (did you mean \"stack\"?)");
    expect_error("accel mesh.pbrt --walk ''", "--walk: a name is missing");
    expect_error("accel mesh.pbrt --builder sah+reinsertoin", "did you mean \"reinsertion\"?");
    expect_error("accel none.pbrt", "no such file");
    expect_error("accel", "SCENE is required");
    expect_error("accel mesh.pbrt --rays 3", "--rays");
    expect_error("accel mesh.pbrt --repeat 0", "--repeat");
    expect_error("accel mesh.pbrt --threads -1", "--threads");
    expect_error("accel mesh.pbrt --stack-entries 65", "--stack-entries");
    expect_error("accel mesh.pbrt --seed -1", "--seed");
    expect_error("accel mesh.pbrt --camera back", "no camera is named \"back\"");
    expect_error("accel mesh.pbrt --json none/a.json", "there is no folder \"none\"");
    expect_error("accel mesh.pbrt --html none/a.html", "there is no folder \"none\"");
    expect_error("acel mesh.pbrt", "did you mean \"accel\"?");
    write("bad.pbrt", "WorldBegin\nShape \"spere\"\n");
    expect_error("accel bad.pbrt", "bad.pbrt:2:1");
    EXPECT_EQ(alhazen("accel bad.pbrt --lenient --builder sah --walk stack --rays 64 --repeat 1").exit_code,
              0);
}

TEST_F(Accel, RenderTakesAnyPairAndTheImageStays) {
    ASSERT_EQ(alhazen("render mesh.pbrt --spp 2 -o a.pfm").exit_code, 0);
    for (const char* choice :
         {"lbvh/stackless", "ploc", "/cwbvh", "sah+reinsertion/guthe", "kdtree/shortstack"}) {
        Outcome o =
            alhazen(std::string("render mesh.pbrt --spp 2 -o b.pfm --stack-entries 2 --accel ") + choice);
        ASSERT_EQ(o.exit_code, 0) << o.err;
        EXPECT_EQ(file_text(path("a.pfm")), file_text(path("b.pfm"))) << choice;
    }
    expect_error("render mesh.pbrt --accel lbvh/stak -o b.pfm",
                 "unknown walk \"stak\" (did you mean \"stack\"?)");
    expect_error("render mesh.pbrt --accel bvh -o b.pfm", "unknown builder \"bvh\"");
    expect_error("render mesh.pbrt --stack-entries 0 -o b.pfm", "--stack-entries");
}

TEST_F(Accel, TheSceneMayChooseToo) {
    auto render = [&](const std::string& directive, const std::string& more = "") {
        write("a.pbrt", directive + "\n" + file_text(path("mesh.pbrt")));
        return alhazen("render a.pbrt --spp 2 -o b.pfm " + more);
    };
    ASSERT_EQ(alhazen("render mesh.pbrt --spp 2 -o a.pfm").exit_code, 0);
    for (const char* directive :
         {"Accelerator \"bvh\" \"string builder\" \"lbvh\" \"string walk\" \"stackless\"",
          "Accelerator \"bvh\" \"string splitmethod\" \"hlbvh\" \"integer maxnodeprims\" 2",
          "Accelerator \"kdtree\" \"integer maxprims\" 2 \"float emptybonus\" .3",
          "Accelerator \"kdtree\" \"string walk\" \"shortstack\" \"integer stackentries\" 1"}) {
        Outcome o = render(directive);
        ASSERT_EQ(o.exit_code, 0) << o.err;
        EXPECT_EQ(file_text(path("a.pfm")), file_text(path("b.pfm"))) << directive;
    }
    EXPECT_EQ(render("", "--set accelerator.walk=stackless").exit_code, 0);
    EXPECT_THAT(render("Accelerator \"bvh\" \"string walk\" \"stak\"").err,
                HasSubstr("a.pbrt:1:19: error: unknown walk \"stak\" (did you mean \"stack\"?)"));
    EXPECT_THAT(render("Accelerator \"bvh\" \"string builder\" \"lbhv\"").err,
                HasSubstr("did you mean \"lbvh\"?"));
    EXPECT_THAT(render("Accelerator \"bhv\"").err, HasSubstr("did you mean \"bvh\"?"));
    EXPECT_EQ(render("Accelerator \"bhv\"", "--lenient").exit_code, 0);
    EXPECT_THAT(render("Accelerator \"bvh\" \"integer stackentries\" 0").err, HasSubstr("stackentries"));
    EXPECT_THAT(render("", "--set accelerator.wlak=stack").err, HasSubstr("did you mean \"walk\"?"));
}

} // namespace
} // namespace alhazen::testing
