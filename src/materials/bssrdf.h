/// Light that goes into a surface at one point, spreads beneath it, and comes out at others: a separable
/// BSSRDF (Jensen et al. 2001; Pharr et al. 2016, sections 11.4 and 15.4). How far it spreads depends on the
/// distance alone, as beneath a plane of the same matter everywhere; which way it leaves, on the border
/// alone.
///
/// To find where it leaves, a ray is sent through the neighbourhood, along the normal or across it, so far
/// beside the point as the light would spread (King et al. 2013, "BSSRDF importance sampling"). All the
/// places where it passes the surface are candidates.
#pragma once

#include <array>
#include <optional>

#include "base/arena.h"
#include "color/wavelengths.h"
#include "materials/beam_diffusion.h"
#include "materials/bsdf.h"

namespace alhazen {

/// How light leaves that comes from beneath: as it would come in, so that all that leaves sums to 1.
struct ExitBsdf final : Bsdf {
    float eta;   ///< index below over above
    float scale; ///< 1 over what would get through of even light from above, times pi

    ExitBsdf(float eta_, float transmittance) : eta(eta_), scale(1 / (transmittance * pi)) {}

    Scatter eval(Vec3 wo, Vec3 wi, TransportMode mode) const override;
    std::optional<BsdfSample> sample(Vec3 wo, float u, Vec2 u2, TransportMode mode) const override;
    Lobes lobes() const override { return Lobes::reflection | Lobes::diffuse; }
};

/// At one point, with coefficients per length of the world. Plain numbers, made in an Arena.
struct Bssrdf {
    Bssrdf(const DiffusionTable& table, Spectrum sigma_a, Spectrum sigma_s, const Wavelengths& lambda);

    /// Light per area that leaves at the distance, of unit power going in.
    Spectrum eval(float distance) const;

    /// All the light that leaves, of unit power going in.
    Spectrum total() const;
    /// The farthest that probes go.
    float reach() const;

    /// A straight way through the neighbourhood, in a frame whose origin is the point and whose z its normal.
    struct Probe {
        Vec3 from, to;
    };
    /// u chooses the axis and a wavelength; nullopt when the sample is lost, as is always the case where no
    /// light comes out.
    std::optional<Probe> sample(float u, Vec2 u2) const;
    /// Density per area of meeting a surface at the offset, of unit normal n, by sample()'s probes; both in
    /// that frame.
    float pdf(Vec3 offset, Vec3 n) const;

    const ExitBsdf exit_bsdf;

  private:
    struct Lane {
        float sigma_t = 0;
        SplineWeights row;
        float reach = 0; ///< beyond it nothing is sampled
        float effective_albedo = 0;
    };
    float radial_pdf(const Lane& lane, float r) const;

    const DiffusionTable* table_;
    std::array<Lane, 4> lanes_;
    bool is_rgb_;
    std::array<int, 4> sampled_{}; ///< the lanes of which some light comes out
    int sampled_count_ = 0;
};

} // namespace alhazen
