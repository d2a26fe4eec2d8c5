#include "shapes/spherical_triangle.h"

namespace alhazen {

namespace {

// Solid angles (steradians) between which triangles are sampled by solid angle: smaller ones lose digits,
// larger ones are left to BSDF sampling (Pharr, Jakob and Humphreys 2023, section 6.5.4).
constexpr float least_solid_angle = 3e-4f;
constexpr float largest_solid_angle = 6.22f;

} // namespace

SphericalTriangle::SphericalTriangle(Vec3 pa, Vec3 pb, Vec3 pc, Vec3 eye) {
    const Vec3 a = pa - eye, b = pb - eye, c = pc - eye;
    inverse_distance_ = {1 / length(a), 1 / length(b), 1 / length(c)};
    const Vec3 inverse = inverse_distance_;
    ab_ = dot(a, b) * (inverse.x * inverse.y);
    bc_ = dot(b, c) * (inverse.y * inverse.z);
    ca_ = dot(c, a) * (inverse.z * inverse.x);
    // From the sides, which are exact where the corners seem close together.
    volume_ = std::abs(dot(a, cross(pb - pa, pc - pa))) * inverse.x * inverse.y * inverse.z;
    solid_angle_ = 2 * std::atan2(volume_, 1 + ab_ + bc_ + ca_);
}

Vec2 SphericalTriangle::sample(Vec2 u) const {
    // The end of the arc from b, d, is a mirrored at h = g a + k c, where
    // tan(area of (a, b, d) / 2) = det(a, b, h) / dot(a + b, h).
    const float half = 0.5f * solid_angle_ * u.x;
    const float s = std::sin(half), t = std::cos(half);
    const float g = volume_ * t - (ca_ + bc_) * s, k = (1 + ab_) * s;
    const float mirror = 2 * (g + k * ca_) / (g * g + k * k + 2 * g * k * ca_);
    const float d_a = mirror * g - 1, d_c = mirror * k;
    // Equal steps of the cosine along the arc are equal areas.
    const float bd = d_a * ab_ + d_c * bc_;
    const float cosine = 1 + (bd - 1) * u.y;
    const float w_d = safe_sqrt(u.y * (1 + cosine) / (1 + bd)), w_b = cosine - w_d * bd;
    // The direction is now a sum of directions to the corners; its multiple in their plane is wanted.
    const float a = std::max(0.0f, w_d * d_a) * inverse_distance_.x;
    const float b = std::max(0.0f, w_b) * inverse_distance_.y;
    const float c = std::max(0.0f, w_d * d_c) * inverse_distance_.z;
    const float scale = 1 / (a + b + c);
    return {std::min(b * scale, 1.0f), std::min(c * scale, 1 - std::min(b * scale, 1.0f))};
}

float sampled_solid_angle(const SphericalTriangle& seen) {
    float solid_angle = seen.solid_angle();
    return solid_angle >= least_solid_angle && solid_angle <= largest_solid_angle ? solid_angle : 0;
}

} // namespace alhazen
