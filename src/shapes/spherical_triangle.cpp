#include "shapes/spherical_triangle.h"

namespace alhazen {

namespace {

constexpr double pi_double = 3.14159265358979323846;

// The part of v across the unit vector n, at unit length.
Vec3d across(Vec3d v, Vec3d n) {
    return normalize(v - n * dot(v, n));
}

double angle_between(Vec3d u, Vec3d v) {
    return std::atan2(length(cross(u, v)), dot(u, v));
}

} // namespace

Vec3d SphericalTriangle::sample(Vec2d u) const {
    // The inner angles; their sum exceeds pi by the area (Girard).
    double alpha = angle_between(across(b, a), across(c, a));
    double beta = angle_between(across(a, b), across(c, b));
    double gamma = angle_between(across(a, c), across(b, c));
    double area = alpha + beta + gamma - pi_double;

    // The triangle a b c' of area u.x * area has the angle alpha at a; find c' on the side from a to c.
    double part = u.x * area;
    double s = std::sin(part - alpha), t = std::cos(part - alpha);
    double p = t - std::cos(alpha), q = s + std::sin(alpha) * dot(a, b);
    double below = (q * s + p * t) * std::sin(alpha);
    double cos_side = below != 0 ? ((q * t - p * s) * std::cos(alpha) - q) / below : 1;
    cos_side = std::clamp(cos_side, -1.0, 1.0);
    Vec3d c2 = a * cos_side + across(c, a) * std::sqrt(1 - cos_side * cos_side);

    // A place on the arc from b to c': equal steps of the cosine are equal areas.
    double h = u.y * (1 - dot(c2, b));
    return normalize(b * (1 - h) + across(c2, b) * std::sqrt(std::max(0.0, h * (2 - h))));
}

} // namespace alhazen
