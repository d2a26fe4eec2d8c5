/// A photographic lens as its maker's table gives it: spherical surfaces on one axis and an aperture stop,
/// through which rays from the film are refracted exactly (Kolb, Mitchell and Hanrahan 1995, "A Realistic
/// Camera Model for Computer Graphics"). Camera space: z along the axis towards the scene, the film's plane
/// is z = 0. Metres.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/vec.h"

namespace alhazen {

class ApertureMask; // cameras/aperture_mask.h

/// One row of the table.
struct LensSurface {
    double radius; ///< of curvature; > 0: the centre lies on the film's side. 0: the aperture stop, a plane
    double thickness; ///< from here to the next surface towards the film; the last one's: to the film
    double eta;       ///< refractive index between the two
    double opening;   ///< radius of what lets light through

    bool is_stop() const { return radius == 0; }
};

/// The rows of a lens file as pbrt has them, from the scene's side to the film's: radius, thickness,
/// refractive index and diameter of the opening, in mm; # begins a comment, index 0 is air, radius 0 the
/// aperture stop. Throws std::runtime_error with the line.
std::vector<LensSurface> parse_lens(std::string_view text);

/// Where thin lens formulas hold for a thick one (Gauss 1840): distances count from the principal planes.
struct ThickLens {
    double focal_length;                    ///< not positive or not finite: brings nothing into focus
    double front_principal, rear_principal; ///< z
};

struct LensRay {
    Vec3d o, d;
    double weight = 1; ///< what the aperture lets through
};

class LensSystem {
  public:
    explicit LensSystem(std::vector<LensSurface> surfaces) : surfaces_(std::move(surfaces)) {}

    const std::vector<LensSurface>& surfaces() const { return surfaces_; }
    /// nullptr when there is none.
    const LensSurface* stop() const;
    void set_stop(double opening);

    /// By paraxial rays.
    ThickLens thick_lens() const;
    /// Moves the whole lens so that what is sharp lies at this distance from the film. Returns "", or says
    /// why that cannot be.
    std::string focus(double distance);

    /// z of the last surface's vertex.
    double rear_z() const { return surfaces_.back().thickness; }
    double rear_opening() const { return surfaces_.back().opening; }
    double front_z() const;

    /// A ray from the film's side (d.z > 0) through all surfaces to the scene's side; nullopt where it is
    /// stopped. A mask takes the place of the stop's round opening.
    std::optional<LensRay> trace(Vec3d o, Vec3d d, const ApertureMask* mask = nullptr,
                                 double opened = 1) const;

  private:
    std::vector<LensSurface> surfaces_;
};

/// Where rays from the film must go to pass the lens: for each of 64 rings of the film a rectangle in the
/// plane of the last surface's vertex, found by trying.
class ExitPupil {
  public:
    ExitPupil() = default;
    /// film_radius: half of its diagonal.
    ExitPupil(const LensSystem& lens, double film_radius);

    struct Sample {
        Vec3d p;
        double area; ///< of the rectangle that p was chosen from, uniformly
    };
    /// nullopt where no light reaches the film.
    std::optional<Sample> sample(Vec2d film, Vec2 u) const;

  private:
    /// For places on the film's x axis: x from lo to hi, y from -half to half.
    struct Rectangle {
        double lo = 0, hi = 0, half = 0;
    };
    static constexpr std::size_t rings = 64;
    static Rectangle bound(const LensSystem& lens, double film_lo, double film_hi);
    static Rectangle bound(const LensSystem& lens, double film_lo, double film_hi, const Rectangle& within,
                           double opened);

    std::vector<Rectangle> rectangles_;
    double film_radius_ = 1, z_ = 0;
};

} // namespace alhazen
