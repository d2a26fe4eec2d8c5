/// Axis-aligned boxes.
#pragma once

#include "base/vec.h"

namespace alhazen {

/// Axis-aligned box; empty when lo > hi (as constructed).
struct Bounds3 {
    Vec3 lo{infinity, infinity, infinity};
    Vec3 hi{-infinity, -infinity, -infinity};

    bool empty() const { return lo.x > hi.x || lo.y > hi.y || lo.z > hi.z; }
    Vec3 diagonal() const { return hi - lo; }
    Vec3 centroid() const { return lo * 0.5f + hi * 0.5f; }
    /// Half of the surface area; 0 when empty.
    float half_area() const {
        if (empty()) return 0;
        Vec3 d = diagonal();
        return d.x * d.y + d.y * d.z + d.z * d.x;
    }
    Vec3 corner(int i) const { return {i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z}; }
    bool contains(Vec3 p) const {
        return p.x >= lo.x && p.x <= hi.x && p.y >= lo.y && p.y <= hi.y && p.z >= lo.z && p.z <= hi.z;
    }
    void extend(Vec3 p) {
        lo = min(lo, p);
        hi = max(hi, p);
    }
    void extend(const Bounds3& b) {
        lo = min(lo, b.lo);
        hi = max(hi, b.hi);
    }
};

struct Sphere3 {
    Vec3 center;
    float radius = 0;
};

/// The sphere through the box's corners; radius 0 for an empty box.
inline Sphere3 bounding_sphere(const Bounds3& b) {
    if (b.empty()) return {};
    return {b.centroid(), length(b.hi - b.centroid())};
}

/// Pixels x0 <= x < x1, y0 <= y < y1.
struct Rect2i {
    Vec2i lo, hi;
    int width() const { return hi.x - lo.x; }
    int height() const { return hi.y - lo.y; }
    bool empty() const { return width() <= 0 || height() <= 0; }
    bool operator==(const Rect2i&) const = default;
};

} // namespace alhazen
