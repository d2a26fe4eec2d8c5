#include "accel/primitives.h"

#include "accel/triangle.h"
#include "base/threads.h"

namespace alhazen {

namespace {

// Units in the last place by which a triangle test may miss laterally, over the extent of the triangle: Woop
// et al. count five, the rest is for the products of the edge functions.
constexpr float test_rounding = 8 * 0x1p-24f;
// The same of the coordinates, for bounds that were rounded themselves.
constexpr float bounds_rounding = 2 * 0x1p-24f;

} // namespace

Bounds3 padded(const Bounds3& box) {
    Vec3 magnitude = max(abs(box.lo), abs(box.hi));
    float lateral = test_rounding * max_component(box.diagonal());
    Vec3 pad = Vec3(lateral, lateral, lateral) + magnitude * bounds_rounding;
    constexpr float largest = std::numeric_limits<float>::max();
    Vec3 limit{largest, largest, largest};
    return {max(box.lo - pad, -limit), min(box.hi + pad, limit)};
}

std::vector<Bounds3> padded_boxes(const Primitives& primitives) {
    std::vector<Bounds3> boxes(primitives.count());
    parallel_for(boxes.size(), 4096, [&](std::size_t i) {
        auto number = static_cast<std::uint32_t>(i);
        if (primitives.kind(number) != PrimitiveKind::custom) {
            Corners t = primitives.corners(number);
            if (!is_finite(t.a) || !is_finite(t.b) || !is_finite(t.c)) return;
            if (triangle_detail::is_degenerate(t.a, t.b, t.c)) return;
        }
        Bounds3 box = primitives.bounds(number);
        if (is_finite(box.lo) && is_finite(box.hi) && !box.empty()) boxes[i] = padded(box);
    });
    return boxes;
}

} // namespace alhazen
