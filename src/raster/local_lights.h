/// The scene's lights as local illumination sees them: each at one point, or in one direction; what surrounds
/// the scene as spherical harmonics.
#pragma once

#include <optional>
#include <vector>

#include "raster/kernel.h"
#include "raster/spherical_harmonics.h"
#include "scene/scene.h"

namespace alhazen {

/// Light that arrives at a point.
struct ArrivingLight {
    Vec3 wi;             ///< unit, towards the light
    Spectrum irradiance; ///< on a surface across wi, if nothing is in the way
};

/// One light. Flat glowing shapes shine from their middle as a small disk of their area does: to the cosine
/// from their normal, and falling off as a disk's light on its axis, L A / (d^2 + A / pi), which is exact
/// there and keeps finite up close. Shapes that bend around shine from their middle to all sides, as a sphere
/// of their area does.
class LocalLight {
  public:
    enum class Kind {
        asked,   ///< a light without size, which says itself what arrives
        distant, ///< the same everywhere
        flat,    ///< a glowing shape that faces one way
        round,   ///< one that faces all ways
    };
    /// A light without size, or distant.
    explicit LocalLight(const Light& light);
    /// A glowing shape.
    LocalLight(const PlacedShape& placed, const Light& example);

    std::optional<ArrivingLight> at(Vec3 p) const;

    Kind kind() const { return kind_; }
    /// Where it is, but for distant lights.
    Vec3 position() const { return p_; }
    /// For distant ones: unit, towards the light.
    Vec3 direction() const { return normal_; }
    /// The directions it shines in, but for distant lights.
    struct Cone {
        Vec3 axis{0, 0, 1};
        float angle = pi; ///< half of the opening
    };
    Cone cone() const;
    /// What at() computes with, for many points at a time; not for lights that are asked.
    RasterLight numbers() const {
        return {{p_.x, p_.y, p_.z},
                {normal_.x, normal_.y, normal_.z},
                area_,
                kind_ == Kind::distant,
                kind_ == Kind::flat,
                is_two_sided_};
    }
    /// Of distant lights, irradiance; not of lights that are asked.
    Spectrum radiance() const { return radiance_; }
    /// What glows; nullptr for lights without size.
    const PlacedShape* shape() const { return shape_; }

  private:
    Kind kind_ = Kind::asked;
    const Light* light_ = nullptr;
    const PlacedShape* shape_ = nullptr;
    Vec3 p_, normal_;
    float area_ = 0; ///< as seen from straight ahead
    bool is_two_sided_ = false;
    Spectrum radiance_ = 0; ///< distant: irradiance
};

/// All of them, in linear RGB.
struct LocalLights {
    std::vector<LocalLight> lights;
    RadianceHarmonics surroundings;
    std::vector<const Light*> infinite; ///< what is seen where no surface is

    explicit LocalLights(const Scene& scene);
    Spectrum background(Vec3 origin, Vec3 direction) const;
};

} // namespace alhazen
