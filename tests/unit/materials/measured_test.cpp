/// Measured materials: files made of an analytic model give that model back.
#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/hash.h"
#include "color/spectrum_value.h"
#include "materials/material_set.h"
#include "math/warp.h"
#include "tests/support/measured_file.h"
#include "textures/texture_set.h"

namespace alhazen {

namespace {

using testing_support::MeasuredModel;

class MeasuredTest : public ::testing::Test {
  protected:
    MeasuredTest()
        : path_(std::filesystem::temp_directory_path() / ("alhazen-measured-" + std::to_string(getpid()))) {}
    ~MeasuredTest() override { std::filesystem::remove(path_); }

    const Material* material(const std::string& file, ColorMode mode = ColorMode::spectral) {
        write_file(path_, file);
        Node node;
        node.type = "measured";
        node.parameters = {make_string("filename", path_.string())};
        BuildContext context{messages, mode};
        textures.build({}, context);
        set.build({node}, context);
        return set.at(0);
    }
    const Bsdf& bsdf(const MeasuredModel& model, Wavelengths lambda = Wavelengths::sample_visible(0.3f)) {
        const Material* m = material(model.file(), lambda.mode);
        EXPECT_TRUE(m && messages.list().empty());
        Hit hit;
        hit.ng = hit.ns = {0, 0, 1};
        hit.dpdu = {1, 0, 0};
        return *m->at(hit, lambda, arena);
    }

    Messages messages;
    TextureSet textures;
    MaterialSet set;
    Arena arena;

  private:
    std::filesystem::path path_;
};

// Mean and largest error over directions, of the model's mean value there. wo stays away from the horizon,
// where tables of a few angles say little.
struct Errors {
    double mean = 0, largest = 0;
};
Errors errors_of(const Bsdf& bsdf, const MeasuredModel& model, Spectrum reflectance) {
    Rng rng(1);
    double sum = 0, total = 0, largest = 0;
    constexpr int n = 4000;
    for (int i = 0; i < n; ++i) {
        auto direction = [&](float lowest) {
            const float z = lerp(rng.uniform(), lowest, 1.0f), phi = 2 * pi * rng.uniform();
            return Vec3(safe_sqrt(1 - z * z) * std::cos(phi), safe_sqrt(1 - z * z) * std::sin(phi), z);
        };
        const Vec3 wo = direction(0.3f), wi = direction(0.1f);
        const Spectrum found = bsdf.eval(wo, wi).f, wanted = reflectance * model.reflected(wo, wi);
        for (int lane = 0; lane < 4; ++lane) {
            const auto error = static_cast<double>(std::abs(found[lane] - wanted[lane]));
            sum += error;
            total += static_cast<double>(wanted[lane]);
            largest = std::max(largest, error);
        }
    }
    return {sum / total, largest * 4 * n / total};
}

Spectrum reflectance_at(const MeasuredModel& model, const Wavelengths& lambda) {
    return map(lambda.lambda, [&](float l) { return model.reflectance(std::clamp(l, 400.0f, 700.0f)); });
}

TEST_F(MeasuredTest, IsotropicDataGiveTheirModel) {
    MeasuredModel model;
    model.nodes = 64;
    model.thetas = 24;
    const Wavelengths lambda = Wavelengths::sample_visible(0.3f);
    const Errors errors = errors_of(bsdf(model, lambda), model, reflectance_at(model, lambda));
    EXPECT_LT(errors.mean, 0.01);
    EXPECT_LT(errors.largest, 0.1);
}

// Azimuths between the measured ones are blended, so this is coarser; towards the horizon the peak is several
// times the mean.
TEST_F(MeasuredTest, AnisotropicDataGiveTheirModel) {
    MeasuredModel model;
    model.facets = {0.4f, 0.7f};
    model.phis = 33;
    model.thetas = 12;
    const Wavelengths lambda = Wavelengths::sample_visible(0.8f);
    const Errors errors = errors_of(bsdf(model, lambda), model, reflectance_at(model, lambda));
    EXPECT_LT(errors.mean, 0.02);
    EXPECT_LT(errors.largest, 0.7);
}

// Where the file says so, the tables hold the reflection whole.
TEST_F(MeasuredTest, FacetFactorMayBeInTheTables) {
    MeasuredModel model;
    model.nodes = 96;
    model.thetas = 24;
    model.has_facet_factor = false;
    const Wavelengths lambda = Wavelengths::sample_visible(0.3f);
    EXPECT_LT(errors_of(bsdf(model, lambda), model, reflectance_at(model, lambda)).mean, 0.03);
}

// The colour is that of the reflectance's curve, by the same rule as for any other spectrum.
TEST_F(MeasuredTest, RgbModeHasTheCurvesColor) {
    MeasuredModel model;
    const std::vector<float> pairs{360, model.reflectance(400), 400, model.reflectance(400),
                                   700, model.reflectance(700), 830, model.reflectance(700)};
    const Spectrum color =
        SpectrumValue::curve(std::make_shared<const SpectralCurve>(SpectralCurve::from_pairs(pairs)),
                             SpectrumRole::albedo)
            .eval(Wavelengths::rgb());
    const Vec3 wo = normalize(Vec3(0.4f, 0.1f, 0.8f)), wi = normalize(Vec3(-0.3f, 0.2f, 0.7f));
    const Spectrum f = bsdf(model, Wavelengths::rgb()).eval(wo, wi).f;
    for (int c = 1; c < 4; ++c) EXPECT_NEAR(f[c] / f[0], color[c] / color[0], 1e-3f) << c;
    EXPECT_NEAR(f[0], color[0] * model.reflected(wo, wi), 0.1f * f[0]);
}

// The weights' mean is the model's albedo, here by the midpoint rule, and they hardly scatter.
TEST_F(MeasuredTest, SamplesFollowTheReflection) {
    MeasuredModel model;
    model.blue = model.red = 0.9f;
    const Bsdf& b = bsdf(model);
    const Vec3 wo = normalize(Vec3(0.5f, 0.2f, 0.7f));
    constexpr int n = 200, samples = 4000;
    double albedo = 0;
    for (int i = 0; i < n * n; ++i) {
        const Vec2 u(static_cast<float>(i / n) + 0.5f, static_cast<float>(i % n) + 0.5f);
        albedo +=
            static_cast<double>(0.9f * model.reflected(wo, sample_hemisphere(u / n)) * 2 * pi) / (n * n);
    }
    Rng rng(3);
    double sum = 0, sum2 = 0;
    for (int i = 0; i < samples; ++i) {
        const float u = rng.uniform(), x = rng.uniform();
        const auto s = b.sample(wo, u, {x, rng.uniform()});
        const double weight = s ? static_cast<double>(s->f[0] / s->pdf) : 0;
        sum += weight / samples;
        sum2 += weight * weight / samples;
    }
    EXPECT_NEAR(sum, albedo, 0.01);
    EXPECT_LT(std::sqrt(sum2 - sum * sum), 0.1);
}

TEST_F(MeasuredTest, ErrorsNameTheFileAndTheField) {
    std::vector<testing_support::FieldToWrite> fields = MeasuredModel{}.fields();
    std::erase_if(fields, [](const auto& f) { return f.name == "vndf"; });
    EXPECT_EQ(material(testing_support::tensor_file(fields)), nullptr);
    ASSERT_EQ(messages.list().size(), 1u);
    EXPECT_THAT(messages.list()[0].text, ::testing::StartsWith("measured BSDF file \""));
    EXPECT_THAT(messages.list()[0].text, ::testing::EndsWith("\": field \"vndf\" is missing"));
}

TEST(Measured, MissingFile) {
    Messages messages;
    Node node;
    node.type = "measured";
    node.parameters = {make_string("filename", "no-such.bsdf")};
    BuildContext context{messages, ColorMode::rgb, "/"};
    EXPECT_EQ(material_kinds().make(node, context, ""), nullptr);
    EXPECT_EQ(messages.list()[0].text, "measured BSDF file \"no-such.bsdf\": no such file");
}

} // namespace

} // namespace alhazen
