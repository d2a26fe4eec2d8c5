#include "accel/build/clip.h"

#include <array>

namespace alhazen {

namespace {

// A triangle that loses a corner to each of six planes has nine at most.
struct Polygon {
    std::array<Vec3d, 9> corner;
    std::size_t count = 0;

    void add(Vec3d p) { corner[count++] = p; }
};

// The part of the polygon where sign * coordinate <= sign * plane.
Polygon cut(const Polygon& polygon, int axis, double plane, double sign) {
    Polygon inside;
    for (std::size_t i = 0; i < polygon.count; ++i) {
        const Vec3d p = polygon.corner[i], q = polygon.corner[i + 1 < polygon.count ? i + 1 : 0];
        const double dp = sign * (p[axis] - plane), dq = sign * (q[axis] - plane);
        if (dp <= 0) inside.add(p);
        if ((dp < 0 && dq > 0) || (dp > 0 && dq < 0)) {
            // From the corner inside, so that neighbours that share the edge find the same point.
            const Vec3d a = dp < 0 ? p : q, b = dp < 0 ? q : p;
            const double t = (plane - a[axis]) / (b[axis] - a[axis]);
            Vec3d crossing = a + (b - a) * t;
            crossing[axis] = plane;
            inside.add(crossing);
        }
    }
    return inside;
}

float rounded_down(double v) {
    auto f = static_cast<float>(v);
    return static_cast<double>(f) > v ? std::nextafter(f, -infinity) : f;
}
float rounded_up(double v) {
    return -rounded_down(-v);
}

} // namespace

Bounds3 clipped_bounds(const Corners& triangle, const Bounds3& box) {
    Polygon polygon;
    for (Vec3 p : {triangle.a, triangle.b, triangle.c}) polygon.add(Vec3d(p));
    for (int axis = 0; axis < 3; ++axis) {
        polygon = cut(polygon, axis, static_cast<double>(box.lo[axis]), -1);
        polygon = cut(polygon, axis, static_cast<double>(box.hi[axis]), 1);
    }
    Bounds3 bounds;
    for (std::size_t i = 0; i < polygon.count; ++i) {
        const Vec3d p = polygon.corner[i];
        bounds.extend(Vec3{rounded_down(p.x), rounded_down(p.y), rounded_down(p.z)});
        bounds.extend(Vec3{rounded_up(p.x), rounded_up(p.y), rounded_up(p.z)});
    }
    return {max(bounds.lo, box.lo), min(bounds.hi, box.hi)};
}

} // namespace alhazen
