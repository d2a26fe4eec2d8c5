/// Builds trees from the bottom up by merging neighbours on a line.
///
/// Meister and Bittner 2018, "Parallel Locally-Ordered Clustering for Bounding Volume Hierarchy
/// Construction", arranged as in Benthin, Drabinski, Tessari and Dittebrandt 2022, "PLOC++: Parallel
/// Locally-Ordered Clustering for Bounding Volume Hierarchy Construction Revisited". The best trees would
/// come from merging, again and again, the two boxes whose common box has the least area (agglomerative
/// clustering); but who is nearest to whom among a million boxes takes long to find. Here all boxes stand in
/// a line, ordered by the Morton codes of their centres, and each looks for its nearest only among the few
/// before and behind it. Picture people in a queue: everybody points at the one nearby they like best; who
/// point at each other join hands and from now on count as one; the queue closes up; and so on until one is
/// left.
///
/// Made for GPUs: there a block of threads keeps its part of the queue in shared memory, and a whole round is
/// one kernel. On a CPU a part of the queue is in the cache anyway, four boxes are compared at once in the
/// lanes of a register, and each pair only once, for both of its boxes. A round's three passes (point, count,
/// join) are parallel loops. What is lost is little: the last rounds, of few boxes, run on one thread.
#include "accel/list.h"

#include <array>
#include <bit>
#include <cstring>

#include "accel/build/linked_tree.h"
#include "accel/build/morton.h"
#include "accel/build/scale.h"
#include "base/lanes.h"
#include "base/threads.h"

namespace alhazen {

namespace {

// How far in the line a box looks for its nearest, to each side.
constexpr std::size_t radius = 16;
// Boxes of the line that are worked on in one go.
constexpr std::size_t grain = 2048;
constexpr std::size_t lanes = 4;
// A round in which fewer than one of so many boxes finds a partner is not worth its time.
constexpr std::size_t least_share = 32;

// Two numbers of the line that are at most 31 apart differ in their last six bits; who is meant is found from
// these.
constexpr std::uint32_t place_mask = 63;
static_assert(radius <= 31);

Lanes4 load(const float* p) {
    Lanes4 v;
    std::memcpy(&v, p, sizeof v);
    return v;
}
void store(float* p, Lanes4 v) {
    std::memcpy(p, &v, sizeof v);
}

// The boxes still in the line, scaled (see scale.h), each side of the boxes in a run of its own. Behind the
// last stand some boxes so large that nobody chooses them.
struct Line {
    std::array<BigArray<float>, 6> sides; // lo.x lo.y lo.z hi.x hi.y hi.z
    BigArray<std::uint32_t> nodes;        // of the tree, one a box
    BigArray<std::uint8_t> heights;       // of these, in edges
    std::size_t size = 0;

    explicit Line(std::size_t most) : nodes(most), heights(most) {
        for (auto& side : sides) side = BigArray<float>(most + radius + 2 * lanes);
    }
    void end_at(std::size_t count) {
        size = count;
        for (std::size_t s = 0; s < 6; ++s)
            for (std::size_t i = 0; i < radius + 2 * lanes; ++i) sides[s][count + i] = s < 3 ? -1e15f : 1e15f;
    }
    void set(std::size_t i, const Bounds3& box) {
        for (int axis = 0; axis < 3; ++axis) {
            sides[static_cast<std::size_t>(axis)][i] = box.lo[axis];
            sides[static_cast<std::size_t>(axis) + 3][i] = box.hi[axis];
        }
    }
};

// Four boxes.
struct Boxes {
    std::array<Lanes4, 3> lo, hi;

    Boxes(const Line& line, std::size_t i) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            lo[axis] = load(&line.sides[axis][i]);
            hi[axis] = load(&line.sides[axis + 3][i]);
        }
    }
    // Half the areas of the boxes around pairs, and a little more: so they are never denormal.
    Lanes4 area_with(const Boxes& other) const {
        std::array<Lanes4, 3> d;
        for (std::size_t axis = 0; axis < 3; ++axis)
            d[axis] = max_lanes(hi[axis], other.hi[axis]) - min_lanes(lo[axis], other.lo[axis]);
        return d[0] * d[1] + d[1] * d[2] + d[2] * d[0] + all_lanes(0x1p-100f);
    }
};

class PlocBuilder {
  public:
    PlocBuilder(std::span<const Bounds3> boxes, std::vector<MortonKey> keys)
        : count_(keys.size()), line_(count_), next_(count_), nearest_(count_),
          parts_((count_ + grain - 1) / grain) {
        tree_.nodes = BigArray<LinkedTree::Node>(2 * count_ - 1);
        tree_.order.resize(count_);
        Bounds3 whole = parallel_sum(
            count_, grain, Bounds3{},
            [&](Bounds3& sum, std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) sum.extend(boxes[keys[i].index]);
            },
            [](Bounds3& sum, const Bounds3& part) { sum.extend(part); });
        float scale = unit_scale(whole);
        parallel_ranges(count_, grain, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                auto number = static_cast<std::uint32_t>(i);
                const Bounds3& box = boxes[keys[i].index];
                tree_.order[i] = keys[i].index;
                tree_.nodes[i].make_leaf(box, number, 1);
                line_.nodes[i] = number;
                line_.heights[i] = 0;
                line_.set(i, scaled(box, scale));
            }
        });
        line_.end_at(count_);
    }

    LinkedTree run() {
        while (line_.size > 1) {
            // Height grows by at most one a round. When only halving can keep it in bounds, the line is
            // halved from here on.
            auto rounds_of_halving = static_cast<int>(std::bit_width(line_.size - 1));
            bool may_choose = height_ + 1 + rounds_of_halving <= Tree::max_depth;
            pairs_ = 0;
            if (may_choose) {
                point();
                count_pairs();
            }
            if (pairs_ < (line_.size + least_share - 1) / least_share) {
                point_at_next();
                count_pairs();
            }
            join();
        }
        tree_.root = static_cast<std::uint32_t>(used_ - 1);
        return std::move(tree_);
    }

  private:
    // A part of the line: what it has, and then what all parts before it have.
    struct Part {
        std::size_t pairs, boxes;
        std::uint8_t height;
    };

    // Everybody points at their nearest.
    void point() {
        parallel_ranges(line_.size, grain,
                        [&](std::size_t begin, std::size_t end) { point_range(begin, end); });
    }

    // A pair's key is the area of its common box, with the last bits replaced by those in which the two
    // numbers in the line differ. One box's pairs all have different keys, so the pair with the least key
    // of all is the best for both its boxes: in every round at least one is mutual. Of boxes that coincide,
    // 2k and 2k + 1 choose each other.
    void point_range(std::size_t begin, std::size_t end) {
        std::array<float, grain + 2 * radius + 2 * lanes> best;
        best.fill(infinity);
        std::size_t first = begin - std::min(begin, radius);
        const IntLanes4 key_mask = IntLanes4{} + ~static_cast<int>(place_mask);
        for (std::size_t i = first; i < end; i += lanes) {
            Boxes boxes(line_, i);
            int number = static_cast<int>(i & place_mask);
            IntLanes4 place = IntLanes4{0, 1, 2, 3} + number;
            Lanes4 own = all_lanes(infinity);
            for (std::size_t d = 1; d <= radius; ++d) {
                Lanes4 area = boxes.area_with(Boxes(line_, i + d));
                IntLanes4 other = place + static_cast<int>(d);
                IntLanes4 difference = (place ^ other) & static_cast<int>(place_mask);
                auto key = std::bit_cast<Lanes4>((std::bit_cast<IntLanes4>(area) & key_mask) | difference);
                own = min_lanes(key, own);
                float* others = &best[i + d - first];
                store(others, min_lanes(key, load(others)));
            }
            float* mine = &best[i - first];
            store(mine, min_lanes(own, load(mine)));
        }
        for (std::size_t i = begin; i < end; ++i) {
            auto place = static_cast<std::uint32_t>(i);
            std::uint32_t other = place ^ (std::bit_cast<std::uint32_t>(best[i - first]) & place_mask);
            std::uint32_t step = (other - place + 32) & place_mask; // 32: to oneself
            nearest_[i] = place + step - 32;
        }
    }

    // 2k and 2k + 1 point at each other; who is left over points at themselves.
    void point_at_next() {
        parallel_ranges(line_.size, grain, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                nearest_[i] = static_cast<std::uint32_t>(std::min(i ^ 1, line_.size - 1));
        });
    }

    bool is_mutual(std::size_t i) const { return nearest_[nearest_[i]] == i && nearest_[i] != i; }

    // Counts the pairs in the line; afterwards the parts know what is before them.
    void count_pairs() {
        parallel_ranges(line_.size, grain, [&](std::size_t begin, std::size_t end) {
            Part part{0, 0, 0};
            for (std::size_t i = begin; i < end; ++i) {
                bool mutual = is_mutual(i), first = i < nearest_[i];
                part.pairs += mutual && first;
                part.boxes += !mutual || first;
            }
            parts_[begin / grain] = part;
        });
        Part before{0, 0, 0};
        for (std::size_t p = 0; p * grain < line_.size; ++p) {
            Part part = parts_[p];
            parts_[p] = before;
            before.pairs += part.pairs;
            before.boxes += part.boxes;
        }
        pairs_ = before.pairs;
    }

    // Pairs become nodes of the tree and stand in the place of their first; the line closes up.
    void join() {
        parallel_ranges(line_.size, grain, [&](std::size_t begin, std::size_t end) {
            Part part = parts_[begin / grain];
            for (std::size_t i = begin; i < end; ++i) {
                bool mutual = is_mutual(i);
                std::size_t other = mutual ? nearest_[i] : i;
                if (other < i) continue;
                std::size_t to = part.boxes++;
                for (std::size_t s = 0; s < 3; ++s) {
                    next_.sides[s][to] = std::min(line_.sides[s][i], line_.sides[s][other]);
                    next_.sides[s + 3][to] = std::max(line_.sides[s + 3][i], line_.sides[s + 3][other]);
                }
                next_.nodes[to] = line_.nodes[i];
                next_.heights[to] = line_.heights[i];
                if (!mutual) continue;
                next_.heights[to] =
                    static_cast<std::uint8_t>(1 + std::max(line_.heights[i], line_.heights[other]));
                part.height = std::max(part.height, next_.heights[to]);
                std::size_t node = used_ + part.pairs++;
                tree_.nodes[node].make_inner(line_.nodes[i], line_.nodes[other]);
                next_.nodes[to] = static_cast<std::uint32_t>(node);
            }
            parts_[begin / grain].height = part.height;
        });
        for (std::size_t p = 0; p * grain < line_.size; ++p)
            height_ = std::max(height_, static_cast<int>(parts_[p].height));
        next_.end_at(line_.size - pairs_);
        std::swap(line_, next_);
        used_ += pairs_;
    }

    std::size_t count_;
    LinkedTree tree_;
    Line line_, next_;
    BigArray<std::uint32_t> nearest_;
    std::vector<Part> parts_;
    std::size_t pairs_ = 0;     // of this round
    std::size_t used_ = count_; // nodes of the tree
    int height_ = 0;            // of the tallest subtree
};

Tree build(const Primitives&, std::span<const Bounds3> boxes, const BuildOptions& options) {
    std::vector<MortonKey> keys = morton_keys(boxes);
    if (keys.empty()) return {};
    sort_by_code(keys);
    return finish(PlocBuilder(boxes, std::move(keys)).run(), options);
}

} // namespace

AccelBuilder ploc_builder() {
    return {"ploc", "parallel locally-ordered clustering (Meister and Bittner 2018)", build};
}

} // namespace alhazen
