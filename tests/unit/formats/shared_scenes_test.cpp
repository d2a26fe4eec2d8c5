/// Real scenes, read and counted against what their README says was exported.
#include <map>
#include <regex>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/file.h"
#include "formats/format.h"
#include "formats/ply.h"

namespace alhazen {
namespace {

using Counts = std::map<std::string, int>;

std::filesystem::path scenes_folder() {
    return std::filesystem::path(ALHAZEN_SOURCE_DIR).parent_path() / "shared" / "scenes" / "pbrt";
}

/// The line "- what {'name': count, ...}" of a README.
Counts counts_in(const std::string& readme, const std::string& what) {
    std::smatch line;
    Counts counts;
    if (!std::regex_search(readme, line, std::regex("- " + what + " \\{(.*)\\}"))) return counts;
    std::string list = line[1];
    std::regex entry("'([^']+)': (\\d+)");
    for (std::sregex_iterator i(list.begin(), list.end(), entry), end; i != end; ++i)
        counts[(*i)[1]] = std::stoi((*i)[2]);
    return counts;
}

std::size_t triangles_of(const ShapeNode& shape, const std::filesystem::path& folder) {
    if (const Parameter* indices = shape.node.find("indices")) return indices->count() / 3;
    const auto& name = std::get<std::vector<std::string>>(shape.node.find("filename")->values).front();
    MeshData mesh = read_ply(folder / name);
    return mesh.triangle_count() + 2 * mesh.quad_count();
}

class SharedScene : public testing::TestWithParam<std::string> {};

TEST_P(SharedScene, IsReadWhole) {
    std::filesystem::path folder = scenes_folder() / GetParam();
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "the shared scenes are not at " << folder;
    Messages messages;
    SceneDescription scene = read_scene(folder / "scene.pbrt", messages);
    EXPECT_TRUE(messages.list().empty());

    std::string readme = read_file(folder / "README.md");
    Counts shapes, materials, lights, textures;
    std::size_t triangles = 0;
    auto count_shapes = [&](const ObjectNode& object) {
        for (const ShapeNode& shape : object.shapes) {
            ++shapes[shape.node.type];
            triangles += triangles_of(shape, folder);
        }
    };
    count_shapes(scene.world);
    for (const ObjectNode& object : scene.objects) count_shapes(object);
    for (const Node& material : scene.materials) ++materials[material.type];
    for (const LightNode& light : scene.lights) ++lights[light.node.type];
    for (const Node& light : scene.area_lights) ++lights["area " + light.type];
    for (const TextureNode& texture : scene.textures)
        ++textures[texture.node.type + (texture.is_spectrum ? " (spectrum)" : " (float)")];

    EXPECT_EQ(shapes, counts_in(readme, "shapes"));
    EXPECT_EQ(materials, counts_in(readme, "materials"));
    EXPECT_EQ(lights, counts_in(readme, "lights"));
    EXPECT_EQ(textures, counts_in(readme, "textures"));
    std::smatch declared;
    ASSERT_TRUE(std::regex_search(readme, declared, std::regex("- triangles (\\d+)")));
    EXPECT_EQ(triangles, std::stoull(declared[1]));
}

INSTANTIATE_TEST_SUITE_P(Pbrt, SharedScene,
                         testing::Values("coffee", "cornell-box", "kitchen", "living-room-2",
                                         "material-testball", "menger", "staircase", "teapot-cloud",
                                         "veach-ajar", "veach-bidir"),
                         [](const auto& scene) {
                             std::string name = scene.param;
                             for (char& c : name)
                                 if (c == '-') c = '_';
                             return name;
                         });

TEST(SharedScenes, MengerIsInstanced) {
    std::filesystem::path folder = scenes_folder() / "menger";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "the shared scenes are not at " << folder;
    Messages messages;
    SceneDescription scene = read_scene(folder / "scene.pbrt", messages);
    ASSERT_THAT(scene.objects, testing::SizeIs(1));
    EXPECT_THAT(scene.objects[0].shapes, testing::SizeIs(20));
    EXPECT_EQ(scene.world.instances.size(), 20u * 20 * 20);
}

TEST(SharedScenes, TheCloudsDensitiesAreAllThere) {
    std::filesystem::path folder = scenes_folder() / "teapot-cloud";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "the shared scenes are not at " << folder;
    Messages messages;
    SceneDescription scene = read_scene(folder / "scene.pbrt", messages);
    ASSERT_THAT(scene.media, testing::SizeIs(1));
    EXPECT_EQ(scene.media[0].node.find("density")->count(), 134u * 67u * 89u);
}

} // namespace
} // namespace alhazen
