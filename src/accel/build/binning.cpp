#include "accel/build/binning.h"

#include <cstring>

namespace alhazen {

namespace {

using Boxes = std::array<LaneBox, 3>;

// The half areas of three boxes, one a lane. Of an empty box: infinity, which 0 tests make NaN.
Lanes4 half_areas(const Boxes& box) {
    Lanes4 a = box[0].hi - box[0].lo, b = box[1].hi - box[1].lo, c = box[2].hi - box[2].lo;
    Lanes4 xy = __builtin_shufflevector(a, b, 0, 4, 1, 5), zz = __builtin_shufflevector(a, b, 2, 6, 2, 6);
    Lanes4 x = __builtin_shufflevector(xy, c, 0, 1, 4, 4);
    Lanes4 y = __builtin_shufflevector(xy, c, 2, 3, 5, 5);
    Lanes4 z = __builtin_shufflevector(zz, c, 0, 1, 6, 6);
    return x * (y + z) + y * z;
}

template <class To>
void extend(To& sum, const std::array<RawBox, 3>& boxes) {
    for (std::size_t axis = 0; axis < 3; ++axis) sum[axis].extend(boxes[axis]);
}

IntLanes4 load(const std::array<std::int32_t, 4>& counts) {
    IntLanes4 lanes;
    std::memcpy(&lanes, counts.data(), sizeof lanes);
    return lanes;
}

template <bool chopped>
IntLanes4 leaving(const Bins::Bin& bin) {
    return load(chopped ? bin.leave : bin.enter);
}

// What a split that was chosen makes of the node.
template <bool chopped>
void describe(const Bins& bins, int size, BinSplit& split) {
    auto axis = static_cast<std::size_t>(split.axis);
    int b = 0;
    for (; b < split.bin; ++b) {
        split.left.extend(bins[b].box[axis]);
        split.left_count += static_cast<std::size_t>(bins[b].enter[axis]);
    }
    for (; b < size; ++b) {
        split.right.extend(bins[b].box[axis]);
        split.right_count += static_cast<std::size_t>((chopped ? bins[b].leave : bins[b].enter)[axis]);
    }
}

template <bool chopped>
BinSplit best_split(const Bins& bins, const BinGrid& grid, const TestCount& tests) {
    std::array<Lanes4, Bins::max_size> right_cost;
    Boxes side;
    IntLanes4 count = all_int_lanes(0);
    for (int b = grid.size; b-- > 1;) {
        extend(side, bins[b].box);
        count += leaving<chopped>(bins[b]);
        right_cost[static_cast<std::size_t>(b)] = half_areas(side) * tests(count);
    }
    side = {};
    count = all_int_lanes(0);
    Lanes4 best_cost = all_lanes(infinity);
    IntLanes4 best_bin = all_int_lanes(0);
    for (int b = 1; b < grid.size; ++b) {
        extend(side, bins[b - 1].box);
        count += load(bins[b - 1].enter);
        // NaN, and so never less, where a side is empty.
        Lanes4 cost = half_areas(side) * tests(count) + right_cost[static_cast<std::size_t>(b)];
        IntLanes4 better = cost < best_cost;
        best_cost = better ? cost : best_cost;
        best_bin = better ? all_int_lanes(b) : best_bin;
    }
    BinSplit best;
    for (int axis = 0; axis < 3; ++axis)
        if (best_cost[axis] < best.cost) {
            best.axis = axis;
            best.bin = best_bin[axis];
            best.cost = best_cost[axis];
        }
    if (best.found()) describe<chopped>(bins, grid.size, best);
    return best;
}

} // namespace

void Bins::add(std::span<const Reference> references, const BinGrid& grid) {
    const BinGrid local = grid; // which stores to bins cannot change
    auto add_one = [&](const Reference& r) {
        IntLanes4 slice = local.slice(local.place(r.doubled_centroid()));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            Bin& b = bin[static_cast<std::uint32_t>(slice[axis])];
            b.box[axis].extend(r.lo, r.hi);
            ++b.enter[axis];
        }
    };
    // Neighbours fall into the same bins and would wait for each other's stores; so one from each half in
    // turn.
    std::size_t half = references.size() / 2;
    for (std::size_t i = 0; i < half; ++i) {
        add_one(references[i]);
        add_one(references[half + i]);
    }
    if (references.size() % 2 == 1) add_one(references.back());
}

void Bins::join(const Bins& other, int size) {
    for (int b = 0; b < size; ++b) {
        Bin& to = (*this)[b];
        const Bin& from = other[b];
        extend(to.box, from.box);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            to.enter[axis] += from.enter[axis];
            to.leave[axis] += from.leave[axis];
        }
    }
}

BinSplit best_object_split(const Bins& bins, const BinGrid& grid, const TestCount& tests) {
    return best_split<false>(bins, grid, tests);
}

BinSplit best_chopped_split(const Bins& bins, const BinGrid& grid, const TestCount& tests) {
    return best_split<true>(bins, grid, tests);
}

} // namespace alhazen
