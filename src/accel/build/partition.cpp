#include "accel/build/partition.h"

namespace alhazen {

namespace {

template <int axis>
void partition(std::span<const Reference> references, const BinGrid& grid, int bin, Cursors& cursors,
               ChildCentroids& sum) {
    const Lanes4 origin = all_lanes(grid.origin[axis]), scale = all_lanes(grid.scale[axis]);
    const Lanes4 border = all_lanes(static_cast<float>(bin));
    ChildCentroids centroids = sum;
    Cursors to = cursors;
    for (const Reference& r : references) {
        Lanes4 c = r.doubled_centroid();
        // As BinGrid::slice: its clamping and truncation do not move anything over a border.
        Lanes4 along = __builtin_shufflevector(c, c, axis, axis, axis, axis);
        IntLanes4 is_left = (along - origin) * scale < border;
        to.put(r, is_left[0]);
        Lanes4 l = nan_where(c, ~is_left), h = nan_where(c, is_left);
        centroids.left.extend(l, l);
        centroids.right.extend(h, h);
    }
    sum = centroids;
    cursors = to;
}

} // namespace

void partition_by_slice(std::span<const Reference> references, const BinGrid& grid, int axis, int bin,
                        Cursors& to, ChildCentroids& centroids) {
    if (axis == 0) partition<0>(references, grid, bin, to, centroids);
    if (axis == 1) partition<1>(references, grid, bin, to, centroids);
    if (axis == 2) partition<2>(references, grid, bin, to, centroids);
}

ChildRanges child_ranges(const Range& parent, std::size_t left_count, std::size_t right_count) {
    std::size_t count = left_count + right_count, spare = parent.room_end - parent.room_begin - count;
    std::size_t left_spare = count ? spare * left_count / count : 0;
    std::size_t border = parent.room_begin + left_count + left_spare;
    Range left{parent.room_begin, parent.room_begin + left_count, parent.room_begin, border, 1 - parent.side};
    Range right{parent.room_end - right_count, parent.room_end, border, parent.room_end, 1 - parent.side};
    return {left, right};
}

} // namespace alhazen
