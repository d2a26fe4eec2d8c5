/// Colours of sigmoid spectra, and how they change with the coefficients: what fitting spectra to colours
/// (upsample.h) is made of.
#pragma once

#include <array>

#include "color/matrix3.h"
#include "color/upsample.h"

namespace alhazen {

/// The colour of a sigmoid spectrum and its derivatives after each coefficient.
struct SigmoidColor {
    Vec3d rgb;
    Matrix3 by_coefficient;
};

/// The colour's second derivatives after two coefficients. They depend on the sum m of the powers of t that
/// the two stand at only, and are listed by it.
using SigmoidCurvature = std::array<Vec3d, 5>;

/// Weights with which a spectrum's values at evenly spaced nodes sum to the linear RGB of a reflectance under
/// the space's illuminant. The sums over whole nm that define colours here are carried to the nodes by cubic
/// Lagrange interpolation between them, so few nodes do.
class SigmoidQuadrature {
  public:
    explicit SigmoidQuadrature(const RgbColorSpace& space);

    Vec3d rgb(SigmoidCoefficients c) const;
    SigmoidColor color(SigmoidCoefficients c) const;
    SigmoidCurvature curvature(SigmoidCoefficients c) const;

  private:
    static constexpr int node_step = 5, node_count = 96; // 360 to 835 nm
    struct Group {
        Spectrum t, r, g, b;
    };

    static void spread(std::array<Vec3d, node_count>& weights, int nm, Vec3d rgb);

    std::array<Group, node_count / 4> groups_;
};

} // namespace alhazen
