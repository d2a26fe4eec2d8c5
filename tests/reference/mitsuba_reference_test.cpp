/// Mitsuba's own render tests: small scenes with pictures whose variances are known, which Mitsuba compares
/// itself with by a z-test of each pixel. Here the scenes stand in our language (tests/reference/mitsuba),
/// and our pictures are compared with the same. The scenes lie beside the checkout, in ../shared; where they
/// are not there, the tests are skipped and say so.
///
/// Left out is what means something else in Mitsuba:
/// - rough plastic (it has no counterpart), Disney's principled materials, Beckmann's microfacets
///   (roughdielectric, textured_roughconductor, homo_roughdielectric_spot, four spheres of the grid);
/// - what normals of maps and bumps do near the outline of a sphere and, by a percent, elsewhere: Mitsuba
///   takes light away where the smooth surface would shade it (Estevez, Lecocq and Stellmach 2019, "A
///   microfacet-based shadowing function to solve the bump terminator problem"). normalmap_roughconductor,
///   whose normals lean further, is left out;
/// - homo_area_light, homo_emitter_inside_medium, homo_obj_inside_medium, surf_area_light: passing through a
///   thin dielectric is no bounce in Mitsuba, and what is inside is of rough plastic;
/// - hetero_sigmat_albedo multiplies two grids, which are blended each by itself;
/// - spectra that are made of coloured media's rgb values: there are several such for a colour.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "formats/format.h"
#include "image/codec.h"
#include "image/image_colors.h"
#include "math/special.h"
#include "render/renderer.h"
#include "tests/reference/mitsuba_files.h"

namespace alhazen::testing {
namespace {

namespace fs = std::filesystem;

const fs::path shared = fs::path(ALHAZEN_SOURCE_DIR) / "../shared/scenes/mitsuba";
constexpr int seeds = 32, spp = 8;
/// Samples a pixel of Mitsuba's pictures: the default of the program that makes them.
constexpr double reference_spp = 32000;

struct MitsubaScene {
    const char* scene;     ///< of tests/reference/mitsuba
    const char* reference; ///< folder and beginning of the names of its pictures
    std::vector<ColorMode> modes = {ColorMode::rgb, ColorMode::spectral};
    std::vector<Rect2i> left_out = {};
    /// How far the means differ by what is meant, at most.
    double known_difference = 0;
    /// Side in pixels, which divides those of the picture, of squares whose means are compared, too: for
    /// scenes whose lights make so much noise that single pixels say little. 1: none.
    int square = 1;

    bool leaves_out(int x, int y) const {
        return std::any_of(left_out.begin(), left_out.end(), [&](const Rect2i& r) {
            return x >= r.lo.x && x < r.hi.x && y >= r.lo.y && y < r.hi.y;
        });
    }
};

void PrintTo(const MitsubaScene& scene, std::ostream* out) {
    *out << scene.scene;
}

struct Pictures {
    std::vector<Image> ours; ///< one of each seed
    Image reference, variance;
};

Image in_xyz(Image image) {
    const RgbColorSpace& space = srgb_space();
    image = in_srgb(std::move(image)).to_rgb();
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) image.set_rgb(x, y, space.to_xyz(image.rgb(x, y)));
    return image;
}

std::string_view name_of(ColorMode mode) {
    return mode == ColorMode::rgb ? "rgb" : "spectral";
}

fs::path folder_of(const MitsubaScene& scene, ColorMode mode) {
    return fs::path(ALHAZEN_BINARY_DIR) / "mitsuba" / fmt::format("{}_{}", scene.scene, name_of(mode));
}

/// In XYZ, in which Mitsuba measures variances.
Pictures make_pictures(const MitsubaScene& scene, ColorMode mode) {
    const fs::path source =
        fmt::format("{}/tests/reference/mitsuba/{}.pbrt", ALHAZEN_SOURCE_DIR, scene.scene);
    RenderSettings settings;
    settings.spp = spp;
    settings.color = mode;
    Messages messages;
    const fs::path copy = copy_mitsuba_scene(source, shared, folder_of(scene, mode), mode);
    auto world = build_world(read_scene(copy, messages), settings, messages);
    Pictures pictures;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        world->seed = seed;
        world->sampler->prepare(world->film->resolution(), spp, seed);
        render(*world, settings, {});
        pictures.ours.push_back(in_xyz(world->film->image()));
    }
    const std::string reference =
        fmt::format("{}/tests/scenes/{}_ref_{}", shared.string(), scene.reference, name_of(mode));
    pictures.reference = in_xyz(read_image(reference + ".exr"));
    pictures.variance = in_xyz(read_image(reference + "_var.exr"));
    return pictures;
}

Image means_of_squares(const Image& image, int side) {
    Image means = Image::rgb_image(image.width() / side, image.height() / side);
    const float part = 1 / static_cast<float>(side * side);
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x)
            means.set_rgb(x / side, y / side, means.rgb(x / side, y / side) + image.rgb(x, y) * part);
    return means;
}

Pictures means_of_squares(const Pictures& pictures, int side) {
    Pictures means;
    for (const Image& image : pictures.ours) means.ours.push_back(means_of_squares(image, side));
    means.reference = means_of_squares(pictures.reference, side);
    means.variance = means_of_squares(pictures.variance, side);
    for (float& v : means.variance.values()) v /= static_cast<float>(side * side);
    return means;
}

struct Comparison {
    int values = 0;
    double largest_z = 0;
    Vec2i where;              ///< that is
    double mean_z2 = 0;       ///< by the noise that our seeds show
    double largest_own_z = 0; ///< the same
    Vec2i where_own;          ///< that is
    Vec3d mean_ratio;         ///< of ours over the reference's
    Vec3d mean_ratio_error;   ///< standard error, of ours
    Image sheet;              ///< ours, the reference, and |z| up to 6
};

Comparison compare(const MitsubaScene& scene, const Pictures& pictures) {
    const Image& reference = pictures.reference;
    const int width = reference.width(), height = reference.height();
    Comparison c;
    c.sheet = Image::rgb_image(3 * width + 8, height);
    Vec3d sum, reference_sum, variance_sum;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            Vec3d mean, squares;
            for (const Image& image : pictures.ours) {
                const Vec3d v(image.rgb(x, y));
                mean += v / seeds;
                squares += v * v;
            }
            const Vec3d expected(reference.rgb(x, y)), spread(pictures.variance.rgb(x, y));
            Vec3 mark;
            for (int i = 0; i < 3 && !scene.leaves_out(x, y); ++i) {
                const double own =
                    std::max(0.0, squares[i] - seeds * mean[i] * mean[i]) / (seeds - 1) / seeds;
                // What light is seldom found in a pixel may be in none of our samples; then Mitsuba's show
                // how seldom.
                const double samples = std::max(own, std::max(0.0, spread[i]) / (seeds * spp));
                // Tables and spectra made of colours differ by some thousandths.
                const double rounding = std::pow(3e-4 + 3e-3 * std::abs(expected[i]), 2);
                const double known = std::max(0.0, spread[i]) / reference_spp + rounding;
                const double difference = mean[i] - expected[i],
                             z = std::abs(difference) / std::sqrt(samples + known);
                if (z > c.largest_z) {
                    c.largest_z = z;
                    c.where = {x, y};
                }
                ++c.values;
                const double own_z = std::abs(difference) / std::sqrt(own + known);
                if (own_z > c.largest_own_z) {
                    c.largest_own_z = own_z;
                    c.where_own = {x, y};
                }
                c.mean_z2 += own_z * own_z;
                sum[i] += mean[i];
                reference_sum[i] += expected[i];
                variance_sum[i] += own;
                mark[i] = static_cast<float>(std::min(1.0, z / 6));
            }
            c.sheet.set_rgb(x, y, srgb_space().from_xyz(Vec3(mean)));
            c.sheet.set_rgb(x + width + 4, y, srgb_space().from_xyz(Vec3(expected)));
            c.sheet.set_rgb(x + 2 * width + 8, y, mark);
        }
    c.mean_z2 /= c.values;
    for (int i = 0; i < 3; ++i) {
        c.mean_ratio[i] = sum[i] / reference_sum[i];
        c.mean_ratio_error[i] = std::sqrt(variance_sum[i]) / reference_sum[i];
    }
    return c;
}

/// What none of so many values exceeds but for one time in a thousand: Sidak's correction, and Student's
/// distribution for the variance of few seeds (Fisher's series in powers of one over the degrees of freedom,
/// second order).
double largest_by_chance(int values) {
    const double beyond = -std::expm1(std::log1p(-1e-3) / values); // of one value, on both sides
    // Newton's method on the logarithm of the normal distribution's tail.
    double z = 4;
    for (int i = 0; i < 20; ++i) {
        const double tail = std::erfc(z / std::sqrt(2.0)),
                     density = std::sqrt(2 / M_PI) * std::exp(-z * z / 2);
        z += (std::log(tail) - std::log(beyond)) * tail / density;
    }
    constexpr double nu = seeds - 1;
    return z + (std::pow(z, 3) + z) / (4 * nu) +
           (5 * std::pow(z, 5) + 16 * std::pow(z, 3) + 3 * z) / (96 * nu * nu);
}

class MitsubaReference : public ::testing::TestWithParam<MitsubaScene> {};

TEST_P(MitsubaReference, LooksTheSame) {
    if (!fs::exists(shared)) GTEST_SKIP() << shared << " is not there";
    const MitsubaScene& scene = GetParam();
    for (const ColorMode mode : scene.modes) {
        SCOPED_TRACE(name_of(mode));
        const Pictures pictures = make_pictures(scene, mode);
        const Comparison c = compare(scene, pictures);
        write_image(folder_of(scene, mode) / "comparison.png", c.sheet);
        EXPECT_LT(c.largest_z, largest_by_chance(c.values)) << "at " << c.where.x << ", " << c.where.y;
        // Student's z squared is 1.07 on average; texels of the sky, which we do not blend, add to it.
        EXPECT_LT(c.mean_z2, scene.known_difference > 0 ? 2 : 1.7);
        for (int i = 0; i < 3; ++i)
            EXPECT_NEAR(c.mean_ratio[i], 1, 0.003 + scene.known_difference + 4 * c.mean_ratio_error[i])
                << "XYZ"[i];
        if (scene.square == 1) continue;
        // Own z: no light is so seldom found that it is in none of a square's samples.
        const Comparison s = compare(scene, means_of_squares(pictures, scene.square));
        EXPECT_LT(s.largest_own_z, largest_by_chance(s.values))
            << "in square " << s.where_own.x << ", " << s.where_own.y;
    }
}

/// The spheres that have no counterpart.
const std::vector<Rect2i> others{
    {{10, 10}, {19, 19}}, {{20, 10}, {29, 19}}, {{0, 20}, {9, 29}}, {{39, 10}, {48, 19}}};
/// All but the middle of a sphere.
const std::vector<Rect2i> rim{
    {{0, 0}, {48, 12}}, {{0, 36}, {48, 48}}, {{0, 12}, {12, 36}}, {{36, 12}, {48, 36}}};
const std::vector<ColorMode> both{ColorMode::rgb, ColorMode::spectral}, rgb{ColorMode::rgb};
const MitsubaScene scenes[] = {
    {"sphere_grid_panel", "bsdf_spheres/refs/test_arealight", both, others},
    {"sphere_grid_point", "bsdf_spheres/refs/test_pointlight", both, others},
    {"sphere_grid_constant", "bsdf_spheres/refs/test_constant", both, others},
    {"sphere_grid_museum", "bsdf_spheres/refs/test_envmap", both, others},
    {"wooden_sphere", "bsdf_spheres/refs/test_textured_diffuse"},
    {"bumped_sphere", "bsdf_spheres/refs/test_bumpmap", both, rim, 0.01},
    {"normal_mapped_sphere", "bsdf_spheres/refs/test_normalmap", both, rim, 0.01},
    {"brushed_sphere", "bsdf_spheres/refs/test_normalmap_identity_roughconductor"},
    {"directional", "floating_sphere/refs/test_directional"},
    {"mirrors", "infinite_mirrors/refs/scene"},
    {"instances", "instancing/refs/test_instancing"},
    {"orthographic", "orthographic_sensor/refs/test_orthographic"},
    {"emitters", "various_emitters/refs/test_various_emitters", both, {}, 0, 16},
    {"texels", "texture_interp/refs/test_texture_interp", both, {{{41, 0}, {87, 128}}}},
    {"milky_ball", "participating_media/refs/test_homo_null_envmap", rgb},
    {"coloured_ball", "participating_media/refs/test_homo_spectral_sigmat", rgb},
    {"glass_ball", "participating_media/refs/test_homo_dielectric_envmap", rgb},
    {"dark_box", "participating_media/refs/test_hetero_spectral_sigmat_no_scattering", rgb},
    {"smoke", "participating_media/refs/test_hetero_sigmat", rgb},
    {"coloured_smoke", "participating_media/refs/test_hetero_spectral_sigmat", rgb},
};
INSTANTIATE_TEST_SUITE_P(Scenes, MitsubaReference, ::testing::ValuesIn(scenes),
                         [](const auto& scene) { return std::string(scene.param.scene); });

} // namespace
} // namespace alhazen::testing
