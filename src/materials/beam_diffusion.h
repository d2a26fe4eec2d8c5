/// How far light spreads beneath the surface of scattering matter: photon beam diffusion (Habel, Christensen
/// and Jarosz 2013, "Photon beam diffusion: a hybrid Monte Carlo method for subsurface scattering"; Pharr et
/// al. 2016, section 15.5). Picture a thin beam shot straight into a half space of milk: all along its way
/// in, light is scattered off it. Each such spot sends some light out directly (single scattering), and the
/// rest is spread as by diffusion, with a mirrored spot above the surface for what the border does (multiple
/// scattering). All lengths here are in mean free paths.
#pragma once

#include <span>
#include <vector>

#include "math/catmull_rom.h"

namespace alhazen {

/// Matter of mean free path 1, in a half space.
struct ScatteringMatter {
    double albedo = 0; ///< fraction of a collision's light that is scattered
    double g = 0;      ///< mean cosine of scattering
    double eta = 1.33; ///< index of refraction below over above; at least 1
};

/// Integral of the border's Fresnel reflectance, from below (is_inside) or above, times the cosine's power,
/// over the cosine from 0 to 1 (the moments of d'Eon and Irving 2011).
double fresnel_moment(double eta, int power, bool is_inside);

/// Light that leaves per area at the distance r > 0 from a beam of unit power that goes in perpendicularly;
/// from so many points along the beam.
double single_scattering(const ScatteringMatter& matter, double r, int samples = 100);
double multiple_scattering(const ScatteringMatter& matter, double r, int samples = 100);

/// Both, tabulated over the albedo and the radius for one g and eta, with splines in between.
class DiffusionTable {
  public:
    DiffusionTable(float g, float eta);

    float eta() const { return eta_; }
    /// Of light that meets the border from above evenly from all sides, the part that gets through.
    float transmittance() const { return transmittance_; }

    /// The row for an albedo, to be passed to what follows.
    SplineWeights row(float albedo) const { return spline_weights(albedos_, albedo); }
    /// 2 pi r times the light that leaves at the distance r, r >= 0: its density over the radius. 0 beyond
    /// the table's largest radius.
    float radial(const SplineWeights& row, float r) const;
    /// All the light that leaves.
    float effective_albedo(const SplineWeights& row) const { return row.sum(effective_.data()); }
    /// A radius in proportion to radial(); u in [0, 1).
    float sample_radius(const SplineWeights& row, float u) const;

    /// The albedo of matter with that effective albedo, 0 ... 1; clamped to what there can be.
    float albedo_for(float effective_albedo) const;

    std::span<const float> albedos() const { return albedos_; }
    std::span<const float> radii() const { return radii_; }

  private:
    float eta_ = 1, transmittance_ = 1;
    std::vector<float> albedos_, radii_;
    std::vector<float> radial_, cdf_; ///< a row of radii for each albedo
    std::vector<float> effective_;
};

} // namespace alhazen
