#include "materials/bssrdf.h"

#include "materials/fresnel.h"
#include "math/warp.h"

namespace alhazen {

namespace {

/// Which part of the light is left beyond the reach of probes: long ones would meet what is far away, for
/// nothing.
constexpr float left_out = 1e-3f;
constexpr float shortest = 1e-6f; ///< mean free paths: densities per area are divided by the radius

} // namespace

Scatter ExitBsdf::eval(Vec3 wo, Vec3 wi, TransportMode) const {
    if (!(wo.z > 0 && wi.z > 0)) return {};
    const float f = (1 - fresnel_dielectric(wi.z, eta)) * scale * wi.z;
    return {f, cosine_hemisphere_pdf(wi.z), cosine_hemisphere_pdf(wo.z)};
}

std::optional<BsdfSample> ExitBsdf::sample(Vec3 wo, float, Vec2 u2, TransportMode mode) const {
    const Vec3 wi = sample_cosine_hemisphere(u2);
    const Scatter s = eval(wo, wi, mode);
    if (!(s.pdf > 0)) return std::nullopt;
    return BsdfSample{wi, s.f, s.pdf, s.pdf_reverse, lobes(), 1};
}

Bssrdf::Bssrdf(const DiffusionTable& table, Spectrum sigma_a, Spectrum sigma_s, const Wavelengths& lambda)
    : exit_bsdf(table.eta(), table.transmittance()), table_(&table), is_rgb_(lambda.mode == ColorMode::rgb) {
    for (int i = 0; i < 4; ++i) {
        Lane& lane = lanes_[static_cast<std::size_t>(i)];
        const float sigma_t = sigma_a[i] + sigma_s[i];
        if (!(sigma_t > 0 && sigma_t < infinity) || !(sigma_s[i] > 0)) continue;
        lane.row = table.row(sigma_s[i] / sigma_t);
        lane.effective_albedo = table.effective_albedo(lane.row);
        if (!(lane.effective_albedo > 0)) continue;
        lane.sigma_t = sigma_t;
        lane.reach = table.sample_radius(lane.row, 1 - left_out) / sigma_t;
        // Of colours the fourth is the others' mean; of wavelengths, terminated ones count no more.
        if (is_rgb_ ? i < 3 : lambda.pdf[i] > 0) sampled_[static_cast<std::size_t>(sampled_count_++)] = i;
    }
}

Spectrum Bssrdf::eval(float distance) const {
    Spectrum s = 0;
    for (int i = 0; i < 4; ++i) {
        const Lane& lane = lanes_[static_cast<std::size_t>(i)];
        if (lane.sigma_t == 0) continue;
        const float r = std::max(distance * lane.sigma_t, shortest);
        s.set(i, table_->radial(lane.row, r) * sqr(lane.sigma_t) / (2 * pi * r));
    }
    if (is_rgb_) s.set(3, (s[0] + s[1] + s[2]) / 3);
    return s;
}

Spectrum Bssrdf::total() const {
    Spectrum s = 0;
    for (int i = 0; i < 4; ++i) s.set(i, lanes_[static_cast<std::size_t>(i)].effective_albedo);
    if (is_rgb_) s.set(3, (s[0] + s[1] + s[2]) / 3);
    return s;
}

float Bssrdf::reach() const {
    float reach = 0;
    for (const Lane& lane : lanes_) reach = std::max(reach, lane.reach);
    return reach;
}

std::optional<Bssrdf::Probe> Bssrdf::sample(float u, Vec2 u2) const {
    if (sampled_count_ == 0) return std::nullopt;
    // Along the normal half of the time, a quarter across it each way.
    const int choice =
        std::min(static_cast<int>(u * static_cast<float>(4 * sampled_count_)), 4 * sampled_count_ - 1);
    const Lane& lane = lanes_[static_cast<std::size_t>(sampled_[static_cast<std::size_t>(choice / 4)])];
    const float r = table_->sample_radius(lane.row, u2.x) / lane.sigma_t, phi = 2 * pi * u2.y;
    if (!(r < lane.reach)) return std::nullopt;
    const float half = lane.reach * safe_sqrt(1 - sqr(r / lane.reach)), a = r * std::cos(phi),
                b = r * std::sin(phi);
    switch (choice % 4) {
    case 0:
        return Probe{{-half, a, b}, {half, a, b}};
    case 1:
        return Probe{{b, -half, a}, {b, half, a}};
    default:
        return Probe{{a, b, -half}, {a, b, half}};
    }
}

float Bssrdf::radial_pdf(const Lane& lane, float r) const {
    const float optical = std::max(r * lane.sigma_t, shortest);
    return table_->radial(lane.row, optical) * sqr(lane.sigma_t) / (2 * pi * optical * lane.effective_albedo);
}

float Bssrdf::pdf(Vec3 offset, Vec3 n) const {
    const float distance = length(offset);
    float sum = 0;
    for (int i = 0; i < sampled_count_; ++i) {
        const Lane& lane = lanes_[static_cast<std::size_t>(sampled_[static_cast<std::size_t>(i)])];
        if (!(distance < lane.reach)) continue;
        sum += 0.25f * std::abs(n.x) * radial_pdf(lane, std::hypot(offset.y, offset.z)) +
               0.25f * std::abs(n.y) * radial_pdf(lane, std::hypot(offset.z, offset.x)) +
               0.5f * std::abs(n.z) * radial_pdf(lane, std::hypot(offset.x, offset.y));
    }
    return sampled_count_ > 0 ? sum / static_cast<float>(sampled_count_) : 0;
}

} // namespace alhazen
