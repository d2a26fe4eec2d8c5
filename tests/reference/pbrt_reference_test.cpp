/// Real scenes against images that pbrt-v4 rendered of them: few samples, compared by means and by blocks of
/// pixels with the noise of both images known (see lab/reference_comparison.h; make validate is the long
/// form). The scenes lie beside the checkout, in ../shared; where they are not there, the tests are skipped
/// and say so.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "benchmarks/validation/facts.h"
#include "image/codec.h"
#include "lab/reference_comparison.h"

namespace alhazen::testing {
namespace {

const std::filesystem::path scenes = std::filesystem::path(ALHAZEN_SOURCE_DIR) / "../shared/scenes/pbrt";

struct QuickLook {
    const char* scene;
    int spp; ///< of each of four seeds
};

void PrintTo(const QuickLook& look, std::ostream* out) {
    *out << look.scene;
}

/// Of the means, by design; 0: none.
double known_difference(std::string_view scene) {
    for (const bench::SceneFacts& facts : bench::validation_scenes())
        if (facts.name == scene) return facts.known_difference;
    throw std::runtime_error(fmt::format("validation does not know of \"{}\"", scene));
}

class PbrtReference : public ::testing::TestWithParam<QuickLook> {};

TEST_P(PbrtReference, LooksTheSame) {
    const std::filesystem::path folder = scenes / GetParam().scene;
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there";
    ReferenceComparisonOptions options;
    options.seeds = 4;
    options.spp = GetParam().spp;
    const ReferenceComparison c = compare_with_reference(folder, options);
    const double design = known_difference(c.scene);
    for (std::size_t i = 0; i < 3; ++i) {
        // Half a percent; where few samples cannot tell so much, four standard errors.
        const double noise = 4 * c.mean_ratio_error[i];
        EXPECT_NEAR(c.mean_ratio[i], 1, design > 0 ? design + noise : std::max(0.005, noise))
            << "channel " << i;
    }
    // The variance of four seeds has three degrees of freedom: z squared is 3 on average.
    EXPECT_LT(c.mean_z2, design > 0 ? bench::largest_known_z2 : 6);
    // What noise does not explain of the error, against what it does.
    EXPECT_LT(c.unexplained, 0.25 * (c.noise / c.seeds + c.reference_noise));
    std::filesystem::create_directories(ALHAZEN_BINARY_DIR "/pictures");
    write_image(fmt::format("{}/pictures/{}.png", ALHAZEN_BINARY_DIR, c.scene), side_by_side(c));
}

INSTANTIATE_TEST_SUITE_P(Scenes, PbrtReference,
                         ::testing::Values(QuickLook{"cornell-box", 8}, QuickLook{"menger", 4},
                                           QuickLook{"teapot-cloud", 2}, QuickLook{"veach-bidir", 2},
                                           QuickLook{"coffee", 8}, QuickLook{"material-testball", 4},
                                           QuickLook{"staircase", 8}, QuickLook{"living-room-2", 8},
                                           QuickLook{"kitchen", 8}, QuickLook{"veach-ajar", 32}),
                         [](const auto& scene) {
                             std::string name = scene.param.scene;
                             std::erase(name, '-');
                             return name;
                         });

} // namespace
} // namespace alhazen::testing
