/// What several lights share: colours in the units of pictures, directions to a point, and the scene's
/// extent.
#pragma once

#include <limits>
#include <optional>

#include "base/bounds.h"
#include "base/frame.h"
#include "base/transform.h"
#include "color/spectrum_value.h"
#include "describe/scene_description.h"
#include "describe/spectrum_parameter.h"
#include "math/warp.h"

namespace alhazen {

/// The default colour of lights.
inline IlluminantSpectrum white_light() {
    return {SpectrumValue::illuminant_rgb(srgb_space(), Vec3(1)), "the colour space's illuminant"};
}
/// The same in the colour space that is in effect at the light, where the light's parameter of that name is
/// not given.
inline void take_default_color(const Node& light, std::string_view parameter, IlluminantSpectrum& color) {
    if (light.color_space && !light.find(parameter))
        color.value = SpectrumValue::illuminant_rgb(*light.color_space, Vec3(1));
}

/// The colour times scale in pbrt-v4's units: what a light emits in the given mode (see SpectrumValue's
/// light_scale).
inline SpectrumValue calibrated(const SpectrumValue& color, float scale, ColorMode mode) {
    return color.scaled(scale * color.light_scale(mode));
}

/// How bright a colour is, for choosing among lights: the mean of its linear sRGB, negative lanes left out,
/// which is positive for every light that can be seen.
inline float brightness(const SpectrumValue& color) {
    Vec3 rgb = max(color.linear_srgb(), Vec3(0));
    return (rgb.x + rgb.y + rgb.z) / 3;
}

/// A photometric target ("power", "illuminance") that is absent or not positive is none, as in pbrt-v4.
inline bool is_given(const std::optional<float>& target) {
    return target && *target > 0;
}

struct Direction {
    Vec3 w; ///< unit
    float distance_squared = 0;
};
/// The direction between two points; nullopt when they are too close or too far apart to say.
inline std::optional<Direction> direction_between(Vec3 from, Vec3 to) {
    Vec3 d = to - from;
    float d2 = length_squared(d);
    if (!(d2 >= std::numeric_limits<float>::min() && d2 < infinity)) return std::nullopt;
    return Direction{d / std::sqrt(d2), d2};
}

/// Whether the transformation keeps angles (up to mirroring), to within one in a thousand.
inline bool keeps_angles(const Transform& t) {
    Vec3 x = t.vector(Vec3{1, 0, 0}), y = t.vector(Vec3{0, 1, 0}), z = t.vector(Vec3{0, 0, 1});
    float s = length_squared(x), tolerance = 1e-3f * s;
    auto near = [&](float a, float b) { return std::abs(a - b) <= tolerance; };
    return near(length_squared(y), s) && near(length_squared(z), s) && near(dot(x, y), 0) &&
           near(dot(y, z), 0) && near(dot(z, x), 0);
}

/// A light's own space, for directions.
class LightSpace {
  public:
    LightSpace() = default;
    explicit LightSpace(const Transform& world_from_light)
        : world_from_light_(world_from_light),
          determinant_(static_cast<float>(std::abs(1 / world_from_light.matrix().determinant3()))) {}

    Vec3 to_light(Vec3 d) const { return normalize(world_from_light_.inverse_vector(d)); }
    Vec3 to_world(Vec3 w) const { return normalize(world_from_light_.vector(w)); }
    /// Solid angle in the light's space over that in the world around the unit vector d of the world; 1
    /// unless the transformation stretches.
    float stretch(Vec3 d) const {
        float l2 = length_squared(world_from_light_.inverse_vector(d));
        return determinant_ / (l2 * std::sqrt(l2));
    }
    const Transform& world_from_light() const { return world_from_light_; }

  private:
    Transform world_from_light_;
    float determinant_ = 1; ///< of the transformation from world to light, without sign
};

/// The sphere around the scene, which infinitely distant light shines through.
struct SceneExtent {
    Vec3 center;
    float radius = 0;

    void set(const Bounds3& scene) {
        Sphere3 sphere = bounding_sphere(scene);
        center = sphere.center;
        radius = sphere.radius;
    }
    /// A point from p along the unit vector w that no part of the scene lies behind (p being in the scene).
    Vec3 beyond(Vec3 p, Vec3 w) const {
        // A little more than the diameter, since shadow rays stop a little short.
        return p + w * (radius > 0 ? 2.01f * radius : 1.0f);
    }
    float disk_area() const { return pi * radius * radius; }
    /// A point before the scene from which a ray along the unit vector d shines through it: of a disk as
    /// large as the sphere, all of it alike.
    Vec3 before(Vec3 d, Vec2 u) const {
        Vec2 disk = sample_disk(u) * radius;
        Frame frame = Frame::from_z(d);
        return center + frame.x * disk.x + frame.y * disk.y - d * (1.01f * radius);
    }
};

} // namespace alhazen
