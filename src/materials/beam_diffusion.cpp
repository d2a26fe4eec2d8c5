#include "materials/beam_diffusion.h"

#include <cmath>

#include "base/threads.h"
#include "materials/fresnel.h"
#include "math/phase.h"

namespace alhazen {

namespace {

constexpr double pi_d = 3.14159265358979323846;
constexpr std::size_t albedo_count = 100, radius_count = 64;

double fresnel_inside(double cosine, double eta) {
    return static_cast<double>(fresnel_dielectric(static_cast<float>(-cosine), static_cast<float>(eta)));
}

double length_of(double x, double y) {
    return std::sqrt(x * x + y * y);
}

/// Integral of f over depths from 0 to where exp(-decay depth) is nothing, by the midpoint rule in steps that
/// grow with the depth, beginning as small as the radius wants.
template <class F>
double over_depth(double r, double decay, int samples, F f) {
    const double deepest = 40 / decay;
    const double step = std::log1p(deepest / r) / samples;
    double sum = 0;
    for (int i = 0; i < samples; ++i) {
        const double growth = std::exp((i + 0.5) * step);
        sum += f(r * (growth - 1)) * growth;
    }
    return sum * r * step;
}

} // namespace

double fresnel_moment(double eta, int power, bool is_inside) {
    // Fine enough for five digits in spite of the kink at the critical angle.
    constexpr int n = 4096;
    double sum = 0;
    for (int i = 0; i < n; ++i) {
        const double cosine = (i + 0.5) / n;
        const double reflected = fresnel_inside(is_inside ? cosine : -cosine, eta);
        sum += reflected * std::pow(cosine, power);
    }
    return sum / n;
}

double single_scattering(const ScatteringMatter& matter, double r, int samples) {
    const HenyeyGreenstein phase(static_cast<float>(matter.g));
    // Light from above this depth meets the surface beyond the critical angle.
    const double t_critical = r * std::sqrt(std::max(0.0, matter.eta * matter.eta - 1));
    return over_depth(r, 1, samples, [&](double beyond) {
        const double depth = t_critical + beyond, distance = length_of(r, depth);
        const double cosine = depth / distance;
        // The beam's light came from above; the cosine is that of turning back.
        const Vec3 out(static_cast<float>(r / distance), 0, static_cast<float>(cosine));
        const auto scattered = static_cast<double>(phase.eval({0, 0, 1}, out));
        return matter.albedo * std::exp(-(distance + depth)) / (distance * distance) * scattered *
               (1 - fresnel_inside(cosine, matter.eta)) * cosine;
    });
}

namespace {

/// What the diffusion of light needs to know of matter.
struct Diffusion {
    double scattering, extinction;  ///< reduced coefficients
    double coefficient;             ///< Grosjean's, which holds for strong absorption too
    double decay;                   ///< effective transport coefficient
    double mirror;                  ///< depth that sources are mirrored about, negative
    double fluence_part, flux_part; ///< of fluence and flux in what leaves

    Diffusion(const ScatteringMatter& m, double moment1, double moment2)
        : scattering(m.albedo * (1 - m.g)), extinction(1 - m.albedo + scattering),
          coefficient((2 * (1 - m.albedo) + scattering) / (3 * extinction * extinction)),
          decay(std::sqrt((1 - m.albedo) / coefficient)),
          mirror(-2 * coefficient * (1 + 3 * moment2) / (1 - 2 * moment1)),
          fluence_part((1 - 2 * moment1) / 4), flux_part((1 - 3 * moment2) / 2) {}

    /// Light that leaves at the distance r from the beam of what a source at the depth sends out.
    double exitance(double depth, double r) const {
        const double mirrored = 2 * mirror - depth;
        const double d = length_of(r, depth), dm = length_of(r, mirrored);
        const double e = std::exp(-decay * d), em = std::exp(-decay * dm);
        const double fluence = (e / d - em / dm) / (4 * pi_d * coefficient);
        const double flux =
            (depth * (1 + decay * d) * e / (d * d * d) - mirrored * (1 + decay * dm) * em / (dm * dm * dm)) /
            (4 * pi_d);
        // Diffusion is wrong near the source, where light was scattered once only; this takes it back.
        const double correction = 1 - std::exp(-2 * extinction * (d + depth));
        return correction * (fluence * fluence_part + flux * flux_part);
    }
};

double multiple_scattering(const Diffusion& d, double r, int samples) {
    const double reduced_albedo = d.scattering / d.extinction;
    return reduced_albedo * reduced_albedo * over_depth(r, d.extinction, samples, [&](double depth) {
               return d.extinction * std::exp(-d.extinction * depth) * d.exitance(depth, r);
           });
}

} // namespace

double multiple_scattering(const ScatteringMatter& matter, double r, int samples) {
    const Diffusion diffusion(matter, fresnel_moment(matter.eta, 1, true),
                              fresnel_moment(matter.eta, 2, true));
    return multiple_scattering(diffusion, r, samples);
}

DiffusionTable::DiffusionTable(float g, float eta)
    : eta_(eta),
      transmittance_(static_cast<float>(1 - 2 * fresnel_moment(static_cast<double>(eta), 1, false))),
      albedos_(albedo_count), radii_(radius_count), radial_(albedo_count * radius_count),
      cdf_(radial_.size()), effective_(albedo_count) {
    // Dense where profiles change: at small radii, and where nearly all light is scattered.
    // The largest is 200 lengths over which light forgets its direction.
    radii_[1] = 2.5e-3f;
    const double largest = 200 / (1 - std::max(0.0, static_cast<double>(g)));
    const double growth = std::pow(largest / 2.5e-3, 1.0 / (radius_count - 2));
    for (std::size_t i = 2; i < radius_count; ++i)
        radii_[i] = static_cast<float>(2.5e-3 * std::pow(growth, static_cast<double>(i - 1)));
    for (std::size_t i = 0; i < albedo_count; ++i) {
        const double x = static_cast<double>(i) / (albedo_count - 1);
        albedos_[i] = static_cast<float>(std::expm1(-8 * x) / std::expm1(-8));
    }
    const double moment1 = fresnel_moment(static_cast<double>(eta), 1, true);
    const double moment2 = fresnel_moment(static_cast<double>(eta), 2, true);
    auto tabulate = [&](std::size_t i) {
        const ScatteringMatter matter{static_cast<double>(albedos_[i]), static_cast<double>(g),
                                      static_cast<double>(eta)};
        const Diffusion diffusion(matter, moment1, moment2);
        const auto row = std::span(radial_).subspan(i * radius_count, radius_count);
        for (std::size_t j = 1; j < radius_count; ++j) {
            const auto r = static_cast<double>(radii_[j]);
            const double exitance = single_scattering(matter, r) + multiple_scattering(diffusion, r, 100);
            row[j] = static_cast<float>(std::max(0.0, 2 * pi_d * r * exitance));
        }
        const auto cdf = std::span(cdf_).subspan(i * radius_count, radius_count);
        effective_[i] = integrate_spline(radii_, row, cdf);
        // The method adds some light where hardly any is absorbed: 2 % at g = 0, more where g < 0.
        if (effective_[i] <= 1) return;
        for (float& v : row) v /= effective_[i];
        effective_[i] = integrate_spline(radii_, row, cdf);
    };
    // Who shares tables holds a lock while one is made.
    parallel_ranges(albedo_count, 4, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) tabulate(i);
    });
}

float DiffusionTable::radial(const SplineWeights& row, float r) const {
    if (!(r < radii_.back())) return 0;
    const SplineWeights column = spline_weights(radii_, r);
    float sum = 0;
    for (std::size_t j = 0; j < 4; ++j)
        if (column.weight[j] != 0)
            sum += column.weight[j] * row.sum(radial_.data() + column.first + j, radius_count);
    return std::max(0.0f, sum);
}

float DiffusionTable::sample_radius(const SplineWeights& row, float u) const {
    auto cdf = [&](std::size_t j) { return row.sum(cdf_.data() + j, radius_count); };
    const float wanted = u * cdf(radius_count - 1);
    std::size_t lo = 0, hi = radius_count - 1;
    while (hi - lo > 1) {
        const std::size_t middle = (lo + hi) / 2;
        (cdf(middle) <= wanted ? lo : hi) = middle;
    }
    const SplinePiece piece = spline_piece(
        radii_, [&](std::size_t j) { return row.sum(radial_.data() + j, radius_count); }, lo);
    return radii_[lo] + piece.width * piece.invert_integral(wanted - cdf(lo));
}

float DiffusionTable::albedo_for(float effective_albedo) const {
    return invert_spline(albedos_, effective_, effective_albedo);
}

} // namespace alhazen
