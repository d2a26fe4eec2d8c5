#include "color/wavelengths.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "base/hash.h"
#include "color/camera_curves.h"
#include "color/color_space.h"
#include "color/spectral.h"

namespace alhazen {
namespace {

double integral_of_pdf(double from, double to) {
    constexpr int steps = 200;
    double sum = 0, width = (to - from) / steps;
    for (int i = 0; i < steps; ++i)
        sum += visible_wavelength_pdf(static_cast<float>(from + (i + 0.5) * width)) * width;
    return sum;
}

TEST(Wavelengths, VisibleDensityIntegratesToOne) {
    EXPECT_NEAR(integral_of_pdf(lambda_min, lambda_max), 1, 1e-4);
    EXPECT_EQ(visible_wavelength_pdf(359.9f), 0);
    EXPECT_EQ(visible_wavelength_pdf(830.1f), 0);
}

TEST(Wavelengths, SamplesCoverTheRange) {
    EXPECT_NEAR(sample_visible_wavelength(0).lambda, lambda_min, 0.05f);
    EXPECT_NEAR(sample_visible_wavelength(1).lambda, lambda_max, 0.05f);
}

// Chi-square over 24 bins, each partner by itself; the threshold lets a right sampler fail once in 10,000
// runs of a fresh seed (Wilson and Hilferty's approximation of the quantile, normal quantile 3.719).
TEST(Wavelengths, VisibleSamplesFollowTheirDensity) {
    constexpr int bins = 24, count = 100000;
    Rng rng(11);
    std::array<std::array<double, bins>, 4> seen{};
    for (int i = 0; i < count; ++i) {
        Wavelengths w = Wavelengths::sample_visible(rng.uniform());
        for (int lane = 0; lane < 4; ++lane) {
            ASSERT_GE(w.lambda[lane], lambda_min);
            ASSERT_LE(w.lambda[lane], lambda_max);
            // The two ways to compute it differ by rounding.
            const float pdf = visible_wavelength_pdf(w.lambda[lane]);
            ASSERT_NEAR(w.pdf[lane], pdf, 2e-5f * pdf + 1e-10f);
            float x = (w.lambda[lane] - lambda_min) / (lambda_max - lambda_min);
            int bin = std::min(static_cast<int>(x * bins), bins - 1);
            ++seen[static_cast<std::size_t>(lane)][static_cast<std::size_t>(bin)];
        }
    }
    double degrees = bins - 1, part = 2 / (9 * degrees);
    double threshold = degrees * std::pow(1 - part + 3.719 * std::sqrt(part), 3);
    for (const auto& lane : seen) {
        double chi_square = 0, width = (lambda_max - lambda_min) / bins;
        for (int b = 0; b < bins; ++b) {
            double expected = count * integral_of_pdf(lambda_min + b * width, lambda_min + (b + 1) * width);
            double difference = lane[static_cast<std::size_t>(b)] - expected;
            chi_square += difference * difference / expected;
        }
        EXPECT_LT(chi_square, threshold);
    }
}

TEST(Wavelengths, PartnersAreAQuarterOfTheDensityApart) {
    Wavelengths w = Wavelengths::sample_visible(0.6f);
    EXPECT_EQ(w.lambda[1], sample_visible_wavelength(0.85f).lambda);
    EXPECT_NEAR(w.lambda[2], sample_visible_wavelength(0.1f).lambda, 1e-3f);
    Wavelengths u = Wavelengths::uniform(0.25f);
    EXPECT_NEAR(u.lambda[0], 360 + 470 * 0.25f, 1e-3f);
    EXPECT_NEAR(u.lambda[3], 360, 1e-3f);
    EXPECT_NEAR(u.pdf[2], 1 / 470.0f, 1e-9f);
}

// What makes noise coloured: the variance of what one sample's four wavelengths measure of a light, relative
// to the mean it has in the channel (where that is next to nothing, to a part of all channels'). Densities
// that follow the eye alone give 0.13 for greys, and up to 0.4.
double color_noise(const SpectralCurve& light, const SpectralCurve& swatch) {
    constexpr int count = 2000;
    std::array<double, 3> mean{}, square{};
    for (int i = 0; i < count; ++i) {
        const Wavelengths w = Wavelengths::sample_visible((static_cast<float>(i) + 0.5f) / count);
        const ObserverSample seen = sample_observer(w.lambda);
        const Spectrum L = light.eval(w.lambda) * swatch.eval(w.lambda) / w.pdf;
        const Vec3d rgb(
            srgb_space().from_xyz({(seen.x * L).average(), (seen.y * L).average(), (seen.z * L).average()}));
        for (std::size_t c = 0; c < 3; ++c) {
            const double value = c == 0 ? rgb.x : c == 1 ? rgb.y : rgb.z;
            mean[c] += value / count;
            square[c] += value * value / count;
        }
    }
    const double grey = (mean[0] + mean[1] + mean[2]) / 3;
    double noise = 0;
    for (std::size_t c = 0; c < 3; ++c) {
        const double shown = std::max(mean[c], 0.3 * grey);
        noise += (square[c] - mean[c] * mean[c]) / (shown * shown) / 3;
    }
    return noise;
}

TEST(Wavelengths, PartnersMeasureLightWithLittleError) {
    constexpr std::size_t first_grey = 18;
    const SpectralCurve light = SpectralCurve::daylight(6504);
    const std::vector<SpectralCurve>& chart = color_checker();
    ASSERT_EQ(chart.size(), 24u);
    for (std::size_t i = 0; i < chart.size(); ++i)
        EXPECT_LT(color_noise(light, chart[i]), i < first_grey ? 0.12 : 0.006) << "swatch " << i;
}

TEST(Wavelengths, TerminationKeepsTheFirst) {
    Wavelengths w = Wavelengths::sample_visible(0.3f);
    float pdf = w.pdf[0];
    EXPECT_FALSE(w.secondary_terminated());
    w.terminate_secondary();
    EXPECT_TRUE(w.secondary_terminated());
    EXPECT_EQ(w.pdf, Spectrum(pdf / 4, 0, 0, 0));
    w.terminate_secondary();
    EXPECT_EQ(w.pdf[0], pdf / 4);
}

TEST(Wavelengths, RgbModeKnowsNoTermination) {
    Wavelengths w = Wavelengths::rgb();
    w.terminate_secondary();
    EXPECT_FALSE(w.secondary_terminated());
    EXPECT_EQ(w.pdf, Spectrum(1));
    EXPECT_EQ(w.hero(Spectrum(1, 2, 3, 4)), 4);
    EXPECT_EQ(Wavelengths::uniform(0).hero(Spectrum(1, 2, 3, 4)), 1);
}

TEST(Wavelengths, ModesByName) {
    EXPECT_EQ(find_color_mode("rgb"), ColorMode::rgb);
    EXPECT_EQ(find_color_mode("spectral"), ColorMode::spectral);
    EXPECT_FALSE(find_color_mode("RGB"));
}

} // namespace
} // namespace alhazen
