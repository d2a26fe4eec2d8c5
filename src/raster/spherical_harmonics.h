/// Light from all around as nine numbers: enough for what a matte surface makes of it (Ramamoorthi and
/// Hanrahan 2001, "An Efficient Representation for Irradiance Environment Maps").
#pragma once

#include <array>

#include "base/vec.h"
#include "color/spectrum.h"

namespace alhazen {

/// The real spherical harmonics of degrees 0, 1 and 2 in the unit direction w.
std::array<float, 9> spherical_harmonics(Vec3 w);

/// Radiance over directions, up to degree 2.
class RadianceHarmonics {
  public:
    /// Adds light of radiance L from a solid angle around w.
    void add(Vec3 w, Spectrum L, float solid_angle);
    /// What arrives at a surface with the unit normal n from above it. With the light cut off at degree 2,
    /// exact to a percent for most surroundings; negative values, which strong lights leave opposite to them,
    /// are 0.
    Spectrum irradiance(Vec3 n) const;
    bool is_black() const { return is_black_; }

  private:
    bool is_black_ = true;
    std::array<Spectrum, 9> coefficients_{};
};

} // namespace alhazen
