/// Real scenes against images that pbrt-v4 rendered of them. The scenes lie beside the checkout, in
/// ../shared; where they are not there, the tests are skipped and say so.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "image/codec.h"
#include "image/metrics.h"
#include "image/resample.h"
#include "tests/support/render_scene.h"

namespace alhazen::testing {
namespace {

// relMSE of two images, each reduced to blocks: noise falls with the block's area, a wrong picture does not.
double reduced_relmse(const Image& a, const Image& b, int block) {
    int w = a.width() / block, h = a.height() / block;
    return relmse(resample_box(a, w, h), resample_box(b, w, h)).value;
}

TEST(PbrtReference, CornellBox) {
    std::filesystem::path folder =
        std::filesystem::path(ALHAZEN_SOURCE_DIR) / "../shared/scenes/pbrt/cornell-box";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there";
    RenderSettings settings;
    settings.integrator = "path"; // the scene has no media
    settings.spp = 16;
    Image ours = render_file(folder / "scene.pbrt", settings).image;
    Image reference = read_image(folder / "reference.exr");
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(mean_of(ours, c) / mean_of(reference, c), 1, 0.005) << "channel " << c;
    // At 16 samples pbrt-v4 itself is at 0.014 on full pixels; blocks of 8 x 8 leave a 64th of the noise.
    EXPECT_LT(relmse(ours, reference).value, 0.025);
    EXPECT_LT(reduced_relmse(ours, reference, 8), 0.0008);
    std::filesystem::create_directories(ALHAZEN_BINARY_DIR "/pictures");
    write_image(ALHAZEN_BINARY_DIR "/pictures/cornell-box.png", ours);
    write_image(ALHAZEN_BINARY_DIR "/pictures/cornell-box-difference.png",
                heat_map(flip(ours, reference).error));
}

} // namespace
} // namespace alhazen::testing
