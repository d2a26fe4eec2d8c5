/// What several lights share: colours in the units of pictures, directions to a point, and the scene's
/// extent.
#pragma once

#include <limits>
#include <optional>

#include "base/bounds.h"
#include "base/transform.h"
#include "color/spectrum_value.h"
#include "describe/spectrum_parameter.h"

namespace alhazen {

/// The default colour of lights.
inline IlluminantSpectrum white_light() {
    return {SpectrumValue::illuminant_rgb(srgb_space(), Vec3(1)), "the colour space's illuminant"};
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

/// The sphere around the scene, which infinitely distant light shines through.
struct SceneExtent {
    float radius = 0;

    void set(const Bounds3& scene) { radius = bounding_sphere(scene).radius; }
    /// A point from p along the unit vector w that no part of the scene lies behind (p being in the scene).
    Vec3 beyond(Vec3 p, Vec3 w) const {
        // A little more than the diameter, since shadow rays stop a little short.
        return p + w * (radius > 0 ? 2.01f * radius : 1.0f);
    }
    float disk_area() const { return pi * radius * radius; }
};

} // namespace alhazen
