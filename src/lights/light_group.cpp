#include "lights/light_tree.h"

namespace alhazen {
namespace {

struct Cone {
    Vec3 axis;
    float angle;
};

/// v turned about the unit vector k (Rodrigues).
Vec3 turn(Vec3 v, Vec3 k, float angle) {
    float c = std::cos(angle), s = std::sin(angle);
    return v * c + cross(k, v) * s + k * (dot(k, v) * (1 - c));
}

/// The smallest cone that holds both; its axis lies between theirs.
Cone merge_cones(const Cone& a, const Cone& b) {
    if (b.angle > a.angle) return merge_cones(b, a);
    Vec3 across = cross(a.axis, b.axis);
    float sin_between = length(across);
    float between = std::atan2(sin_between, dot(a.axis, b.axis));
    if (std::min(between + b.angle, pi) <= a.angle) return a;
    float angle = (a.angle + between + b.angle) / 2;
    if (angle >= pi || sin_between == 0) return {a.axis, pi};
    return {normalize(turn(a.axis, across / sin_between, angle - a.angle)), angle};
}

} // namespace

LightGroup::LightGroup(const LightBounds& b)
    : bounds(b.bounds), axis(b.axis), normal_angle(std::acos(std::clamp(b.cos_normals, -1.0f, 1.0f))),
      falloff_angle(std::acos(std::clamp(b.cos_falloff, -1.0f, 1.0f))), power(b.power),
      two_sided(b.two_sided) {}

void LightGroup::merge(const LightGroup& other) {
    if (other.bounds.empty()) return;
    if (bounds.empty()) {
        *this = other;
        return;
    }
    Cone cone = merge_cones({axis, normal_angle}, {other.axis, other.normal_angle});
    axis = cone.axis;
    normal_angle = cone.angle;
    falloff_angle = std::max(falloff_angle, other.falloff_angle);
    bounds.extend(other.bounds);
    power += other.power;
    two_sided = two_sided || other.two_sided;
}

float LightGroup::cost() const {
    if (bounds.empty()) return 0;
    // The solid angle of the normals' cone, and of the rim around it weighted by the cosine from its inner
    // edge.
    float rim = std::min(normal_angle + falloff_angle, pi);
    float sin_o = std::sin(normal_angle), cos_o = std::cos(normal_angle);
    float omega =
        2 * pi * (1 - cos_o) +
        pi / 2 * (2 * rim * sin_o - std::cos(normal_angle - 2 * rim) - 2 * normal_angle * sin_o + cos_o);
    // Lights on a line have boxes without surface, whose lengths must count still.
    float extent = bounds.half_area() + 0.01f * length_squared(bounds.diagonal());
    return power * omega * extent;
}

} // namespace alhazen
