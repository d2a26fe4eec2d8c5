/// The tables of a measured material (Dupuy and Jakob 2018, "An adaptive parameterization for efficient
/// material acquisition and rendering"). Picture the usual microfacet formula, with its parts measured
/// instead of assumed: how the facets' normals are spread (ndf), how much area they show (sigma), which of
/// them are seen (vndf); and what is left of the reflection when these are taken away (spectra), which is so
/// smooth that small tables hold it. Tables over directions have them as points of the unit square: across
/// the polar angle, denser towards the pole, and down the azimuth.
#pragma once

#include <vector>

#include "color/wavelengths.h"
#include "materials/tensor_file.h"
#include "math/bilinear_tables.h"

namespace alhazen {

struct MeasuredData {
    /// Throws std::runtime_error that says what is wrong with which field. In RGB mode the spectra become
    /// three tables, of the colours they show under D65.
    MeasuredData(const TensorFile& file, ColorMode mode);

    /// A unit vector above the surface as a point of the square; turned: azimuth that counts as 0.
    static Vec2 to_square(Vec3 w, float turned = 0);
    static Vec3 from_square(Vec2 u, float turned = 0);
    /// Solid angle per area of the square there.
    static float solid_angle(Vec2 u);

    /// Of a direction, within the turn that phi covers.
    float azimuth_of(Vec3 w) const {
        const float azimuth = std::atan2(w.y, w.x);
        return azimuth < phi.front() ? azimuth + 2 * pi : azimuth > phi.back() ? azimuth - 2 * pi : azimuth;
    }

    bool is_isotropic = true;       ///< azimuths count from that of the direction seen from
    bool has_facet_factor = true;   ///< the spectra lack the factor ndf / (4 sigma)
    std::vector<float> theta, phi;  ///< of the directions seen from: one table of a series for each pair
    std::vector<float> wavelengths; ///< nm; none in RGB mode
    BilinearTables ndf, sigma;
    BilinearDensities vndf;      ///< of facets' normals, by the direction seen from
    BilinearDensities luminance; ///< of points that vndf maps to normals
    BilinearTables spectra;      ///< over the same points, for each wavelength or colour
};

} // namespace alhazen
