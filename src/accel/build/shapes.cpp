#include "accel/build/spatial.h"

#include <cstring>

#include "base/threads.h"

namespace alhazen {

namespace {

// Beyond these, lengths and their products with fractions overflow or lose digits.
constexpr float largest = 1e37f, smallest = 1e-30f;

Bounds3 box_of(const Corners& t) {
    return {min(min(t.a, t.b), t.c), max(max(t.a, t.b), t.c)};
}

bool is_box(const Corners& shape) {
    return std::isnan(shape.a.x);
}

Corners shape_of(const Primitives& primitives, std::uint32_t primitive) {
    Bounds3 box;
    if (primitives.kind(primitive) != PrimitiveKind::custom) {
        Corners t = primitives.corners(primitive);
        box = box_of(t);
        float magnitude = max_component(max(abs(box.lo), abs(box.hi)));
        if (magnitude < largest && max_component(box.diagonal()) > smallest) return t;
    } else {
        box = primitives.bounds(primitive);
    }
    return {Vec3(std::numeric_limits<float>::quiet_NaN()), box.lo, box.hi};
}

// The corners in registers; fourth lanes mean nothing.
struct LaneCorners {
    Lanes4 v[3];

    explicit LaneCorners(const Corners& t) {
        const float* p = &t.a.x;
        std::memcpy(&v[0], p, sizeof v[0]);
        std::memcpy(&v[1], p + 3, sizeof v[1]);
        std::memcpy(&v[2], p + 5, sizeof v[2]);
        v[2] = __builtin_shufflevector(v[2], v[2], 1, 2, 3, 3);
    }
};

LaneBox around(Lanes4 p, Lanes4 q) {
    LaneBox box;
    box.extend(p, p);
    box.extend(q, q);
    return box;
}

Pieces cut_box(const Corners& shape, int axis, float plane) {
    LaneBox whole{to_lanes(shape.b), to_lanes(shape.c)};
    Pieces pieces{whole, whole};
    pieces.left.hi[axis] = std::min(plane, shape.c[axis]);
    pieces.right.lo[axis] = std::max(plane, shape.b[axis]);
    return pieces;
}

// One corner is alone on its side; the two edges that meet there cross the plane.
Pieces cut_triangle(const Corners& shape, int axis, float plane) {
    const float d[3] = {shape.a[axis] - plane, shape.b[axis] - plane, shape.c[axis] - plane};
    const LaneCorners t(shape);
    const int below = (d[0] < 0 ? 1 : 0) + (d[1] < 0 ? 2 : 0) + (d[2] < 0 ? 4 : 0);
    if (below == 0 || below == 7) {
        LaneBox whole = around(t.v[0], t.v[1]);
        whole.extend(t.v[2], t.v[2]);
        return below ? Pieces{whole, {}} : Pieces{{}, whole};
    }
    constexpr std::uint8_t alone[8] = {0, 0, 1, 2, 2, 1, 0, 0};
    const int i = alone[below], j = i == 2 ? 0 : i + 1, k = 3 - i - j;
    Lanes4 p = t.v[i] + (t.v[j] - t.v[i]) * all_lanes(d[i] / (d[i] - d[j]));
    Lanes4 q = t.v[i] + (t.v[k] - t.v[i]) * all_lanes(d[i] / (d[i] - d[k]));
    LaneBox one = around(p, q), two = one;
    one.extend(t.v[i], t.v[i]);
    two.extend(t.v[j], t.v[j]);
    two.extend(t.v[k], t.v[k]);
    return d[i] < 0 ? Pieces{one, two} : Pieces{two, one};
}

// A box a slice.
using SliceBoxes = std::array<RawBox, Bins::max_size>;

void chop_box(const Corners& shape, const BinGrid& grid, int axis, int first, int last, SliceBoxes& boxes) {
    for (int k = first; k <= last; ++k) {
        RawBox& box = boxes[static_cast<std::size_t>(k)];
        box = {to_lanes(shape.b), to_lanes(shape.c)};
        if (k > first) box.lo[axis] = grid.plane(axis, k);
        if (k < last) box.hi[axis] = grid.plane(axis, k + 1);
    }
}

// The corners of what a slice holds of a triangle are corners of the triangle and points where its edges
// cross the slice's borders. What is before the first slice counts to the first, what is behind the last to
// the last.
void chop_triangle(const Corners& shape, const BinGrid& grid, int axis, int first, int last,
                   SliceBoxes& boxes) {
    for (int k = first; k <= last; ++k) boxes[static_cast<std::size_t>(k)].clear();
    const LaneCorners t(shape);
    const float width = 1 / grid.scale[axis];
    float along[3];
    int slice[3];
    for (int i = 0; i < 3; ++i) {
        along[i] = (i == 0 ? shape.a : i == 1 ? shape.b : shape.c)[axis] - grid.origin[axis];
        float place = along[i] * grid.scale[axis];
        place = std::min(std::max(place, static_cast<float>(first)), static_cast<float>(last));
        slice[i] = static_cast<int>(place);
        boxes[static_cast<std::size_t>(slice[i])].extend(t.v[i], t.v[i]);
    }
    for (int i = 0; i < 3; ++i) {
        int j = i == 2 ? 0 : i + 1, from = std::min(slice[i], slice[j]), to = std::max(slice[i], slice[j]);
        if (from == to) continue;
        Lanes4 slope = (t.v[j] - t.v[i]) * all_lanes(1 / (along[j] - along[i]));
        Lanes4 start = t.v[i] - slope * all_lanes(along[i]);
        for (int k = from; k < to; ++k) {
            Lanes4 p = start + slope * all_lanes(static_cast<float>(k + 1) * width);
            boxes[static_cast<std::size_t>(k)].extend(p, p);
            boxes[static_cast<std::size_t>(k + 1)].extend(p, p);
        }
    }
}

} // namespace

Shapes::Shapes(const Primitives& primitives, std::span<const Bounds3> boxes) : shapes_(boxes.size()) {
    parallel_ranges(boxes.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            if (!boxes[i].empty()) shapes_[i] = shape_of(primitives, static_cast<std::uint32_t>(i));
    });
}

Pieces Shapes::cut(const Reference& reference, int axis, float plane) const {
    const Corners& shape = shapes_[reference.primitive()];
    Pieces pieces = is_box(shape) ? cut_box(shape, axis, plane) : cut_triangle(shape, axis, plane);
    // Once for what the test loses, once for what computing where edges cross the plane does: an error of a
    // few units in the last place of the edge and one of the coordinates, as in the padding itself.
    Lanes4 pad = to_lanes(padding(is_box(shape) ? Bounds3{shape.b, shape.c} : box_of(shape)) * 2);
    for (LaneBox* piece : {&pieces.left, &pieces.right}) {
        if (piece->empty()) continue;
        piece->lo = max_lanes(piece->lo - pad, reference.lo);
        piece->hi = min_lanes(piece->hi + pad, reference.hi);
    }
    return pieces;
}

void Shapes::chop(const Reference& reference, const BinGrid& grid, int axis, int first, int last,
                  Bins& bins) const {
    const Corners& shape = shapes_[reference.primitive()];
    SliceBoxes boxes;
    if (is_box(shape))
        chop_box(shape, grid, axis, first, last, boxes);
    else
        chop_triangle(shape, grid, axis, first, last, boxes);
    for (int k = first; k <= last; ++k) {
        const RawBox& slice = boxes[static_cast<std::size_t>(k)];
        LaneBox piece{max_lanes(slice.lo, reference.lo), min_lanes(slice.hi, reference.hi)};
        if (!piece.empty()) bins[k].box[static_cast<std::size_t>(axis)].extend(piece);
    }
}

} // namespace alhazen
