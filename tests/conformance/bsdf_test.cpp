/// What every BSDF must satisfy, whatever it is: directions of unit length, sampling that agrees with
/// evaluation, reciprocity, and no more light out than in. Loops over the registry and every example, so a
/// new material is tested by being listed. A chi-square test alone misses faults that scale or drop samples;
/// the mass test (successful samples = integral of the density) and the reverse densities catch those. Of
/// BSDFs that are evaluated by random walks, the means must agree.
#include <gtest/gtest.h>

#include "base/hash.h"
#include "math/warp.h"
#include "tests/support/bsdf_cases.h"
#include "tests/support/chi_square.h"
#include "tests/support/statistics.h"

namespace alhazen {

namespace {

using namespace testing_support;

constexpr TransportMode transport_modes[] = {TransportMode::radiance, TransportMode::importance};

Vec3 direction(float degrees_from_z, float azimuth_degrees) {
    float theta = radians(degrees_from_z), phi = radians(azimuth_degrees);
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

// Near the normal, oblique, grazing; below the surface within and beyond the critical angle of glass.
const std::vector<Vec3>& view_directions() {
    static const std::vector<Vec3> all{direction(0, 0),    direction(35, 70),  direction(62, 200),
                                       direction(86, 310), direction(155, 20), direction(120, 250)};
    return all;
}

const std::vector<BsdfCase>& bsdf_cases() {
    static const BsdfCases all;
    return all.list();
}

std::string describe(const BsdfCase& c, Vec3 wo, TransportMode mode) {
    return c.name + ", wo (" + std::to_string(wo.x) + ", " + std::to_string(wo.y) + ", " +
           std::to_string(wo.z) + "), " + (mode == TransportMode::radiance ? "radiance" : "importance");
}

bool near(float a, float b, float relative) {
    return std::abs(a - b) <= relative * std::max(std::abs(a), std::abs(b)) + 1e-7f;
}
bool near(Spectrum a, Spectrum b, float relative) {
    for (int i = 0; i < 4; ++i)
        if (!near(a[i], b[i], relative)) return false;
    return true;
}

template <class Test>
void for_each_case(Test test) {
    for (const BsdfCase& c : bsdf_cases())
        for (Vec3 wo : view_directions())
            for (TransportMode mode : transport_modes) {
                SCOPED_TRACE(describe(c, wo, mode));
                test(c, wo, mode);
                if (::testing::Test::HasFailure()) return;
            }
}

// Hair's model and measurements are not symmetric: their importance is the radiance of the way back. (Hair's
// normal, which belongs to the curve's ribbon, has no part in it.)
bool is_symmetric(const BsdfCase& c) {
    return c.kind != "hair" && c.kind != "measured";
}

bool is_specular(const BsdfSample& s) {
    return has(s.lobes, Lobes::specular);
}

void check_sample(const BsdfCase& c, Vec3 wo, TransportMode mode, const BsdfSample& s) {
    ASSERT_NEAR(length(s.wi), 1, 2e-6f);
    ASSERT_TRUE(s.f.is_finite() && s.f.min() >= 0) << s.f[0];
    ASSERT_TRUE(std::isfinite(s.pdf) && s.pdf > 0 && std::isfinite(s.pdf_reverse) && s.pdf_reverse >= 0);
    bool reflects = has(s.lobes, Lobes::reflection);
    ASSERT_NE(reflects, has(s.lobes, Lobes::transmission));
    ASSERT_EQ(reflects, same_hemisphere(wo, s.wi));
    ASSERT_EQ(static_cast<int>(s.lobes) & static_cast<int>(c.bsdf->lobes()), static_cast<int>(s.lobes));
    if (reflects) {
        ASSERT_EQ(s.eta, 1);
    }
    if (is_specular(s)) return;
    Scatter value = c.bsdf->eval(wo, s.wi, mode);
    if (!c.bsdf->is_stochastic()) {
        ASSERT_TRUE(near(value.f, s.f, 1e-3f)) << value.f[0] << " " << s.f[0];
    }
    ASSERT_TRUE(near(value.pdf, s.pdf, 1e-3f)) << value.pdf << " " << s.pdf;
    ASSERT_TRUE(near(value.pdf_reverse, s.pdf_reverse, 1e-3f));
}

/// Of a stochastic quantity: mean of its first lane, and the variance of that.
struct Mean {
    double value = 0, variance = 0;
};
Mean mean_of(const std::vector<double>& samples) {
    testing::Moments m = testing::moments(samples);
    return {m.mean, m.variance_of_mean};
}
// In standard errors; rounding counts as an error too.
double difference(Mean a, Mean b) {
    double rounding = 1e-4 * std::max(std::abs(a.value), std::abs(b.value)) + 1e-7;
    return std::abs(a.value - b.value) / (std::sqrt(a.variance + b.variance) + rounding);
}
Mean mean_f(const BsdfCase& c, Vec3 wo, Vec3 wi) {
    std::vector<double> samples;
    for (const Bsdf* bsdf : c.elsewhere) samples.push_back(static_cast<double>(bsdf->eval(wo, wi).f[0]));
    return mean_of(samples);
}

TEST(Bsdf, EveryKindHasExamples) {
    for (const auto& kind : material_kinds().all()) EXPECT_GE(kind.doc().examples.size(), 1u) << kind.name;
    EXPECT_GE(bsdf_cases().size(), 25u);
}

TEST(Bsdf, SamplesAgreeWithEvaluation) {
    Rng rng(1);
    for_each_case([&](const BsdfCase& c, Vec3 wo, TransportMode mode) {
        for (int i = 0; i < 500; ++i) {
            auto s = c.bsdf->sample(wo, rng.uniform(), {rng.uniform(), rng.uniform()}, mode);
            if (s) check_sample(c, wo, mode, *s);
            if (::testing::Test::HasFailure()) return;
        }
    });
}

// Lights may be left to BSDF sampling (Light::sample_beside_bsdf), which must then find all that is there.
TEST(Bsdf, WhatIsScatteredCanBeDrawn) {
    Rng rng(5);
    for_each_case([&](const BsdfCase& c, Vec3 wo, TransportMode mode) {
        for (int i = 0; i < 500; ++i) {
            Scatter s = c.bsdf->eval(wo, sample_sphere({rng.uniform(), rng.uniform()}), mode);
            ASSERT_TRUE(s.f.is_black() || s.pdf > 0) << s.f[0];
        }
    });
}

// The corners of the unit cube are where divisions by zero hide.
// Such hits come with any frame around the normal.
TEST(Bsdf, WhatNeedsNoParametersIsAlikeInAllDirectionsAround) {
    int tested = 0;
    for (const BsdfCase& c : bsdf_cases()) {
        if (!c.plain) continue;
        SCOPED_TRACE(c.name);
        ++tested;
        for (Vec3 wo : view_directions())
            for (float turn : {0.0f, 73.0f, 190.0f})
                for (Vec3 wi : {direction(20, 130), direction(70, 15), direction(140, 260)}) {
                    auto turned = [&](Vec3 w) {
                        float c1 = std::cos(radians(turn)), s1 = std::sin(radians(turn));
                        return Vec3{c1 * w.x - s1 * w.y, s1 * w.x + c1 * w.y, w.z};
                    };
                    Scatter a = c.bsdf->eval(wo, wi), b = c.plain->eval(turned(wo), turned(wi));
                    if (c.bsdf->is_stochastic())
                        EXPECT_LT(difference(mean_f(c, wo, wi), mean_f(c, turned(wo), turned(wi))), 5);
                    else
                        EXPECT_TRUE(near(a.f, b.f, 2e-3f)) << a.f[0] << " " << b.f[0];
                    EXPECT_TRUE(near(a.pdf, b.pdf, 2e-3f)) << a.pdf << " " << b.pdf;
                }
    }
    EXPECT_GT(tested, 10);
}

TEST(Bsdf, ExtremeNumbersAreSafe) {
    for_each_case([&](const BsdfCase& c, Vec3 wo, TransportMode mode) {
        for (float u : {0.0f, 0.5f, one_minus_epsilon})
            for (float a : {0.0f, 0.5f, one_minus_epsilon})
                for (float b : {0.0f, 0.25f, one_minus_epsilon}) {
                    auto s = c.bsdf->sample(wo, u, {a, b}, mode);
                    if (s) check_sample(c, wo, mode, *s);
                }
    });
    for (const BsdfCase& c : bsdf_cases()) {
        Vec3 tangent{1, 0, 0};
        EXPECT_EQ(c.bsdf->eval(tangent, {0, 0, 1}).pdf, 0) << c.name;
        EXPECT_EQ(c.bsdf->eval({0, 0, 1}, tangent).f.max(), 0) << c.name;
        auto s = c.bsdf->sample(tangent, 0.3f, {0.6f, 0.7f});
        EXPECT_TRUE(!s || (s->f.is_finite() && std::isfinite(s->pdf))) << c.name;
    }
}

// Cells of equal solid angle: rings of z times sectors. z = 0, where densities jump, is a border.
constexpr int rings = 16, sectors = 24, cell_count = rings * sectors;

int cell_of(Vec3 w) {
    int ring = std::clamp(static_cast<int>((w.z + 1) / 2 * rings), 0, rings - 1);
    if (w.z < 0) ring = std::min(ring, rings / 2 - 1);
    float phi = std::atan2(w.y, w.x) * (inv_pi / 2);
    int sector = std::clamp(static_cast<int>((phi < 0 ? phi + 1 : phi) * sectors), 0, sectors - 1);
    return ring * sectors + sector;
}

/// Integral of the density over a cell, by Gauss and Legendre's rule, halved until it holds.
class CellIntegral {
  public:
    CellIntegral(const Bsdf& bsdf, Vec3 wo, TransportMode mode) : bsdf_(bsdf), wo_(wo), mode_(mode) {}

    double over(double z0, double z1, double phi0, double phi1) const {
        return refine(z0, z1, phi0, phi1, rule(z0, z1, phi0, phi1), 0);
    }

  private:
    double density(double z, double phi) const {
        double r = std::sqrt(std::max(0.0, 1 - z * z));
        Vec3 wi(static_cast<float>(r * std::cos(phi)), static_cast<float>(r * std::sin(phi)),
                static_cast<float>(z));
        return static_cast<double>(bsdf_.eval(wo_, wi, mode_).pdf);
    }
    double rule(double z0, double z1, double phi0, double phi1) const {
        static constexpr double x[] = {-0.7745966692414834, 0, 0.7745966692414834};
        static constexpr double w[] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
        double sum = 0;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                sum += w[i] * w[j] *
                       density((z0 + z1) / 2 + x[i] * (z1 - z0) / 2,
                               (phi0 + phi1) / 2 + x[j] * (phi1 - phi0) / 2);
        return sum * (z1 - z0) * (phi1 - phi0);
    }
    double refine(double z0, double z1, double phi0, double phi1, double whole, int depth) const {
        double zm = (z0 + z1) / 2, pm = (phi0 + phi1) / 2;
        double parts[] = {rule(z0, zm, phi0, pm), rule(z0, zm, pm, phi1), rule(zm, z1, phi0, pm),
                          rule(zm, z1, pm, phi1)};
        double sum = parts[0] + parts[1] + parts[2] + parts[3];
        if (std::abs(sum - whole) < 2e-6 || depth == 7) return sum;
        return refine(z0, zm, phi0, pm, parts[0], depth + 1) + refine(z0, zm, pm, phi1, parts[1], depth + 1) +
               refine(zm, z1, phi0, pm, parts[2], depth + 1) + refine(zm, z1, pm, phi1, parts[3], depth + 1);
    }

    const Bsdf& bsdf_;
    Vec3 wo_;
    TransportMode mode_;
};

std::vector<double> cell_probabilities(const Bsdf& bsdf, Vec3 wo, TransportMode mode) {
    CellIntegral integral(bsdf, wo, mode);
    std::vector<double> p;
    constexpr double two_pi = 6.283185307179586;
    for (int r = 0; r < rings; ++r)
        for (int s = 0; s < sectors; ++s)
            p.push_back(integral.over(-1 + 2.0 * r / rings, -1 + 2.0 * (r + 1) / rings, two_pi * s / sectors,
                                      two_pi * (s + 1) / sectors));
    return p;
}

// Counts of sampled directions by cell; the last is of samples that are lost or specular.
std::vector<double> cell_counts(const Bsdf& bsdf, Vec3 wo, TransportMode mode, int samples, Rng& rng) {
    std::vector<double> counts(cell_count + 1);
    for (int i = 0; i < samples; ++i) {
        float u = rng.uniform();
        Vec2 u2{rng.uniform(), rng.uniform()};
        auto s = bsdf.sample(wo, u, u2, mode);
        counts[static_cast<std::size_t>(s && !is_specular(*s) ? cell_of(s->wi) : cell_count)] += 1;
    }
    return counts;
}

// False alarms: 1e-4 for all the chi-square tests together, and as much for the masses.
TEST(Bsdf, SampledDirectionsFollowTheDensity) {
    constexpr int samples = 40000;
    Rng rng(2);
    auto count =
        static_cast<int>(bsdf_cases().size() * view_directions().size() * std::size(transport_modes));
    double level = sidak_level(1e-4, count);
    for_each_case([&](const BsdfCase& c, Vec3 wo, TransportMode mode) {
        // Whose density is only near: see the test of its mean.
        if (c.bsdf->is_stochastic()) return;
        // The mode changes transmission only.
        if (mode == TransportMode::importance && !has(c.bsdf->lobes(), Lobes::transmission)) return;
        auto observed = cell_counts(*c.bsdf, wo, mode, samples, rng);
        if (observed.back() == samples && !has(c.bsdf->lobes(), Lobes::diffuse | Lobes::glossy)) return;
        auto expected = cell_probabilities(*c.bsdf, wo, mode);
        double mass = std::accumulate(expected.begin(), expected.end(), 0.0);
        ASSERT_LE(mass, 1 + 1e-3);
        // 5.3 standard deviations leave a chance of 1e-7, a 800th of 1e-4; the rest is the integral's error.
        double found = 1 - observed.back() / samples;
        ASSERT_NEAR(found, mass, 5.3 * std::sqrt(std::max(0.0, mass * (1 - mass)) / samples) + 4e-4);
        expected.push_back(std::max(0.0, 1 - mass));
        for (double& e : expected) e *= samples;
        // Lost samples that the integral cannot tell from none are no evidence.
        if (expected.back() < 5) {
            expected.pop_back();
            observed.pop_back();
        }
        auto result = chi_square_test(observed, expected);
        ASSERT_GT(result.p_value, level)
            << "statistic " << result.statistic << ", degrees " << result.degrees;
    });
}

// What samples bring to a cell, in the mean, is the integral of the evaluations over it: the same light,
// whether a light is found by sampling it or by sampling the BSDF. Reflection only, since that is all there
// is so far.
TEST(Bsdf, StochasticSamplesAgreeWithEvaluationsInTheMean) {
    constexpr int z_cells = 6, phi_cells = 6, cells = z_cells * phi_cells, samples = 400 * cells;
    int tested = 0;
    Rng rng(6);
    for_each_case([&](const BsdfCase& c, Vec3 wo, TransportMode mode) {
        if (!c.bsdf->is_stochastic() || mode == TransportMode::importance) return;
        ++tested;
        std::vector<std::vector<double>> sampled(cells), evaluated(cells);
        double mass = 0;
        for (int i = 0; i < samples; ++i) {
            const Bsdf& bsdf = *c.elsewhere[static_cast<std::size_t>(i) % c.elsewhere.size()];
            float u = rng.uniform();
            Vec2 u2{rng.uniform(), rng.uniform()};
            auto s = bsdf.sample(wo, u, u2, mode);
            int cell = -1;
            if (s && !is_specular(*s)) {
                float phi = std::atan2(s->wi.y, s->wi.x) * (inv_pi / 2);
                cell = std::min(z_cells - 1, static_cast<int>(std::abs(s->wi.z) * z_cells)) * phi_cells +
                       std::min(phi_cells - 1, static_cast<int>((phi < 0 ? phi + 1 : phi) * phi_cells));
            }
            for (int k = 0; k < cells; ++k)
                sampled[static_cast<std::size_t>(k)].push_back(
                    k == cell ? static_cast<double>(s->f[0] / s->pdf) : 0);
            // One direction of each cell in turn.
            cell = i % cells;
            float z = (static_cast<float>(cell / phi_cells) + rng.uniform()) / z_cells;
            float phi = 2 * pi * (static_cast<float>(cell % phi_cells) + rng.uniform()) / phi_cells;
            float r = safe_sqrt(1 - z * z);
            Vec3 wi{r * std::cos(phi), r * std::sin(phi), std::copysign(z, wo.z)};
            Scatter value = bsdf.eval(wo, wi, mode);
            evaluated[static_cast<std::size_t>(cell)].push_back(
                static_cast<double>(value.f[0] * (2 * pi / cells)));
            mass += static_cast<double>(value.pdf * (2 * pi / samples));
        }
        // Narrow lobes are met by chance.
        EXPECT_LT(mass, 1.2);
        for (std::size_t k = 0; k < cells; ++k) {
            Mean a = mean_of(sampled[k]), b = mean_of(evaluated[k]);
            // Of a few samples (of weights up to about one) the scatter says little.
            a.variance = std::max(a.variance, b.value / samples);
            // A chance of 6e-7 for each of some thousand cells.
            ASSERT_LT(difference(a, b), 5) << "cell " << k << ": " << a.value << " and " << b.value;
        }
    });
    EXPECT_GT(tested, 40);
}

// f(wo, wi) as radiance is f(wi, wo) as importance, for reflection and refraction alike (Veach 1997, 5.2);
// the density of the way back is the density of the reversed pair.
TEST(Bsdf, IsReciprocal) {
    Rng rng(3);
    for (const BsdfCase& c : bsdf_cases()) {
        SCOPED_TRACE(c.name);
        for (int i = 0; i < 400; ++i) {
            Vec3 wo = sample_sphere({rng.uniform(), rng.uniform()});
            Vec3 wi = sample_sphere({rng.uniform(), rng.uniform()});
            if (std::min(std::abs(wo.z), std::abs(wi.z)) < 0.02f) continue;
            Scatter there = c.bsdf->eval(wo, wi, TransportMode::radiance);
            Scatter back = c.bsdf->eval(wi, wo, TransportMode::importance);
            if (!c.bsdf->is_stochastic()) {
                ASSERT_TRUE(near(there.f / std::abs(wi.z), back.f / std::abs(wo.z), 5e-3f))
                    << there.f[0] / std::abs(wi.z) << " " << back.f[0] / std::abs(wo.z);
            } else if (i % 20 == 0) {
                Mean a = mean_f(c, wo, wi), b = mean_f(c, wi, wo);
                double ratio = static_cast<double>(std::abs(wi.z / wo.z));
                ASSERT_LT(difference(a, {b.value * ratio, b.variance * ratio * ratio}), 5)
                    << a.value << " " << b.value;
            }
            ASSERT_TRUE(near(there.pdf_reverse, back.pdf, 5e-3f)) << there.pdf_reverse << " " << back.pdf;
            ASSERT_TRUE(near(there.pdf, back.pdf_reverse, 5e-3f));
        }
    }
}

// Refraction squeezes radiance by eta^2 (Veach 1997, section 5.2): the two modes differ by that alone.
TEST(Bsdf, ModesDifferByEtaSquared) {
    Rng rng(4);
    for (const BsdfCase& c : bsdf_cases())
        for (Vec3 wo : view_directions())
            for (int i = 0; i < 50 && is_symmetric(c); ++i) {
                float u = rng.uniform();
                Vec2 u2{rng.uniform(), rng.uniform()};
                auto radiance = c.bsdf->sample(wo, u, u2, TransportMode::radiance);
                auto importance = c.bsdf->sample(wo, u, u2, TransportMode::importance);
                ASSERT_EQ(radiance.has_value(), importance.has_value()) << c.name;
                if (!radiance) continue;
                ASSERT_TRUE(near(radiance->f * sqr(radiance->eta), importance->f, 1e-4f)) << c.name;
            }
}

struct Albedo {
    Spectrum mean = 0;
    float error = 0; ///< standard error of the largest lane
};

Albedo estimate_albedo(const Bsdf& bsdf, Vec3 wo, TransportMode mode, int samples, Rng& rng) {
    Albedo a;
    double sum2 = 0;
    Spectrum sum = 0;
    for (int i = 0; i < samples; ++i) {
        float u = (static_cast<float>(i) + rng.uniform()) / static_cast<float>(samples);
        auto s = bsdf.sample(wo, std::min(u, one_minus_epsilon), {rng.uniform(), rng.uniform()}, mode);
        if (!s) continue;
        Spectrum weight = s->f / s->pdf;
        // A light meter on the other side of the border counts photons, not squeezed radiance.
        if (mode == TransportMode::radiance) weight *= sqr(s->eta);
        sum += weight;
        sum2 += static_cast<double>(sqr(weight.max()));
    }
    a.mean = sum / static_cast<float>(samples);
    a.error = static_cast<float>(std::sqrt(sum2) / samples);
    return a;
}

bool is_lossless(const BsdfCase& c) {
    if (c.kind == "thindielectric" || (c.kind == "hair" && c.example == "white")) return true;
    if (c.kind == "dielectric") return !has(c.bsdf->lobes(), Lobes::glossy);
    return (c.kind == "diffuse" && c.example == "white") ||
           (c.kind == "conductor" && c.example == "perfect mirror");
}

// In a furnace where light comes from everywhere, no surface may shine brighter than its surroundings. Five
// standard errors: a chance below 3e-7 for each of about 400 tests.
TEST(Bsdf, WhiteFurnaceKeepsEnergy) {
    Rng rng(5);
    for_each_case([&](const BsdfCase& c, Vec3 wo, TransportMode mode) {
        if (mode == TransportMode::importance && !is_symmetric(c)) return;
        Albedo a = estimate_albedo(*c.bsdf, wo, mode, 4000, rng);
        ASSERT_LE(a.mean.max(), 1 + 1e-4f + (is_lossless(c) ? 0 : 5 * a.error));
        if (is_lossless(c)) {
            // 1e-4 is what the conductor's reflectance stays below 1; 1e-3 allows for the choice of lobe.
            ASSERT_GE(a.mean.min(), 1 - 1e-3f);
        }
    });
}

// Whatever the numbers, a specular surface chooses one of its lobes with certainty.
TEST(Bsdf, SpecularChancesSumToOne) {
    for (const BsdfCase& c : bsdf_cases()) {
        if (has(c.bsdf->lobes(), Lobes::diffuse | Lobes::glossy) || c.bsdf->lobes() == Lobes::none) continue;
        for (Vec3 wo : view_directions()) {
            float chances[2] = {0, 0}, weights[2] = {0, 0};
            for (int i = 0; i <= 1000; ++i) {
                auto s = c.bsdf->sample(wo, std::min(static_cast<float>(i) / 1000, one_minus_epsilon),
                                        {0.5f, 0.5f}, TransportMode::importance);
                if (!s) continue;
                int side = has(s->lobes, Lobes::transmission) ? 1 : 0;
                chances[side] = s->pdf;
                weights[side] = s->f[0];
            }
            EXPECT_NEAR(chances[0] + chances[1], 1, 1e-3f) << describe(c, wo, transport_modes[1]);
            EXPECT_LE(weights[0] + weights[1], 1 + 1e-5f) << describe(c, wo, transport_modes[1]);
        }
    }
}

} // namespace

} // namespace alhazen
