/// Frosted glass against numbers computed elsewhere. A border of microfacets that reflects or refracts light
/// once (Walter et al. 2007; height-correlated masking, Heitz 2014) loses what meets a second facet. How much
/// was computed in double precision without any of this code: the integral over facet normals of
///     <wo . m>+ D(m) / cos(wo) F or (1 - F) G(wo, wi),
/// where wi is wo mirrored or refracted at m; equally, and as a check of the half vector's Jacobian, the
/// integral of Walter's equations 20 and 21 over wi. Both agree to 2e-4. With Smith's separable masking the
/// same script gives what Mitsuba 3 samples, to its noise of 1e-3.
#include <gtest/gtest.h>

#include <cmath>

#include "base/hash.h"
#include "materials/material_set.h"
#include "textures/texture_set.h"

namespace alhazen {

namespace {

class RoughDielectric : public ::testing::Test {
  protected:
    // With eta 1.5.
    Bsdf* frosted(float roughness, bool remap) {
        Node node;
        node.type = "dielectric";
        node.name = "m";
        node.parameters = {make_float("roughness", roughness), make_bool("remaproughness", remap)};
        BuildContext context{.messages = messages_, .color_mode = ColorMode::rgb};
        textures_.build({}, context);
        std::vector<Node> nodes{node};
        set_.build(nodes, context);
        messages_.throw_if_errors();
        Hit hit;
        hit.ng = hit.ns = {0, 0, 1};
        hit.dpdu = {1, 0, 0};
        Wavelengths lambda = Wavelengths::rgb();
        return set_.at(0)->at(hit, lambda, arena_);
    }

  private:
    Messages messages_;
    TextureSet textures_;
    MaterialSet set_;
    Arena arena_;
};

/// Mean and standard error.
struct Estimate {
    double sum = 0, squares = 0;
    int count = 0;

    void add(double x) {
        sum += x;
        squares += x * x;
        ++count;
    }
    double mean() const { return sum / count; }
    double error() const { return std::sqrt((squares / count - mean() * mean()) / count); }
};

// How many standard errors the means may be off: a false alarm in 1e6 for each of 26 numbers.
constexpr double limit = 5;

// What eval says is reflected and transmitted, wo in the plane y = 0: midpoints of a grid of angles.
std::pair<double, double> integrals_of_eval(const Bsdf& bsdf, Vec3 wo) {
    constexpr int rings = 600, sectors = 200;
    double sums[2] = {0, 0};
    for (int i = 0; i < 2 * rings; ++i) {
        double theta = (i + 0.5) * 3.14159265358979323846 / (2 * rings), sum = 0;
        for (int j = 0; j < sectors; ++j) {
            double phi = (j + 0.5) * 3.14159265358979323846 / sectors, r = std::sin(theta);
            Vec3 wi(static_cast<float>(r * std::cos(phi)), static_cast<float>(r * std::sin(phi)),
                    static_cast<float>(std::cos(theta)));
            sum += static_cast<double>(bsdf.eval(wo, wi, TransportMode::importance).f[0]) * r;
        }
        bool is_reflected = (i < rings) == (wo.z > 0);
        sums[is_reflected ? 0 : 1] += 2 * sum;
    }
    double cell = 3.14159265358979323846 / (2 * rings) * 3.14159265358979323846 / sectors;
    return {sums[0] * cell, sums[1] * cell};
}

struct Albedo {
    double degrees, reflected, transmitted;
};

// wo at degrees from the normal; above 90 it is inside the glass. Transport of importance counts photons.
void expect_albedo(const Bsdf& bsdf, const Albedo& a) {
    SCOPED_TRACE(a.degrees);
    double theta = a.degrees * 3.14159265358979323846 / 180;
    Vec3 wo(static_cast<float>(std::sin(theta)), 0, static_cast<float>(std::cos(theta)));
    Rng rng(1);
    Estimate reflected, transmitted;
    for (int i = 0; i < 40000; ++i) {
        float u = rng.uniform();
        auto s = bsdf.sample(wo, u, {rng.uniform(), rng.uniform()}, TransportMode::importance);
        bool is_reflection = s && same_hemisphere(wo, s->wi);
        double weight = s ? static_cast<double>(s->f[0] / s->pdf) : 0;
        reflected.add(is_reflection ? weight : 0);
        transmitted.add(is_reflection ? 0 : weight);
    }
    auto [f_reflected, f_transmitted] = integrals_of_eval(bsdf, wo);
    // The grid's own error, at the edge beyond which no facet refracts towards wi.
    EXPECT_NEAR(f_reflected, a.reflected, 1e-3);
    EXPECT_NEAR(f_transmitted, a.transmitted, 1e-3);
    EXPECT_NEAR(reflected.mean(), a.reflected, limit * reflected.error() + 1e-4);
    EXPECT_NEAR(transmitted.mean(), a.transmitted, limit * transmitted.error() + 1e-4);
}

TEST_F(RoughDielectric, AlbedosAreThoseOfTheDoublePrecisionIntegrals) {
    // Roughness 0.3 means alpha 0.5477 in the scene language.
    Bsdf* remapped = frosted(0.3f, true);
    for (const Albedo& a :
         {Albedo{0, 0.02630, 0.93591}, Albedo{35, 0.02883, 0.91070}, Albedo{80, 0.07689, 0.74840},
          Albedo{180, 0.04452, 0.67221}, Albedo{145, 0.18185, 0.49598}, Albedo{118, 0.41174, 0.22382}})
        expect_albedo(*remapped, a);
    Bsdf* plain = frosted(0.3f, false);
    for (const Albedo& a : {Albedo{35, 0.03892, 0.94105}, Albedo{80, 0.12453, 0.77659},
                            Albedo{145, 0.26304, 0.59340}, Albedo{118, 0.66414, 0.11645}})
        expect_albedo(*plain, a);
}

// A glass ball in a uniform sky of radiance 1, seen by parallel rays from its middle to its rim (all: the
// mean over its disk). A chord of a ball meets the surface at the same angle at both ends, so that the angle
// alone is the state of a walk: in at a border, any number of reflections inside, out again. Its mean
//     L_out = R_out + T_out (1 - R_in)^-1 T_in
// with the matrices of the double-precision script (100 and 200 steps of the cosine agree to 5e-4 in the
// middle, 1e-4 over the disk) is 0.5277 over the disk and 0.6567 in its middle. Radiance is divided by eta^2
// on the way in and multiplied on the way out: without losses the ball would be invisible, at 1.
double ball_in_a_furnace(const Bsdf& bsdf, float cos_first, Rng& rng) {
    double weight = 1;
    Vec3 wo(std::sqrt(1 - cos_first * cos_first), 0, cos_first);
    for (int bounce = 0; bounce < 200; ++bounce) {
        float u = rng.uniform();
        auto s = bsdf.sample(wo, u, {rng.uniform(), rng.uniform()}, TransportMode::radiance);
        if (!s) return 0;
        weight *= static_cast<double>(s->f[0] / s->pdf);
        if (s->wi.z > 0) return weight;
        wo = s->wi;
    }
    return 0;
}

TEST_F(RoughDielectric, BallInAFurnaceIsAsBrightAsDerived) {
    struct Case {
        float roughness;
        bool remap;
        double disk, middle;
    };
    for (Case c :
         {Case{0.3f, true, 0.5277, 0.6567}, Case{0.3f, false, 0.7289, 0.8693}, Case{0, true, 1, 1}}) {
        SCOPED_TRACE(c.disk);
        Bsdf* bsdf = frosted(c.roughness, c.remap);
        Rng rng(2);
        Estimate disk, middle;
        for (int i = 0; i < 40000; ++i) {
            // Uniform over the disk is uniform in the squared cosine.
            disk.add(ball_in_a_furnace(*bsdf, std::sqrt(1 - rng.uniform()), rng));
            middle.add(ball_in_a_furnace(*bsdf, 1, rng));
        }
        EXPECT_NEAR(disk.mean(), c.disk, limit * disk.error() + 2e-4);
        EXPECT_NEAR(middle.mean(), c.middle, limit * middle.error() + 5e-4);
    }
}

} // namespace

} // namespace alhazen
