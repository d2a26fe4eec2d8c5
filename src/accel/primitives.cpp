#include "accel/primitives.h"

#include "accel/triangle.h"
#include "base/big_array.h"
#include "base/lanes.h"
#include "base/threads.h"

namespace alhazen {

namespace {

// Units in the last place by which a triangle test may miss laterally, over the extent of the triangle: Woop
// et al. count five, the rest is for the products of the edge functions.
constexpr float test_rounding = 8 * 0x1p-24f;
// The same of the coordinates, for bounds that were rounded themselves.
constexpr float bounds_rounding = 2 * 0x1p-24f;

constexpr float largest = std::numeric_limits<float>::max();

// A box in two registers; the fourth lanes mean nothing.
struct LaneBounds {
    Lanes4 lo, hi;

    // As padded().
    Bounds3 padded() const {
        const Lanes4 size = hi - lo, magnitude = max_lanes(max_lanes(-lo, lo), max_lanes(-hi, hi));
        const float longest = std::max(std::max(size[0], size[1]), size[2]);
        const Lanes4 pad = all_lanes(test_rounding * longest) + magnitude * bounds_rounding;
        return {to_vec3(max_lanes(lo - pad, all_lanes(-largest))),
                to_vec3(min_lanes(hi + pad, all_lanes(largest)))};
    }
};

// Whether the corners lie on one line. Mostly the sign of one edge function says no, without more digits.
bool has_no_area(const Corners& t) {
    const Vec3 e = t.b - t.a, f = t.c - t.a;
    const Vec3 left{e.y * f.z, e.z * f.x, e.x * f.y}, right{e.z * f.y, e.x * f.z, e.y * f.x};
    const Vec3 rounding = (abs(left) + abs(right)) * 0x1p-20f, area = abs(left - right);
    if (area.x > rounding.x || area.y > rounding.y || area.z > rounding.z) return false;
    return triangle_detail::is_degenerate(t.a, t.b, t.c);
}

Bounds3 padded_triangle(const Corners& t) {
    const Lanes4 a = to_lanes(t.a), b = to_lanes(t.b), c = to_lanes(t.c);
    // What is not finite becomes NaN, which stays, and might not show in the box.
    const Lanes4 zero = (a - a) + (b - b) + (c - c);
    if (!(zero[0] + zero[1] + zero[2] == 0) || has_no_area(t)) return {};
    return LaneBounds{min_lanes(min_lanes(a, b), c), max_lanes(max_lanes(a, b), c)}.padded();
}

Bounds3 padded_custom(const Bounds3& box) {
    bool can_be_hit = is_finite(box.lo) && is_finite(box.hi) && !box.empty();
    return can_be_hit ? padded(box) : Bounds3{};
}

} // namespace

PrimitiveKinds Primitives::kinds() const {
    return parallel_sum(
        count(), 16384, PrimitiveKinds{},
        [this](PrimitiveKinds& kinds, std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) kinds.add(kind(static_cast<std::uint32_t>(i)));
        },
        [](PrimitiveKinds& kinds, const PrimitiveKinds& part) { kinds.add(part); });
}

Vec3 padding(const Bounds3& box) {
    Vec3 magnitude = max(abs(box.lo), abs(box.hi));
    return Vec3(test_rounding * max_component(box.diagonal())) + magnitude * bounds_rounding;
}

Bounds3 padded(const Bounds3& box) {
    return LaneBounds{to_lanes(box.lo), to_lanes(box.hi)}.padded();
}

std::vector<Bounds3> padded_boxes(const Primitives& primitives) {
    const bool some_are_custom = primitives.kinds().custom;
    std::vector<Bounds3> boxes;
    boxes.reserve(primitives.count());
    prefer_huge_pages(boxes.data(), primitives.count() * sizeof(Bounds3));
    boxes.resize(primitives.count());
    parallel_ranges(boxes.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const auto p = static_cast<std::uint32_t>(i);
            const bool is_custom = some_are_custom && primitives.kind(p) == PrimitiveKind::custom;
            boxes[i] =
                is_custom ? padded_custom(primitives.bounds(p)) : padded_triangle(primitives.corners(p));
        }
    });
    return boxes;
}

} // namespace alhazen
