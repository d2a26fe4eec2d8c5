/// The Whitted integrator against an independent implementation: a GNU Octave script in double precision,
/// written from the equations. The float renderer may differ by more than 1e-3 in at most 0.1 % of the
/// pixels, and only on silhouettes and shadow edges, which the script marks.
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "image/codec.h"
#include "tests/support/render_scene.h"

namespace alhazen::testing {
namespace {

// A binary PGM of bytes.
std::vector<char> read_mask(const std::filesystem::path& file, int width, int height) {
    std::ifstream in(file, std::ios::binary);
    std::string magic;
    int w = 0, h = 0, max = 0;
    in >> magic >> w >> h >> max;
    in.get();
    EXPECT_EQ(magic, "P5");
    EXPECT_EQ(w, width);
    EXPECT_EQ(h, height);
    std::vector<char> mask(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    in.read(mask.data(), static_cast<std::streamsize>(mask.size()));
    return mask;
}

class WhittedOracle : public ::testing::TestWithParam<const char*> {};

TEST_P(WhittedOracle, DiffersOnlyOnEdges) {
    if (std::system("command -v octave-cli > /dev/null 2>&1") != 0)
        GTEST_SKIP() << "GNU Octave is not installed";
    std::filesystem::path source(ALHAZEN_SOURCE_DIR), folder(ALHAZEN_BINARY_DIR "/oracle");
    std::filesystem::create_directories(folder);
    std::filesystem::path scene = source / "scenes" / (std::string(GetParam()) + ".pbrt");
    std::filesystem::path picture = folder / (std::string(GetParam()) + ".pfm");
    std::filesystem::path mask_file = folder / (std::string(GetParam()) + ".pgm");
    std::string command =
        fmt::format("cd '{}' && octave-cli --norc '{}' '{}' '{}' '{}' > '{}' 2>&1", folder.string(),
                    (source / "tests/oracle/whitted_oracle.m").string(), scene.string(), picture.string(),
                    mask_file.string(), (folder / "log.txt").string());
    ASSERT_EQ(std::system(command.c_str()), 0) << "see " << folder / "log.txt";

    Image oracle = read_image(picture);
    Image ours = render_file(scene).image;
    ASSERT_EQ(ours.size(), oracle.size());
    std::vector<char> mask = read_mask(mask_file, ours.width(), ours.height());
    int off = 0, off_edges = 0;
    for (int y = 0; y < ours.height(); ++y)
        for (int x = 0; x < ours.width(); ++x) {
            if (max_component(abs(ours.rgb(x, y) - oracle.rgb(x, y))) <= 1e-3f) continue;
            ++off;
            if (!mask[static_cast<std::size_t>(y * ours.width() + x)]) ++off_edges;
        }
    double share = static_cast<double>(off) / (static_cast<double>(ours.width()) * ours.height());
    RecordProperty("pixels_off_percent", fmt::format("{:.4f}", share * 100));
    EXPECT_LE(share, 0.001);
    EXPECT_EQ(off_edges, 0);
}

INSTANTIATE_TEST_SUITE_P(Scenes, WhittedOracle,
                         ::testing::Values("whitted-spheres", "nested-glass", "several-lights"),
                         [](const auto& test) {
                             std::string name = test.param;
                             for (char& c : name)
                                 if (c == '-') c = '_';
                             return name;
                         });

} // namespace
} // namespace alhazen::testing
