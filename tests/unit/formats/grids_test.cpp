/// Grid files: what is written is read back, and what is broken is refused.

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/file.h"
#include "formats/grids.h"

namespace alhazen {
namespace {

using ::testing::HasSubstr;

std::filesystem::path temporary(const std::string& name) {
    return std::filesystem::path(::testing::TempDir()) / ("alhazen_grids_" + name);
}

// The distance from a ball, in cells of a quarter.
GridData ball() {
    GridData data;
    data.hi = {18, 20, 17};
    data.background = 0.75f;
    data.object_from_index = Matrix4::translate({-2, 1, 3}) * Matrix4::scale({0.25, 0.25, 0.25});
    for (int z = 0; z <= 17; z += 8)
        for (int y = 0; y <= 20; y += 8)
            for (int x = 0; x <= 18; x += 8) {
                GridBrick& b = data.bricks.emplace_back();
                b.origin = {x, y, z};
                for (int i = 0; i < 512; ++i) {
                    Vec3d p{x + static_cast<double>(i & 7), y + static_cast<double>(i >> 3 & 7),
                            z + static_cast<double>(i >> 6)};
                    b.values[static_cast<std::size_t>(i)] =
                        static_cast<float>(0.25 * (length(p - Vec3d{9, 10, 8}) - 6));
                }
            }
    return data;
}

float sample(const GridData& data, Vec3i p) {
    for (const GridBrick& b : data.bricks)
        if (b.origin == Vec3i{brick_origin(p.x), brick_origin(p.y), brick_origin(p.z)})
            return b.values[GridBrick::at(p.x & 7, p.y & 7, p.z & 7)];
    return data.background;
}

void expect_same(const GridData& a, const GridData& b, float limit) {
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 4; ++j)
            EXPECT_NEAR(a.object_from_index.m[i][j], b.object_from_index.m[i][j], 1e-6);
    for (int z = 0; z <= 17; ++z)
        for (int y = 0; y <= 20; ++y)
            for (int x = 0; x <= 18; ++x)
                ASSERT_EQ(std::clamp(sample(a, {x, y, z}), -limit, limit), sample(b, {x, y, z}));
}

std::string error_of(const std::filesystem::path& file, const std::string& grid = "") {
    try {
        read_grid(file, grid);
    } catch (const std::runtime_error& e) {
        return e.what();
    }
    return "read without an error";
}

TEST(GridFiles, VolumesAreReadAsTheyWereWritten) {
    auto file = temporary("ball.vol");
    write_grid(file, ball());
    GridData back = read_grid(file, "");
    EXPECT_EQ(back.hi, (Vec3i{18, 20, 17}));
    expect_same(ball(), back, 1e9f);
    // The first bytes, as Mitsuba 3 documents them.
    std::string bytes = read_file(file);
    EXPECT_EQ(bytes.substr(0, 12), std::string("VOL\3\1\0\0\0\x13\0\0\0", 12));
    EXPECT_EQ(bytes.size(), 48u + 4u * 19u * 21u * 18u);
}

TEST(GridFiles, BrokenVolumesAreRefused) {
    auto file = temporary("broken.vol");
    write_grid(file, ball());
    const std::string good = read_file(file);
    auto with = [&](std::size_t at, const std::string& bytes) {
        std::string bad = good;
        bad.replace(at, bytes.size(), bytes);
        write_file(file, bad);
        return error_of(file);
    };
    EXPECT_THAT(with(0, "vol"), HasSubstr("VOL"));
    EXPECT_THAT(with(3, "\2"), HasSubstr("version 2"));
    EXPECT_THAT(with(4, "\2"), HasSubstr("type 2"));
    EXPECT_THAT(with(8, std::string("\0", 1)), HasSubstr("samples along x"));
    EXPECT_THAT(with(8, "\x14"), HasSubstr("bytes for"));
    EXPECT_THAT(with(19, "\x7f"), HasSubstr("samples along z"));
    EXPECT_THAT(with(20, "\3"), HasSubstr("3 channels"));
    EXPECT_THAT(with(24, std::string("\0\0\x80\x7f", 4)), HasSubstr("bounding box"));
    EXPECT_THAT(with(48, std::string("\0\0\xc0\x7f", 4)), HasSubstr("not a finite number"));
    write_file(file, good.substr(0, 20));
    EXPECT_THAT(error_of(file), HasSubstr("VOL"));
    write_file(file, good.substr(0, good.size() - 1));
    EXPECT_THAT(error_of(file), HasSubstr("bytes for"));
    EXPECT_THAT(error_of(temporary("absent.vol")), HasSubstr("no such file"));
    EXPECT_THAT(error_of(temporary("grid.raw")), HasSubstr("unknown suffix"));
}

// The command can be pasted, whatever the file is called.
TEST(GridFiles, OpenVdbFilesAreToldHowToConvert) {
    const std::string text =
        has_nanovdb() ? "it is an OpenVDB file, which is not read; a NanoVDB file is, and this command "
                        "(Debian's package libnanovdb-tools) makes one of it: nanovdb_convert "
                      : "it is an OpenVDB file, which is not read; a NanoVDB file is by programs built with "
                        "NanoVDB (package libnanovdb-dev), and this command (Debian's package "
                        "libnanovdb-tools) makes one of it: nanovdb_convert ";
    EXPECT_EQ(error_of("clouds/wisp.vdb"), text + "clouds/wisp.vdb clouds/wisp.nvdb");
    EXPECT_EQ(error_of("WISP.2.VDB", "density"), text + "WISP.2.VDB WISP.2.nvdb");
    EXPECT_EQ(error_of("a wisp.vdb"), text + "'a wisp.vdb' 'a wisp.nvdb'");
    EXPECT_EQ(error_of("Ann's$.vdb"), text + R"('Ann'\''s$.vdb' 'Ann'\''s$.nvdb')");
}

TEST(GridFiles, LevelSetsAreReadAsTheyWereWritten) {
    auto file = temporary("ball.nvdb");
    if (!has_nanovdb()) {
        EXPECT_THAT(error_of(file), HasSubstr("without"));
        GTEST_SKIP() << "built without NanoVDB";
    }
    write_grid(file, ball());
    GridData back = read_grid(file, "surface");
    EXPECT_TRUE(back.is_level_set);
    EXPECT_FLOAT_EQ(back.background, 0.75f);
    expect_same(ball(), back, 0.75f);
    EXPECT_THAT(error_of(file, "density"), HasSubstr("there are \"surface\""));
    std::string bytes = read_file(file);
    for (std::size_t cut : {std::size_t{3}, std::size_t{40}, bytes.size() / 2, bytes.size() - 3}) {
        write_file(file, bytes.substr(0, cut));
        EXPECT_NE(error_of(file), "read without an error") << cut;
    }
}

TEST(GridFiles, FogHasNoSurface) {
    std::filesystem::path file(ALHAZEN_SOURCE_DIR "/../shared/scenes/volumes/usd_densityAndHeat.nvdb");
    if (!has_nanovdb() || !std::filesystem::exists(file))
        GTEST_SKIP() << "needs NanoVDB and the shared scenes";
    GridData data = read_grid(file, "density");
    EXPECT_FALSE(data.bricks.empty());
    for (const GridBrick& b : data.bricks)
        for (float v : b.values) ASSERT_GE(v, 0);
}

} // namespace
} // namespace alhazen
