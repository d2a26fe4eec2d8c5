#include "accel/primitives.h"

#include "accel/triangle.h"
#include "base/big_array.h"
#include "base/threads.h"

namespace alhazen {

namespace {

// Units in the last place by which a triangle test may miss laterally, over the extent of the triangle: Woop
// et al. count five, the rest is for the products of the edge functions.
constexpr float test_rounding = 8 * 0x1p-24f;
// The same of the coordinates, for bounds that were rounded themselves.
constexpr float bounds_rounding = 2 * 0x1p-24f;

Bounds3 box_of(const Corners& t) {
    return {min(min(t.a, t.b), t.c), max(max(t.a, t.b), t.c)};
}

Bounds3 padded_box(const Primitives& primitives, std::uint32_t primitive) {
    Bounds3 box;
    if (primitives.kind(primitive) == PrimitiveKind::custom) {
        box = primitives.bounds(primitive);
    } else {
        Corners t = primitives.corners(primitive);
        // A NaN might not show in the box.
        if (!is_finite(t.a) || !is_finite(t.b) || !is_finite(t.c)) return {};
        if (triangle_detail::is_degenerate(t.a, t.b, t.c)) return {};
        box = box_of(t);
    }
    bool can_be_hit = is_finite(box.lo) && is_finite(box.hi) && !box.empty();
    return can_be_hit ? padded(box) : Bounds3{};
}

} // namespace

Vec3 padding(const Bounds3& box) {
    Vec3 magnitude = max(abs(box.lo), abs(box.hi));
    return Vec3(test_rounding * max_component(box.diagonal())) + magnitude * bounds_rounding;
}

Bounds3 padded(const Bounds3& box) {
    Vec3 pad = padding(box);
    constexpr float largest = std::numeric_limits<float>::max();
    Vec3 limit{largest, largest, largest};
    return {max(box.lo - pad, -limit), min(box.hi + pad, limit)};
}

std::vector<Bounds3> padded_boxes(const Primitives& primitives) {
    std::vector<Bounds3> boxes;
    boxes.reserve(primitives.count());
    prefer_huge_pages(boxes.data(), primitives.count() * sizeof(Bounds3));
    boxes.resize(primitives.count());
    parallel_ranges(boxes.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            boxes[i] = padded_box(primitives, static_cast<std::uint32_t>(i));
    });
    return boxes;
}

} // namespace alhazen
