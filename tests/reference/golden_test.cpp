/// Small renders against images kept beside this test, so that no change of the picture goes unseen. The
/// images were looked at when they were made; to make them anew after a change that is meant, run this test
/// with ALHAZEN_WRITE_GOLDEN=1 and look at them again.
#include <cstdlib>

#include <gtest/gtest.h>

#include "image/codec.h"
#include "image/metrics.h"
#include "tests/support/render_scene.h"

namespace alhazen::testing {
namespace {

struct Golden {
    std::string name, scene;
    Vec2i size;
    int spp;
    std::string integrator = {};
    ColorMode mode = ColorMode::spectral;
};

void PrintTo(const Golden& g, std::ostream* out) {
    *out << g.name;
}

class GoldenRender : public ::testing::TestWithParam<Golden> {};

// Compilers and processors may round sums differently, which moves a ray here and there over an edge: a
// relMSE of 1e-3 is far below the noise between two seeds (about 1e-1 at these sample counts).
TEST_P(GoldenRender, LooksAsItDid) {
    const Golden& g = GetParam();
    RenderSettings settings;
    settings.size = g.size;
    settings.spp = g.spp;
    settings.integrator = g.integrator;
    settings.color = g.mode;
    settings.seed = 1;
    std::filesystem::path source(ALHAZEN_SOURCE_DIR);
    Image ours = render_file(source / "scenes" / (g.scene + ".pbrt"), settings).image;
    std::filesystem::path file = source / "tests/reference/golden" / (g.name + ".exr");
    if (std::getenv("ALHAZEN_WRITE_GOLDEN")) write_image(file, ours);
    Image golden = read_image(file);
    EXPECT_LT(relmse(ours, golden).value, 1e-3);
    EXPECT_LT(flip(ours, golden).value, 0.01);
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, GoldenRender,
    ::testing::Values(Golden{"whitted_spheres", "whitted-spheres", {160, 120}, 1},
                      Golden{"nested_glass", "nested-glass", {120, 90}, 1},
                      Golden{"several_lights", "several-lights", {120, 90}, 1},
                      Golden{"whitted_supersampled", "whitted-spheres", {80, 60}, 16},
                      Golden{"materials_spectral", "materials", {96, 54}, 16},
                      Golden{"materials_rgb", "materials", {96, 54}, 16, "", ColorMode::rgb},
                      Golden{"materials_simplepath", "materials", {96, 54}, 16, "simplepath"},
                      Golden{"materials_occlusion", "materials", {96, 54}, 16, "ambientocclusion"}),
    [](const auto& test) { return test.param.name; });

} // namespace
} // namespace alhazen::testing
