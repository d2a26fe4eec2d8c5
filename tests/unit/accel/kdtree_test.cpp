#include "accel/build/kdtree.h"

#include "accel/build/clip.h"
#include "base/threads.h"
#include "tests/unit/accel/check_tree.h"
#include "tests/unit/accel/support.h"

namespace alhazen {
namespace {

using namespace accel_test;

TEST(ClippedBounds, OfATriangleByHand) {
    Corners t{{0, 0, 0}, {4, 0, 2}, {0, 4, 0}};
    Bounds3 whole{{-1, -1, -1}, {5, 5, 5}};
    Bounds3 b = clipped_bounds(t, whole);
    EXPECT_TRUE(b.lo == Vec3(0, 0, 0) && b.hi == Vec3(4, 4, 2));
    // Beyond x = 2 only a tip is left, with its middle edge at y = 2 and z = 1 and more.
    b = clipped_bounds(t, {{2, -1, -1}, {5, 5, 5}});
    EXPECT_TRUE(b.lo == Vec3(2, 0, 1) && b.hi == Vec3(4, 2, 2));
    // The corner of this box is inside the triangle's box, but not inside the triangle.
    EXPECT_TRUE(clipped_bounds(t, {{3, 3, -1}, {5, 5, 5}}).empty());
    // A triangle through the middle of a cube cuts its sides.
    b = clipped_bounds({{-9, 0, 0}, {9, -9, 0}, {9, 9, 0}}, {{-1, -1, -1}, {1, 1, 1}});
    EXPECT_TRUE(b.lo == Vec3(-1, -1, 0) && b.hi == Vec3(1, 1, 0));
}

TEST(ClippedBounds, HoldThePointsThatAreInside) {
    Rng rng(1);
    std::size_t inside = 0;
    for (int i = 0; i < 500; ++i) {
        Corners t{random_point(rng, 1), random_point(rng, 1), random_point(rng, 1)};
        Bounds3 box;
        box.extend(random_point(rng, 1));
        box.extend(random_point(rng, 1));
        Bounds3 clipped = clipped_bounds(t, box);
        EXPECT_TRUE(clipped.empty() || contains(box, clipped));
        for (int k = 0; k < 200; ++k) {
            float u = rng.uniform(), v = rng.uniform() * (1 - u);
            Vec3 p = t.a + (t.b - t.a) * u + (t.c - t.a) * v;
            if (!box.contains(p)) continue;
            ++inside;
            Vec3 ulp{1e-6f, 1e-6f, 1e-6f};
            EXPECT_TRUE((Bounds3{clipped.lo - ulp, clipped.hi + ulp}.contains(p)));
        }
    }
    EXPECT_GT(inside, 2000u);
}

struct Leaf {
    Bounds3 cell;
    KdTree::Node node;
};

// Cells are divided inside themselves, so the leaves' cells, returned with what is in them, fill the root's.
std::vector<Leaf> leaves_of(const KdTree& tree) {
    std::vector<Leaf> leaves;
    struct Visit {
        std::size_t node;
        Bounds3 cell;
    };
    std::vector<Visit> stack{{0, tree.cell}};
    std::size_t visited = 0, references = 0;
    while (!stack.empty()) {
        auto [i, cell] = stack.back();
        stack.pop_back();
        EXPECT_EQ(i, visited);
        ++visited;
        const KdTree::Node& n = tree.nodes[i];
        if (n.is_leaf()) {
            EXPECT_EQ(n.first_or_above, references);
            references += n.count;
            leaves.push_back({cell, n});
            continue;
        }
        EXPECT_GE(n.split, cell.lo[n.axis]);
        EXPECT_LE(n.split, cell.hi[n.axis]);
        Bounds3 below = cell, above = cell;
        below.hi[n.axis] = above.lo[n.axis] = n.split;
        stack.push_back({n.first_or_above, above});
        stack.push_back({i + 1, below});
    }
    EXPECT_EQ(visited, tree.nodes.size());
    EXPECT_EQ(references, tree.references.size());
    return leaves;
}

double volume(const Bounds3& b) {
    Vec3d d = Vec3d(b.hi) - Vec3d(b.lo);
    return d.x * d.y * d.z;
}

// Whether the box has a part that is more than its side; what only touches a cell may be left out.
bool is_inside(const Bounds3& part, const Bounds3& cell) {
    if (part.empty()) return false;
    for (int axis = 0; axis < 3; ++axis) {
        bool touches = part.hi[axis] <= cell.lo[axis] || part.lo[axis] >= cell.hi[axis];
        if (touches && cell.lo[axis] < cell.hi[axis]) return false;
    }
    return true;
}

// A primitive stands in every leaf that it enters and, of those that it does not even touch, in none; with a
// box that holds its part there and is no larger than the padding allows.
void check_references(const KdTree& tree, const Triangles& t) {
    auto boxes = t.boxes();
    double filled = 0;
    std::vector<std::size_t> places(t.list.size(), 0);
    for (const Leaf& leaf : leaves_of(tree)) {
        filled += volume(leaf.cell);
        std::vector<const KdTree::Reference*> here(t.list.size(), nullptr);
        for (std::uint32_t k = 0; k < leaf.node.count; ++k) {
            const KdTree::Reference& r = tree.references[leaf.node.first_or_above + k];
            ASSERT_EQ(here[r.primitive], nullptr);
            here[r.primitive] = &r;
            ++places[r.primitive];
        }
        for (std::uint32_t i = 0; i < t.count(); ++i) {
            if (boxes[i].empty()) {
                ASSERT_EQ(here[i], nullptr);
                continue;
            }
            const bool is_box = t.kind(i) == PrimitiveKind::custom;
            Bounds3 whole = t.bounds(i);
            Bounds3 part = is_box ? Bounds3{max(whole.lo, leaf.cell.lo), min(whole.hi, leaf.cell.hi)}
                                  : clipped_bounds(t.list[i], leaf.cell);
            if (!here[i]) {
                ASSERT_FALSE(is_inside(part, leaf.cell)) << i;
                continue;
            }
            ASSERT_FALSE(part.empty());
            ASSERT_TRUE(contains(here[i]->bounds, part));
            Vec3 pad = (max(whole.lo - boxes[i].lo, boxes[i].hi - whole.hi)) * 1.001f;
            ASSERT_TRUE(contains({part.lo - pad * 1.5f, part.hi + pad * 1.5f}, here[i]->bounds));
            // Coordinates have rounding of their own, so the part's padding may be one unit off the whole's.
            ASSERT_TRUE(pad.x > 0 && pad.y > 0 && pad.z > 0);
        }
    }
    EXPECT_NEAR(filled / volume(tree.cell), 1, 1e-5);
    for (std::size_t i = 0; i < places.size(); ++i) EXPECT_EQ(places[i] > 0, !boxes[i].empty());
}

void check_tree(const Tree& tree, const KdTree& kdtree) {
    EXPECT_EQ(tree.order.size(), kdtree.references.size());
    std::size_t next = 0;
    check_shape(tree, [&](const Tree::Node& leaf) {
        EXPECT_EQ(leaf.first_or_right, next);
        next += leaf.count;
        for (std::uint32_t k = 0; k < leaf.count; ++k) {
            const KdTree::Reference& r = kdtree.references[leaf.first_or_right + k];
            EXPECT_EQ(tree.order[leaf.first_or_right + k], r.primitive);
            EXPECT_TRUE(contains(leaf.bounds, r.bounds));
        }
    });
    EXPECT_EQ(next, tree.order.size());
}

TEST(KdTree, PrimitivesAreInEveryCellTheyEnter) {
    for (float size : {0.02f, 0.2f, 1.0f})
        for (std::size_t n : {1u, 2u, 9u, 400u}) {
            Triangles t = random_triangles(n, 1, size, n);
            for (std::size_t i = 5; i < n; i += 10) t.list[i].c = t.list[i].b;
            for (std::size_t i = 0; i < n; ++i)
                t.kinds.push_back(i % 3 == 2 ? PrimitiveKind::custom : PrimitiveKind::triangle);
            for (std::uint32_t leaf_size : {1u, 4u}) {
                BuildOptions options{.leaf_size = leaf_size};
                KdTree tree = build_kdtree(t, t.boxes(), options);
                check_references(tree, t);
                check_tree(to_tree(tree, options), tree);
                if (HasFailure()) return;
            }
        }
}

TEST(KdTree, PlanesHalveAGrid) {
    // Four small triangles in the corners of a square in the plane z = 0. Codes are of the centroids, and
    // their grid is as large as the square they form.
    std::vector<Corners> list;
    for (float x : {0.0f, 4.0f})
        for (float y : {0.0f, 4.0f}) list.push_back({{x, y, 0}, {x + 1, y, 0}, {x, y + 1, 0}});
    Triangles t(list);
    KdTree tree = build_kdtree(t, t.boxes(), {.node_cost = 0, .leaf_size = 1});
    ASSERT_EQ(tree.nodes.size(), 7u);
    EXPECT_EQ(tree.nodes[0].axis, 0);
    EXPECT_NEAR(tree.nodes[0].split, 2.5f, 1e-5f);
    EXPECT_EQ(tree.nodes[0].first_or_above, 4u);
    for (std::size_t i : {1u, 4u}) {
        EXPECT_EQ(tree.nodes[i].axis, 1);
        EXPECT_NEAR(tree.nodes[i].split, 2.5f, 1e-5f);
    }
    EXPECT_EQ(tree.references.size(), 4u);
}

TEST(KdTree, ReferencesStayInTheirBudget) {
    // Long slivers, every plane cuts most of them.
    Triangles t = random_triangles(2000, 0.1f, 2, 3);
    for (float budget : {1.0f, 1.5f, 6.0f}) {
        KdTree tree = build_kdtree(t, t.boxes(), {}, {.max_references = budget});
        EXPECT_LE(static_cast<float>(tree.references.size()), budget * 2000);
        check_tree(to_tree(tree, {}), tree);
    }
    EXPECT_GT(build_kdtree(t, t.boxes(), {}).references.size(), 2200u);
}

TEST(KdTree, CoincidentTrianglesAreHalved) {
    Triangles t(std::vector<Corners>(1000, Corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 1}}));
    KdTree tree = build_kdtree(t, t.boxes(), {});
    EXPECT_EQ(tree.nodes.size(), 1u);
    Tree boxes = to_tree(tree, {});
    check_tree(boxes, tree);
    EXPECT_LE(stats_of(boxes).depth, 10);
    EXPECT_TRUE(to_tree(build_kdtree(Triangles{}, {}, {}), {}).nodes.empty());
}

TEST(KdTree, TheNumberOfThreadsDoesNotChangeABit) {
    Triangles t = random_triangles(30000, 1, 0.05f, 5);
    auto boxes = t.boxes();
    expect_same_on_any_threads([&] { return to_tree(build_kdtree(t, boxes, {}), {}); });
}

} // namespace
} // namespace alhazen
