#include "raster/clip.h"

#include "raster/setup.h"

namespace alhazen {

namespace {

ClipCorner between(const ClipCorner& inside, const ClipCorner& outside, double at) {
    auto mix = [at](double a, double b) { return a + (b - a) * at; };
    return {mix(inside.x, outside.x), mix(inside.y, outside.y), mix(inside.depth, outside.depth),
            mix(inside.w, outside.w)};
}

/// What is left where distance(corner) >= 0.
template <class Distance>
void cut(ClipPolygon& polygon, const Distance& distance) {
    ClipPolygon kept;
    for (std::size_t i = 0; i < polygon.count && kept.count + 2 <= kept.corners.size(); ++i) {
        const ClipCorner& a = polygon.corners[i];
        const ClipCorner& b = polygon.corners[(i + 1) % polygon.count];
        const double da = distance(a), db = distance(b);
        if (da >= 0) kept.corners[kept.count++] = a;
        // From the inside outwards, whichever way round the triangle goes.
        if (da >= 0 && db < 0) kept.corners[kept.count++] = between(a, b, da / (da - db));
        if (da < 0 && db >= 0) kept.corners[kept.count++] = between(b, a, db / (db - da));
    }
    polygon = kept;
}

} // namespace

ClipPolygon clip_triangle(const std::array<ClipCorner, 3>& triangle, double near_depth) {
    ClipPolygon polygon;
    for (const ClipCorner& c : triangle) polygon.corners[polygon.count++] = c;
    // The rounding of a cut must not leave a corner beyond the band.
    constexpr double low = raster_guard_low + 1, high = raster_guard_high - 1;
    cut(polygon, [&](const ClipCorner& c) { return c.depth - near_depth; });
    cut(polygon, [&](const ClipCorner& c) { return c.x - low * c.w; });
    cut(polygon, [&](const ClipCorner& c) { return high * c.w - c.x; });
    cut(polygon, [&](const ClipCorner& c) { return c.y - low * c.w; });
    cut(polygon, [&](const ClipCorner& c) { return high * c.w - c.y; });
    return polygon;
}

} // namespace alhazen
