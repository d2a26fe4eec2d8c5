#include "accel/build/octree.h"

#include "base/threads.h"
#include "tests/unit/accel/check_tree.h"
#include "tests/unit/accel/support.h"

namespace alhazen {
namespace {

using namespace accel_test;

// Cells of the octree over the codes begin ... end - 1, counted the obvious way.
std::size_t count_cells(const std::vector<std::uint64_t>& codes, std::size_t begin, std::size_t end,
                        int level, const OctreeOptions& options) {
    if (begin == end) return 0;
    if (level == options.max_level || end - begin <= options.leaf_size) return 1;
    std::size_t cells = 1, first = begin;
    for (std::uint64_t octant = 0; octant < 8; ++octant) {
        std::size_t last = first;
        int shift = 3 * (options.max_level - level - 1);
        while (last < end && (codes[last] >> shift & 7) == octant) ++last;
        cells += count_cells(codes, first, last, level + 1, options);
        first = last;
    }
    EXPECT_EQ(first, end);
    return cells;
}

// Every cell's primitives share its prefix and fit its box; children partition their parent. Returns the
// number of cells that are reached.
std::size_t check_cells(const Octree& octree, const std::vector<Bounds3>& boxes, std::uint32_t number,
                        const OctreeOptions& options) {
    const Octree::Node& node = octree.nodes[number];
    EXPECT_LT(node.begin, node.end);
    Bounds3 box;
    for (std::uint32_t k = node.begin; k < node.end; ++k) {
        EXPECT_EQ(octree.codes[k] >> 3 * (octree.max_level - node.level), node.prefix);
        box.extend(boxes[octree.order[k]]);
    }
    EXPECT_TRUE(box.lo == node.bounds.lo && box.hi == node.bounds.hi);
    const bool stays_whole = node.level == octree.max_level || node.count() <= options.leaf_size;
    EXPECT_EQ(node.is_leaf(), stays_whole);
    if (node.is_leaf()) return 1;
    std::size_t cells = 1;
    std::uint32_t place = node.begin, next = node.first_child;
    for (int octant = 0; octant < 8; ++octant) {
        if (!node.has_child(octant)) continue;
        EXPECT_EQ(node.child(octant), next++);
        const Octree::Node& child = octree.nodes[node.child(octant)];
        EXPECT_EQ(child.level, node.level + 1);
        EXPECT_EQ(child.prefix, node.prefix << 3 | static_cast<std::uint64_t>(octant));
        EXPECT_EQ(child.begin, place);
        place = child.end;
        if (testing::Test::HasFailure()) return cells;
        cells += check_cells(octree, boxes, node.child(octant), options);
    }
    EXPECT_EQ(place, node.end);
    return cells;
}

void check_octree(const std::vector<Bounds3>& boxes, const OctreeOptions& options) {
    Octree octree = build_octree(boxes, options);
    ASSERT_FALSE(octree.nodes.empty());
    EXPECT_EQ(octree.nodes[0].level, 0);
    EXPECT_EQ(octree.nodes[0].count(), octree.order.size());
    EXPECT_EQ(check_cells(octree, boxes, 0, options), octree.nodes.size());
    EXPECT_EQ(count_cells(octree.codes, 0, octree.codes.size(), 0, options), octree.nodes.size());
    for (std::size_t k = 0; k < octree.order.size(); ++k) EXPECT_FALSE(boxes[octree.order[k]].empty());
    check_tree_of_boxes(to_tree(octree, boxes, {}), boxes);
    check_tree_of_boxes(to_tree(octree, boxes, {.leaf_size = 1}), boxes);
}

// Uniform, in clusters, along a line, coinciding.
std::vector<std::vector<Bounds3>> many_boxes() {
    std::vector<std::vector<Bounds3>> all;
    for (std::size_t n : {1u, 2u, 3u, 9u, 3000u}) all.push_back(random_triangles(n, 1, 0.1f, n).boxes());
    Triangles clusters = random_triangles(1000, 1, 0.1f, 1);
    for (float size : {1e-2f, 1e-4f, 1e-6f}) clusters.add(random_triangles(300, size, size, 2));
    all.push_back(clusters.boxes());
    all.emplace_back(50, Bounds3{{1, 1, 1}, {2, 2, 2}});
    for (int i = 0; i < 40; ++i) {
        float x = std::ldexp(1.0f, -i);
        all.back().push_back({{x, 0, 0}, {x, 0, 0}});
        all.back().emplace_back();
    }
    return all;
}

TEST(Octree, CellsAreThoseOfARecursiveBuild) {
    for (const auto& boxes : many_boxes())
        for (int levels : {1, 10, 21})
            for (std::uint32_t leaf_size : {0u, 1u, 2u, 8u})
                check_octree(boxes, {.max_level = levels, .leaf_size = leaf_size});
}

TEST(Octree, OfEightCorners) {
    std::vector<Bounds3> boxes;
    for (int i = 7; i >= 0; --i) {
        Vec3 p = Bounds3{{0, 0, 0}, {1, 1, 1}}.corner(i);
        boxes.push_back({p, p});
    }
    Octree octree = build_octree(boxes, {.leaf_size = 1});
    ASSERT_EQ(octree.nodes.size(), 9u);
    EXPECT_EQ(octree.nodes[0].child_mask, 0xff);
    // Octant 4 x + 2 y + z; a box's corner i has x in bit 0.
    for (int octant = 0; octant < 8; ++octant) {
        const Octree::Node& cell = octree.nodes[octree.nodes[0].child(octant)];
        Vec3 corner{static_cast<float>(octant >> 2), static_cast<float>(octant >> 1 & 1),
                    static_cast<float>(octant & 1)};
        EXPECT_TRUE(cell.bounds.lo == corner);
    }
    // The tree halves in x, then in y, then in z.
    Tree tree = to_tree(octree, boxes, {.node_cost = 0, .leaf_size = 1});
    ASSERT_EQ(tree.nodes.size(), 15u);
    EXPECT_TRUE(tree.nodes[1].bounds.hi == Vec3(0, 1, 1));
    EXPECT_TRUE(tree.nodes[2].bounds.hi == Vec3(0, 0, 1));
    EXPECT_TRUE(tree.nodes[3].bounds.hi == Vec3(0, 0, 0));
    EXPECT_TRUE(build_octree({}).nodes.empty());
}

TEST(Octree, TheNumberOfThreadsDoesNotChangeAnything) {
    auto boxes = random_triangles(60000, 1, 0.01f, 5).boxes();
    for (std::size_t i = 0; i < boxes.size(); i += 7) boxes[i] = boxes[i / 2];
    expect_same_on_any_threads([&] { return to_tree(build_octree(boxes), boxes, {}); });
}

} // namespace
} // namespace alhazen
