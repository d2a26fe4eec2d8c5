/// What materials share: each file of measurements is read once, each table of light beneath surfaces
/// computed once, and nothing outlives the scene.
#include "materials/material_tables.h"

#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/threads.h"
#include "materials/bssrdf.h"
#include "materials/material_set.h"
#include "tests/support/measured_file.h"
#include "textures/texture_set.h"

namespace alhazen {

namespace {

using testing_support::MeasuredModel;

class MaterialTablesTest : public ::testing::Test {
  protected:
    MaterialTablesTest()
        : folder(std::filesystem::temp_directory_path() / ("alhazen-tables-" + std::to_string(getpid()))) {
        std::filesystem::create_directories(folder / "inner");
        MeasuredModel model;
        model.nodes = 8;
        model.thetas = 4;
        write_file(folder / "dim.bsdf", model.file());
        model.blue = model.red = 0.9f;
        write_file(folder / "bright.bsdf", model.file());
        write_file(folder / "bad.bsdf", "P6 512 512 255");
    }
    ~MaterialTablesTest() override { std::filesystem::remove_all(folder); }

    static Node node(const std::string& type, std::vector<Parameter> parameters, std::uint32_t line = 0) {
        Node node;
        node.type = type;
        for (Parameter& p : parameters) p.place.line = line;
        node.parameters = std::move(parameters);
        return node;
    }
    static Node measured(const std::string& file, std::uint32_t line = 0) {
        return node("measured", {make_string("filename", file)}, line);
    }
    static Node subsurface(float g, float eta) {
        return node("subsurface",
                    {make_float("reflectance", 0.7f), make_float("g", g), make_float("eta", eta)});
    }
    void build(const std::vector<Node>& nodes, MaterialSet& set) {
        BuildContext context{messages, ColorMode::rgb, folder};
        textures.build({}, context);
        set.build(nodes, context);
    }

    const std::filesystem::path folder;
    Messages messages;
    TextureSet textures;
};

TEST_F(MaterialTablesTest, AFileIsReadOnceForAMode) {
    MaterialTables tables;
    const auto dim = tables.measured(folder / "dim.bsdf", ColorMode::rgb);
    EXPECT_EQ(tables.measured(folder / "inner" / ".." / "dim.bsdf", ColorMode::rgb), dim);
    EXPECT_EQ(tables.made(), 1u);
    EXPECT_TRUE(dim->wavelengths.empty());
    const auto spectral = tables.measured(folder / "dim.bsdf", ColorMode::spectral);
    EXPECT_NE(spectral, dim);
    EXPECT_FALSE(spectral->wavelengths.empty());
    EXPECT_NE(tables.measured(folder / "bright.bsdf", ColorMode::rgb), dim);
    EXPECT_EQ(tables.made(), 3u);
}

TEST_F(MaterialTablesTest, MatterOfOneKindHasOneTable) {
    MaterialTables tables;
    const auto milk = tables.diffusion(0, 1.33f);
    EXPECT_EQ(tables.diffusion(0, 1.33f), milk);
    EXPECT_EQ(tables.made(), 1u);
    const auto forward = tables.diffusion(0.5f, 1.33f), dense = tables.diffusion(0, 1.5f);
    EXPECT_NE(forward, milk);
    EXPECT_NE(dense, milk);
    EXPECT_EQ(dense->eta(), 1.5f);
    EXPECT_GT(forward->radii().back(), milk->radii().back());
    EXPECT_EQ(tables.made(), 3u);
}

TEST_F(MaterialTablesTest, MaterialsOfASetShareThem) {
    const std::vector<Node> nodes{measured("dim.bsdf"),
                                  measured("bright.bsdf"),
                                  measured("inner/../dim.bsdf"),
                                  node("subsurface", {}),
                                  node("subsurface", {make_string("name", "Skin1")}),
                                  subsurface(0.5f, 1.33f),
                                  subsurface(0.5f, 1.33f)};
    MaterialSet set;
    EXPECT_EQ(set.tables(), nullptr);
    build(nodes, set);
    ASSERT_EQ(messages.error_count(), 0u);
    EXPECT_EQ(set.tables()->made(), 4u);
    // Another scene has its own.
    const auto old = set.tables();
    build({measured("dim.bsdf")}, set);
    EXPECT_NE(set.tables(), old);
    EXPECT_EQ(set.tables()->made(), 1u);
}

TEST_F(MaterialTablesTest, DieWithTheScene) {
    std::weak_ptr<const MeasuredData> data;
    std::weak_ptr<const DiffusionTable> table;
    {
        MaterialSet set;
        build({measured("dim.bsdf"), subsurface(0, 1.4f)}, set);
        data = set.tables()->measured(folder / "dim.bsdf", ColorMode::rgb);
        table = set.tables()->diffusion(0, 1.4f);
        EXPECT_EQ(set.tables()->made(), 2u);
        EXPECT_FALSE(data.expired() || table.expired());
    }
    EXPECT_TRUE(data.expired());
    EXPECT_TRUE(table.expired());
}

TEST_F(MaterialTablesTest, ABadFileIsAnErrorOfEachMaterialThatNamesIt) {
    MaterialSet set;
    build(
        {measured("bad.bsdf", 3), measured("dim.bsdf", 5), measured("bad.bsdf", 8), measured("none.bsdf", 9)},
        set);
    ASSERT_EQ(messages.error_count(), 3u);
    const std::string text = "measured BSDF file \"bad.bsdf\": not a tensor file; expected \"tensor_file\"";
    for (std::size_t i : {0u, 1u}) EXPECT_EQ(messages.list()[i].text, text);
    EXPECT_EQ(messages.list()[0].place.line, 3);
    EXPECT_EQ(messages.list()[1].place.line, 8);
    EXPECT_EQ(messages.list()[2].text, "measured BSDF file \"none.bsdf\": no such file");
    EXPECT_NE(set.at(1), nullptr);
    EXPECT_EQ(set.tables()->made(), 1u);
}

// Many materials of few keys on few threads, some of which then wait for others.
TEST_F(MaterialTablesTest, ThreadsMakeEachOnceAndTheSame) {
    std::vector<Node> nodes;
    for (int i = 0; i < 16; ++i) {
        nodes.push_back(measured(i % 2 ? "dim.bsdf" : "inner/../dim.bsdf"));
        nodes.push_back(measured("bright.bsdf"));
        nodes.push_back(subsurface(0.3f, 1.3f));
        nodes.push_back(subsurface(-0.3f, 1.3f));
    }
    MaterialSet alone, together;
    with_threads(1, [&] { build(nodes, alone); });
    with_threads(4, [&] { build(nodes, together); });
    ASSERT_EQ(messages.error_count(), 0u);
    EXPECT_EQ(alone.tables()->made(), 4u);
    EXPECT_EQ(together.tables()->made(), 4u);
    Arena arena;
    Hit hit;
    hit.ng = hit.ns = {0, 0, 1};
    hit.dpdu = {1, 0, 0};
    Wavelengths rgb = Wavelengths::rgb();
    const Vec3 wo = normalize(Vec3(0.5f, 0.2f, 0.7f)), wi = normalize(Vec3(-0.3f, 0.1f, 0.8f));
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        auto value = [&](const MaterialSet& set) {
            const Material& m = *set.at(i);
            return m.has_subsurface() ? m.subsurface(hit, rgb, arena)->eval(0.2f)
                                      : m.at(hit, rgb, arena)->eval(wo, wi).f;
        };
        EXPECT_EQ(value(together), value(alone)) << i;
        EXPECT_FALSE(value(alone).is_black()) << i;
    }
}

} // namespace

} // namespace alhazen
