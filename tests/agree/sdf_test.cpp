/// Bodies that are met by sphere tracing look like those whose equations are solved, and like themselves on
/// any number of threads.
#include <gtest/gtest.h>

#include "tests/support/render_scene.h"

namespace alhazen::testing {
namespace {

RenderSettings small() {
    RenderSettings settings;
    settings.size = Vec2i{200, 150};
    return settings;
}

TEST(SdfAgreement, WhittedsSpheresAsSdfsGiveTheSamePicture) {
    Image spheres = render_file(ALHAZEN_SOURCE_DIR "/scenes/whitted-spheres.pbrt", small()).image;
    Image fields = render_file(ALHAZEN_SOURCE_DIR "/scenes/sdf-spheres.pbrt", small()).image;
    ASSERT_EQ(spheres.size(), fields.size());
    EXPECT_GT(mean_of(spheres, 2), 0.1);
    float most = 0;
    for (int y = 0; y < spheres.height(); ++y)
        for (int x = 0; x < spheres.width(); ++x)
            most = std::max(most, max_component(abs(spheres.rgb(x, y) - fields.rgb(x, y))));
    EXPECT_LE(most, 1e-3f);
}

TEST(SdfAgreement, ThreadsDoNotChangeABit) {
    RenderSettings settings;
    settings.size = Vec2i{60, 40};
    settings.spp = 2;
    std::string file = ALHAZEN_SOURCE_DIR "/scenes/sdf-still-life.pbrt";
    settings.threads = 1;
    Image one = render_file(file, settings).image;
    settings.threads = 3;
    settings.paths_in_flight = 1;
    Image three = render_file(file, settings).image;
    auto a = one.values(), b = three.values();
    ASSERT_EQ(a.size(), b.size());
    EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size_bytes()), 0);
    EXPECT_GT(mean_of(one, 0), 0.05);
}

} // namespace
} // namespace alhazen::testing
