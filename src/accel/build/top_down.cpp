#include "accel/build/top_down.h"

#include <algorithm>
#include <optional>

#include "accel/build/assembly.h"
#include "accel/build/partition.h"
#include "accel/build/small_split.h"
#include "accel/build/spatial.h"
#include "base/threads.h"

namespace alhazen {

namespace {

// Below this depth splits follow the heuristic; from it on they halve, so that the depth stays bounded.
constexpr int halving_depth = Tree::max_depth - 32;
// Subtrees of so many references are built by one thread.
constexpr std::size_t task_size = 4096;
// Nodes of more references than a few of these are binned and parted in parallel.
constexpr std::size_t chunk = 16384;

// Bins pay while many references fall into each.
int bin_count(std::size_t references) {
    return references <= 32 ? 8 : references <= 256 ? 16 : Bins::max_size;
}

// A node to be built.
struct Work {
    Range range;
    Extent extent;
    int depth = 0;
};
struct Children {
    Work left, right;
};

class TopDown {
  public:
    TopDown(ReferenceList list, const BuildOptions& options, const SpatialSplitter* spatial)
        : options_(options), tests_(std::max(1u, options.block)), spatial_(spatial), list_(std::move(list)),
          other_(list_.references.size()) {}

    Tree build() {
        if (list_.count == 0) return {};
        Work root{{0, list_.count, 0, list_.references.size(), 0}, list_.extent, 0};
        return assemble(build_parts(root));
    }

  private:
    std::span<Reference> references(const Range& r) { return {array(r.side) + r.begin, r.size()}; }
    Reference* array(int side) { return side ? other_.data() : list_.references.data(); }
    bool may_be_leaf(std::size_t count) const {
        return count <= std::min(options_.leaf_size, Tree::max_leaf_size);
    }

    // Nodes that deserve several threads.
    Parts build_parts(const Work& work) {
        if (work.range.size() <= task_size) {
            Run run(work.range.size());
            build_run(work, run);
            return parts_of(std::move(run));
        }
        Children children = *split(work);
        Parts left, right;
        parallel_invoke([&] { left = build_parts(children.left); },
                        [&] { right = build_parts(children.right); });
        return join_parts(work.extent.box.bounds(), std::move(left), std::move(right));
    }

    void build_run(const Work& work, Run& run) {
        std::size_t small = spatial_ && work.range.spare() > 0 ? 2 : max_small;
        if (work.range.size() <= small) {
            build_small(references(work.range), work.extent.box, run);
            return;
        }
        std::uint32_t node = run.add_node(work.extent.box.bounds());
        std::optional<Children> children = split(work);
        if (!children) {
            make_leaf(references(work.range), node, run);
            return;
        }
        build_run(children->left, run);
        run.begin_right(node);
        build_run(children->right, run);
    }

    static void make_leaf(std::span<const Reference> references, std::uint32_t node, Run& run) {
        run.make_leaf(node, references.size());
        for (const Reference& r : references) run.add_primitive(r.primitive());
    }

    // A subtree over few references, which stay where they are.
    void build_small(std::span<Reference> references, const LaneBox& box, Run& run) const {
        std::uint32_t node = run.add_node(box.bounds());
        if (references.size() <= options_.joined / 2) {
            make_leaf(references, node, run);
            return;
        }
        SmallSplit split;
        if (references.size() > 1) split = best_small_split(references, tests_);
        if (is_leaf(references.size(), box, split.cost) || references.size() == 1) {
            make_leaf(references, node, run);
            return;
        }
        std::size_t left = split.left ? move_left_first(references, split.left) : references.size() / 2;
        build_small(references.first(left), box_of(references.first(left)), run);
        run.begin_right(node);
        build_small(references.subspan(left), box_of(references.subspan(left)), run);
    }
    static LaneBox box_of(std::span<const Reference> references) {
        LaneBox box;
        for (const Reference& r : references) box.extend(r.lo, r.hi);
        return box;
    }
    static std::size_t move_left_first(std::span<Reference> references, unsigned left) {
        std::array<Reference, max_small> copy{};
        std::copy(references.begin(), references.end(), copy.begin());
        std::size_t to_left = 0, to_right = static_cast<std::size_t>(std::popcount(left));
        for (std::size_t i = 0; i < references.size(); ++i)
            references[left >> i & 1 ? to_left++ : to_right++] = copy[i];
        return to_left;
    }

    // Whether a leaf costs no more than the best split.
    bool is_leaf(std::size_t count, const LaneBox& box, float split_cost) const {
        if (!may_be_leaf(count)) return false;
        float area = box.half_area();
        return area * tests_(count) <= area * options_.node_cost + split_cost;
    }

    // The two children of a node of more than max_small references, or none where it shall be a leaf.
    std::optional<Children> split(const Work& work) {
        std::size_t count = work.range.size();
        // No split costs less than a visit.
        if (may_be_leaf(count) && tests_(count) <= options_.node_cost) return std::nullopt;
        if (work.depth >= halving_depth) return halve(work);
        return count < 4 * chunk ? split_alone(work) : split_together(work);
    }

    std::optional<Children> split_alone(const Work& work) {
        BinGrid grid(work.extent.centroids, bin_count(work.range.size()));
        BinSplit best = find_split(work, grid);
        SpatialSplit space = find_spatial_split(work, best);
        if (is_leaf(work.range.size(), work.extent.box, std::min(best.cost, space.cost())))
            return std::nullopt;
        if (auto children = split_space(work, space)) return children;
        if (!best.found()) return halve(work);
        Children children = make_children(work, best);
        ChildCentroids centroids;
        Cursors cursors{array(1 - work.range.side), static_cast<std::ptrdiff_t>(work.range.room_begin),
                        static_cast<std::ptrdiff_t>(work.range.room_end) - 1, -1};
        partition_by_slice(references(work.range), grid, best.axis, best.bin, cursors, centroids);
        set_centroids(children, centroids);
        return children;
    }
    BinSplit find_split(const Work& work, const BinGrid& grid) {
        Bins bins;
        bins.clear(grid.size);
        bins.add(references(work.range), grid);
        return best_object_split(bins, grid, tests_);
    }

    // The same by several threads, over pieces that do not depend on how many they are.
    std::optional<Children> split_together(const Work& work) {
        std::span<Reference> all = references(work.range);
        BinGrid grid(work.extent.centroids, Bins::max_size);
        std::vector<Bins> bins((all.size() + chunk - 1) / chunk);
        parallel_ranges(all.size(), chunk, [&](std::size_t begin, std::size_t end) {
            bins[begin / chunk].clear(grid.size);
            bins[begin / chunk].add(all.subspan(begin, end - begin), grid);
        });
        Bins sum = bins[0];
        for (std::size_t i = 1; i < bins.size(); ++i) sum.join(bins[i], grid.size);
        BinSplit best = best_object_split(sum, grid, tests_);
        if (auto children = split_space(work, find_spatial_split(work, best))) return children;
        if (!best.found()) return halve(work);
        Children children = make_children(work, best);
        set_centroids(children, partition_together(work, children, grid, best, bins));
        return children;
    }
    ChildCentroids partition_together(const Work& work, const Children& children, const BinGrid& grid,
                                      const BinSplit& split, const std::vector<Bins>& bins) {
        std::span<const Reference> all = references(work.range);
        // Where each chunk's left references go.
        std::vector<std::size_t> left(bins.size(), 0);
        for (std::size_t i = 0; i + 1 < bins.size(); ++i) {
            left[i + 1] = left[i];
            for (int b = 0; b < split.bin; ++b)
                left[i + 1] +=
                    static_cast<std::size_t>(bins[i][b].enter[static_cast<std::size_t>(split.axis)]);
        }
        auto part = [&](ChildCentroids& centroids, std::size_t begin, std::size_t end) {
            std::size_t before = left[begin / chunk];
            Cursors cursors{array(1 - work.range.side),
                            static_cast<std::ptrdiff_t>(children.left.range.begin + before),
                            static_cast<std::ptrdiff_t>(children.right.range.begin + begin - before), 1};
            partition_by_slice(all.subspan(begin, end - begin), grid, split.axis, split.bin, cursors,
                               centroids);
        };
        return parallel_sum(all.size(), chunk, ChildCentroids{}, part,
                            [](ChildCentroids& a, const ChildCentroids& b) { a.join(b); });
    }

    // A split of space that is better than this one of objects, if there is one.
    SpatialSplit find_spatial_split(const Work& work, const BinSplit& objects) {
        if (!spatial_) return {};
        return spatial_->find(references(work.range), work.extent.box, objects, work.range.spare(), tests_);
    }
    std::optional<Children> split_space(const Work& work, const SpatialSplit& space) {
        if (!space.split.found()) return std::nullopt;
        const Range& r = work.range;
        SpatialChildren parts = spatial_->partition(
            references(r), space, {array(1 - r.side) + r.room_begin, r.room_end - r.room_begin});
        if (parts.left_count == 0 || parts.right_count == 0) return std::nullopt;
        ChildRanges ranges = child_ranges(r, parts.left_count, parts.right_count);
        return Children{{ranges.left, parts.left, work.depth + 1},
                        {ranges.right, parts.right, work.depth + 1}};
    }

    static Children make_children(const Work& work, const BinSplit& split) {
        ChildRanges ranges = child_ranges(work.range, split.left_count, split.right_count);
        return {{ranges.left, {split.left, {}}, work.depth + 1},
                {ranges.right, {split.right, {}}, work.depth + 1}};
    }
    static void set_centroids(Children& children, const ChildCentroids& centroids) {
        children.left.extent.centroids = centroids.left;
        children.right.extent.centroids = centroids.right;
    }

    // Where bins do not help (coincident centres, overflowing areas, too deep already): half of the
    // references to each side, along the longest axis of the centres.
    Children halve(const Work& work) {
        std::span<Reference> all = references(work.range);
        Lanes4 size = work.extent.centroids.hi - work.extent.centroids.lo;
        int axis = max_dimension(to_vec3(size));
        std::size_t half = all.size() / 2;
        std::nth_element(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(half), all.end(),
                         [axis](const Reference& a, const Reference& b) {
                             float ca = a.doubled_centroid()[axis], cb = b.doubled_centroid()[axis];
                             return ca != cb ? ca < cb : a.primitive() < b.primitive();
                         });
        ChildRanges ranges = child_ranges(work.range, half, all.size() - half);
        Children children{{ranges.left, {}, work.depth + 1}, {ranges.right, {}, work.depth + 1}};
        std::copy(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(half),
                  references(ranges.left).begin());
        std::copy(all.begin() + static_cast<std::ptrdiff_t>(half), all.end(),
                  references(ranges.right).begin());
        for (Work* child : {&children.left, &children.right})
            for (const Reference& r : references(child->range)) child->extent.add(r);
        return children;
    }

    BuildOptions options_;
    TestCount tests_;
    const SpatialSplitter* spatial_;
    ReferenceList list_;
    BigArray<Reference> other_; // the second array: nodes' references move from one to the other
};

} // namespace

Tree build_top_down(ReferenceList list, const BuildOptions& options, const SpatialSplitter* spatial) {
    return TopDown(std::move(list), options, spatial).build();
}

} // namespace alhazen
