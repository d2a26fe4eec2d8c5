#include "color/spectral.h"

#include <limits>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "color/color_space.h"

namespace alhazen {
namespace {

using testing::HasSubstr;

template <class F>
std::string error_of(F f) {
    try {
        f();
    } catch (const std::invalid_argument& e) {
        return e.what();
    }
    return "";
}

TEST(SpectralCurve, IsLinearBetweenSamplesAndZeroOutside) {
    const float lambdas[] = {400, 500, 530}, values[] = {1, 3, 0};
    SpectralCurve curve = SpectralCurve::from_samples(lambdas, values);
    EXPECT_FLOAT_EQ(curve.eval(400), 1);
    EXPECT_FLOAT_EQ(curve.eval(450), 2);
    EXPECT_FLOAT_EQ(curve.eval(500), 3);
    EXPECT_FLOAT_EQ(curve.eval(520), 1);
    EXPECT_FLOAT_EQ(curve.eval(530), 0);
    EXPECT_EQ(curve.eval(399.9f), 0);
    EXPECT_EQ(curve.eval(530.1f), 0);
    EXPECT_EQ(curve.max_value(), 3);
    EXPECT_EQ(curve.eval(Spectrum(400, 450, 500, 900)), Spectrum(1, 2, 3, 0));
}

TEST(SpectralCurve, EvenAndUnevenSamplesAgree) {
    const float even[] = {400, 1, 450, 4, 500, 2, 550, 7},
                uneven[] = {400, 1, 450, 4, 475, 3, 500, 2, 550, 7};
    SpectralCurve a = SpectralCurve::from_pairs(even), b = SpectralCurve::from_pairs(uneven);
    for (float lambda = 390; lambda < 560; lambda += 0.37f)
        EXPECT_NEAR(a.eval(lambda), b.eval(lambda), 1e-4f);
}

TEST(SpectralCurve, Constant) {
    SpectralCurve curve = SpectralCurve::constant(0.7f);
    EXPECT_TRUE(curve.is_constant());
    EXPECT_EQ(curve.eval(100), 0.7f);
    EXPECT_EQ(curve.eval(Spectrum(1, 400, 500, 9000)), Spectrum(0.7f));
    EXPECT_EQ(curve.scaled(2).eval(500), 1.4f);
}

TEST(SpectralCurve, ExtendedKeepsItsEnds) {
    const float pairs[] = {400, 2, 500, 3, 700, 5};
    SpectralCurve curve = SpectralCurve::from_pairs(pairs).extended();
    EXPECT_EQ(curve.eval(360), 2);
    EXPECT_EQ(curve.eval(830), 5);
    EXPECT_FLOAT_EQ(curve.eval(450), 2.5f);
}

TEST(SpectralCurve, RefusesBadSamples) {
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    auto pairs = [](std::vector<float> p) { return error_of([&] { SpectralCurve::from_pairs(p); }); };
    EXPECT_EQ(pairs({500, 1, 400, 1}), "wavelength 400 nm follows 500 nm; expected increasing wavelengths");
    EXPECT_EQ(pairs({400, 1, 400, 2}), "wavelength 400 nm follows 400 nm; expected increasing wavelengths");
    EXPECT_EQ(pairs({400, 1, 500, nan}), "sample 2 of the spectrum is not a finite number");
    EXPECT_EQ(pairs({400, 1, inf, 1}), "sample 2 of the spectrum is not a finite number");
    EXPECT_EQ(pairs({0, 1, 400, 1}), "wavelength 0 nm; expected a positive number");
    EXPECT_EQ(pairs({400, 1, 500}), "3 numbers; expected pairs of a wavelength and a value");
    EXPECT_EQ(pairs({}), "a spectrum of 0 samples; expected at least 2");
    EXPECT_EQ(pairs({400, 1}), "a spectrum of 1 samples; expected at least 2");
    const float three[] = {1, 2, 3}, two[] = {1, 2};
    EXPECT_THAT(error_of([&] { SpectralCurve::from_samples(three, two); }),
                HasSubstr("3 wavelengths but 2 values"));
}

TEST(SpectralCurve, ParsesText) {
    SpectralCurve curve = SpectralCurve::parse("# a lamp\n400 1\t450 2 # middle\r\n500 3e0\n#end");
    EXPECT_EQ(curve.eval(450), 2);
    EXPECT_EQ(curve.eval(500), 3);
    EXPECT_EQ(error_of([] { SpectralCurve::parse("400 1 5oo 2"); }), "\"5oo\"; expected a number");
    EXPECT_EQ(error_of([] { SpectralCurve::parse("400 1 500 1e999"); }), "\"1e999\"; expected a number");
    EXPECT_EQ(error_of([] { SpectralCurve::parse("400 1 500 nan"); }),
              "sample 2 of the spectrum is not a finite number");
}

// Wien's law: the peak is at 2897772 nm K / T. Planck's law has no other maximum, so the neighbours are
// lower.
TEST(Blackbody, PeaksWhereWienSaysAtOne) {
    for (float kelvin : {4000.0f, 5000.0f, 6500.0f, 7500.0f}) {
        float peak = 2897772.1f / kelvin;
        SpectralCurve curve = SpectralCurve::blackbody(kelvin);
        EXPECT_NEAR(curve.eval(peak), 1, 1e-5f);
        EXPECT_LT(curve.eval(peak - 15), curve.eval(peak));
        EXPECT_LT(curve.eval(peak + 15), curve.eval(peak));
        EXPECT_NEAR(curve.max_value(), 1, 1e-5f);
    }
    // The peak of 2000 K is in the infrared, and the maximum stays below 1.
    EXPECT_LT(SpectralCurve::blackbody(2000).max_value(), 0.5f);
    EXPECT_EQ(SpectralCurve::blackbody(1).max_value(), 0);
}

// Radiance of a black body of 6000 K at 500 nm by hand: 2 h c^2 / lambda^5 = 3.8110e15, e^4.79593 - 1 =
// 120.02.
TEST(Blackbody, RadianceOfPlancksLaw) {
    EXPECT_NEAR(blackbody_radiance(500, 6000), 3.176e13, 0.002e13);
    EXPECT_EQ(blackbody_radiance(500, 0), 0);
    EXPECT_EQ(blackbody_radiance(500, -5), 0);
}

TEST(Cie, ObserverIsTheCies) {
    EXPECT_NEAR(y_integral(SpectralCurve::constant(1)), cie_y_integral, 1e-4);
    EXPECT_FLOAT_EQ(cie_y().eval(555), 1.0f);
    EXPECT_FLOAT_EQ(cie_x().eval(360), 0.0001299f);
    EXPECT_FLOAT_EQ(cie_x().eval(600), 1.0622f);
    EXPECT_FLOAT_EQ(cie_z().eval(445), 1.7826f);
    // The equal-energy white is at x = y = 1/3.
    Vec2d white = chromaticity(cie_integrals(SpectralCurve::constant(1)));
    EXPECT_NEAR(white.x, 1.0 / 3, 1e-4);
    EXPECT_NEAR(white.y, 1.0 / 3, 1e-4);
}

TEST(Cie, ObserverSamplesAreTheCurves) {
    Spectrum lambda(360, 555.25f, 830, 900);
    ObserverSample s = sample_observer(lambda);
    for (int i = 0; i < 4; ++i) {
        EXPECT_FLOAT_EQ(s.x[i], cie_x().eval(lambda[i]));
        EXPECT_FLOAT_EQ(s.y[i], cie_y().eval(lambda[i]));
        EXPECT_FLOAT_EQ(s.z[i], cie_z().eval(lambda[i]));
    }
}

struct White {
    const char* name;
    double x, y;
};

// Chromaticities published by the CIE (15:2004, tables T.3 and T.8.1) and, for D60, SMPTE ST 2065-1.
TEST(NamedSpectra, IlluminantsHaveTheirChromaticity) {
    const White whites[] = {{"stdillum-A", 0.44757, 0.40745},   {"stdillum-D50", 0.34567, 0.35850},
                            {"stdillum-D65", 0.31272, 0.32903}, {"illum-acesD60", 0.32168, 0.33767},
                            {"stdillum-F1", 0.3131, 0.3371},    {"stdillum-F2", 0.3721, 0.3751},
                            {"stdillum-F3", 0.4091, 0.3941},    {"stdillum-F4", 0.4402, 0.4031},
                            {"stdillum-F5", 0.3138, 0.3452},    {"stdillum-F6", 0.3779, 0.3882},
                            {"stdillum-F7", 0.3129, 0.3292},    {"stdillum-F8", 0.3458, 0.3586},
                            {"stdillum-F9", 0.3741, 0.3727},    {"stdillum-F10", 0.3458, 0.3588},
                            {"stdillum-F11", 0.3805, 0.3769},   {"stdillum-F12", 0.4370, 0.4042}};
    for (const White& w : whites) {
        const SpectralCurve* curve = named_spectrum(w.name);
        ASSERT_NE(curve, nullptr) << w.name;
        Vec2d xy = chromaticity(cie_integrals(*curve));
        EXPECT_NEAR(xy.x, w.x, 3e-4) << w.name;
        EXPECT_NEAR(xy.y, w.y, 3e-4) << w.name;
        EXPECT_NEAR(y_integral(*curve), cie_y_integral, 1e-3) << w.name;
    }
}

TEST(NamedSpectra, AllNamesArePresentAndCoverTheRange) {
    EXPECT_EQ(spectrum_names().size(), 16u + 14u + 10u);
    for (const std::string& name : spectrum_names()) {
        const SpectralCurve* curve = named_spectrum(name);
        ASSERT_NE(curve, nullptr) << name;
        if (name.starts_with("glass")) {
            EXPECT_GT(curve->eval(360), 1.4f) << name;
            EXPECT_GT(curve->eval(830), 1.4f) << name;
        }
    }
    for (const char* name : {"metal-Ag-eta", "metal-CuZn-k", "glass-F11", "glass-SF11", "metal-MgO-eta"})
        EXPECT_NE(named_spectrum(name), nullptr) << name;
    EXPECT_EQ(named_spectrum("metal-Unobtainium-eta"), nullptr);
    EXPECT_EQ(named_spectrum(""), nullptr);
}

// Single values as pbrt-v4 tabulates them.
TEST(NamedSpectra, ValuesAreTheKnownOnes) {
    EXPECT_NEAR(named_spectrum("metal-Cu-eta")->eval(604.800842f), 0.351250f, 1e-6f);
    EXPECT_NEAR(named_spectrum("metal-Ag-k")->eval(551.040771f), 3.348125f, 1e-6f);
    EXPECT_NEAR(named_spectrum("metal-TiO2-eta")->eval(600.097046f), 2.90f, 1e-6f);
    EXPECT_NEAR(named_spectrum("glass-BK7")->eval(410), 1.529568767f, 1e-6f);
    // Its tables of the other glasses round the wavelengths to whole nm, which moves the index.
    EXPECT_NEAR(named_spectrum("glass-BAF10")->eval(500), 1.678187062f, 4e-4f);
    EXPECT_NEAR(named_spectrum("glass-F11")->eval(412), 1.837470771f, 4e-4f);
}

// Schott's catalogue gives the index at the helium line d, 587.5618 nm, to five decimals.
TEST(NamedSpectra, GlassesHaveTheirCatalogueIndex) {
    const std::pair<const char*, float> glasses[] = {
        {"BK7", 1.51680f}, {"BAF10", 1.67003f}, {"FK51A", 1.48656f}, {"LASF9", 1.85025f},
        {"F5", 1.67271f},  {"F10", 1.72828f},   {"F11", 1.78472f}};
    for (auto [name, index] : glasses)
        EXPECT_NEAR(named_spectrum(std::string("glass-") + name)->eval(587.5618f), index, 1e-5f) << name;
}

TEST(Daylight, OfTheNominalTemperatureIsTheIlluminant) {
    SpectralCurve d65 = SpectralCurve::daylight(6500), d50 = SpectralCurve::daylight(5000);
    for (float lambda = 400; lambda < 700; lambda += 10) {
        EXPECT_NEAR(d65.eval(lambda), named_spectrum("stdillum-D65")->eval(lambda), 2e-3f) << lambda;
        EXPECT_NEAR(d50.eval(lambda), named_spectrum("stdillum-D50")->eval(lambda), 2e-2f) << lambda;
    }
    Vec2d warm = chromaticity(cie_integrals(SpectralCurve::daylight(3000)));
    Vec2d black = chromaticity(cie_integrals(SpectralCurve::blackbody(3000)));
    EXPECT_NEAR(warm.x, black.x, 1e-3);
    EXPECT_NEAR(warm.y, black.y, 1e-3);
}

} // namespace
} // namespace alhazen
