#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <cstring>
#include <set>

#include "accel/build/spatial.h"
#include "tests/unit/accel/check_tree.h"
#include "tests/unit/accel/support.h"

namespace alhazen {
namespace {

using namespace accel_test;

Tree build_sbvh(const Triangles& t, const BuildOptions& options = {}) {
    return sbvh_builder().build(t, t.boxes(), options);
}

// Thin triangles in diagonal directions: their boxes are mostly empty and overlap.
Triangles slivers(std::size_t count, float length, std::uint64_t seed) {
    Rng rng(seed);
    Triangles t;
    for (std::size_t i = 0; i < count; ++i) {
        Vec3 p = random_point(rng, 1), along = random_point(rng, length), across = random_point(rng, 0.003f);
        t.list.push_back({p, p + along, p + across});
    }
    return t;
}

// A proper tree, in no leaf a primitive twice, no more references than allowed, and for points of each
// primitive a leaf around them that has it.
void check_split_tree(const Tree& tree, const Triangles& t, float extra) {
    auto boxes = t.boxes();
    std::size_t good = 0;
    for (const Bounds3& b : boxes) good += !b.empty();
    EXPECT_LE(static_cast<double>(tree.order.size()),
              static_cast<double>(good) * (1 + static_cast<double>(extra)));
    std::vector<std::vector<Bounds3>> leaves(t.list.size());
    check_shape(tree, [&](const Tree::Node& leaf) {
        std::set<std::uint32_t> once;
        for (std::uint32_t k = 0; k < leaf.count; ++k) {
            std::uint32_t p = tree.order[leaf.first_or_right + k];
            EXPECT_TRUE(once.insert(p).second) << p;
            leaves[p].push_back(leaf.bounds);
        }
    });
    Rng rng(1);
    for (std::uint32_t i = 0; i < t.list.size(); ++i) {
        EXPECT_EQ(leaves[i].empty(), boxes[i].empty()) << i;
        if (boxes[i].empty()) continue;
        const Corners& c = t.list[i];
        for (int k = 0; k < 20; ++k) {
            float u = rng.uniform(), v = rng.uniform();
            if (u + v > 1) u = 1 - u, v = 1 - v;
            if (k < 3) u = k == 1, v = k == 2;
            Vec3 p = c.a * (1 - u - v) + c.b * u + c.c * v;
            if (!is_finite(p)) continue;
            bool is_inside = false;
            for (const Bounds3& leaf : leaves[i]) is_inside |= leaf.contains(p);
            EXPECT_TRUE(is_inside) << "primitive " << i << " at " << u << ", " << v;
        }
    }
}

TEST(Sbvh, BuildsAProperTree) {
    for (std::size_t n : {1u, 2u, 3u, 5u, 9u, 100u, 3000u})
        for (float length : {0.02f, 0.5f}) {
            Triangles t = slivers(n, length, n);
            check_split_tree(build_sbvh(t), t, 0.3f);
            check_split_tree(build_sbvh(t, {.leaf_size = 1, .extra_references = 2}), t, 2);
        }
}

TEST(Sbvh, BuildsAProperTreeAtEveryScale) {
    for (float scale : {1e-42f, 1e-30f, 1e-6f, 1e6f, 1e30f, 3e37f}) {
        Triangles t = random_triangles(500, scale, scale, 2);
        check_split_tree(build_sbvh(t), t, 0.3f);
    }
}

// Diagonal beams side by side, each a single thin triangle.
Triangles beams(int count) {
    Triangles t;
    for (int i = 0; i < count; ++i) {
        Vec3 p{static_cast<float>(i % 20), static_cast<float>(i / 20), 0}, end = p + Vec3{40, 40, 40};
        t.list.push_back({p, end, end + Vec3{0.1f, 0, 0}});
    }
    return t;
}

TEST(Sbvh, CostsLessWhereBoxesOverlap) {
    Triangles t = beams(400);
    double whole = stats_of(sah_builder().build(t, t.boxes(), {})).sah_cost;
    Tree split = build_sbvh(t, {.extra_references = 3});
    check_split_tree(split, t, 3);
    EXPECT_GT(split.order.size(), 2 * t.list.size());
    EXPECT_LT(stats_of(split).sah_cost, 0.6 * whole);
}

TEST(Sbvh, TheUsualAllowanceHelpsToo) {
    Triangles t = slivers(20000, 0.19f, 9);
    double whole = stats_of(sah_builder().build(t, t.boxes(), {})).sah_cost;
    Tree split = build_sbvh(t);
    EXPECT_GT(split.order.size(), t.list.size() + 1000);
    EXPECT_LT(stats_of(split).sah_cost, 0.98 * whole);
}

TEST(Sbvh, WithoutRoomItIsSah) {
    Triangles t = slivers(5000, 0.15f, 4);
    Tree split = build_sbvh(t, {.extra_references = 0}), whole = sah_builder().build(t, t.boxes(), {});
    EXPECT_EQ(split.order, whole.order);
    EXPECT_EQ(stats_of(split).sah_cost, stats_of(whole).sah_cost);
    EXPECT_EQ(build_sbvh(t, {.extra_references = -1}).order, whole.order);
}

TEST(Sbvh, DegenerateInputsGiveProperTrees) {
    // All the same; the same centre; each much larger than the one before; some without area or not finite.
    Triangles same(std::vector<Corners>(1000, {{0, 0, 0}, {1, 0, 0}, {0, 1, 1}}));
    check_split_tree(build_sbvh(same), same, 0.3f);
    Triangles nested, growing;
    for (int i = 1; i < 1000; ++i) {
        auto r = static_cast<float>(i);
        nested.list.push_back({{-r, -r, -r}, {r, r, r}, {-r, r, 0}});
    }
    check_split_tree(build_sbvh(nested), nested, 0.3f);
    for (int copy = 0; copy < 5; ++copy)
        for (int i = -100; i < 100; ++i) {
            float p = std::ldexp(1.0f, i);
            growing.list.push_back({{p, p, p}, {1.5f * p, p, p}, {p, 1.5f * p, 1.2f * p}});
        }
    check_split_tree(build_sbvh(growing), growing, 0.3f);
    Triangles bad = slivers(200, 0.5f, 5);
    for (std::size_t i = 0; i < bad.list.size(); i += 5) bad.list[i].c = bad.list[i].b;
    bad.list[7].a.x = infinity;
    bad.list[8].b.y = std::numeric_limits<float>::quiet_NaN();
    check_split_tree(build_sbvh(bad), bad, 0.3f);
}

TEST(Sbvh, CustomPrimitivesAreCutAsBoxes) {
    Triangles t = slivers(2000, 0.15f, 6);
    t.kinds.assign(t.list.size(), PrimitiveKind::custom);
    Tree tree = build_sbvh(t);
    check_split_tree(tree, t, 0.3f);
    // All of the box must be covered, not the triangle alone.
    std::vector<double> volume(t.list.size(), 0);
    check_shape(tree, [&](const Tree::Node& leaf) {
        for (std::uint32_t k = 0; k < leaf.count; ++k) {
            std::uint32_t p = tree.order[leaf.first_or_right + k];
            Bounds3 box = t.bounds(p);
            Vec3 d = min(box.hi, leaf.bounds.hi) - max(box.lo, leaf.bounds.lo);
            volume[p] += static_cast<double>(d.x) * static_cast<double>(d.y) * static_cast<double>(d.z);
        }
    });
    for (std::uint32_t i = 0; i < t.list.size(); ++i) {
        Vec3 d = t.bounds(i).diagonal();
        EXPECT_GE(volume[i] * 1.0001,
                  static_cast<double>(d.x) * static_cast<double>(d.y) * static_cast<double>(d.z))
            << i;
    }
}

TEST(Sbvh, TheNumberOfThreadsDoesNotChangeABit) {
    Triangles t = slivers(90000, 0.05f, 7);
    Tree first;
    for (int threads : {1, 2, 3}) {
        tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 3);
        tbb::task_arena arena(threads);
        Tree tree;
        arena.execute([&] { tree = build_sbvh(t); });
        if (threads == 1) first = tree;
        ASSERT_EQ(tree.nodes.size(), first.nodes.size());
        EXPECT_EQ(std::memcmp(tree.nodes.data(), first.nodes.data(), tree.nodes.size() * sizeof(Tree::Node)),
                  0);
        EXPECT_EQ(tree.order, first.order);
    }
    EXPECT_GT(first.order.size(), t.list.size() + 5000);
}

bool holds(const LaneBox& box, Vec3 p) {
    return box.bounds().contains(p);
}

TEST(Shapes, PiecesHoldEveryPointOnTheirSideAndSomeMore) {
    Rng rng(8);
    for (float scale : {1e-6f, 1.0f, 1e6f})
        for (int round = 0; round < 300; ++round) {
            Triangles t = random_triangles(1, scale, scale, static_cast<std::uint64_t>(round));
            Corners& c = t.list[0];
            if (round % 3 == 1) c.c = lerp(1e-6f, c.b, c.c);
            if (round % 3 == 2) c.a = lerp(1e-5f, c.b, c.a) + Vec3{0, 0, 1e3f * scale};
            auto boxes = t.boxes();
            Shapes shapes(t, boxes);
            Reference whole = make_reference(boxes[0], 0);
            int axis = static_cast<int>(rng.below(3));
            float plane = lerp(rng.uniform(), boxes[0].lo[axis], boxes[0].hi[axis]);
            Pieces pieces = shapes.cut(whole, axis, plane);
            Vec3 pad = padding(t.bounds(0));
            for (int k = 0; k < 50; ++k) {
                double u = static_cast<double>(rng.uniform()),
                       v = static_cast<double>(rng.uniform()) * (1 - u);
                if (k < 10) v = k < 5 ? 0 : 1 - u;
                Vec3d exact = Vec3d(c.a) * (1 - u - v) + Vec3d(c.b) * u + Vec3d(c.c) * v;
                // A corner of the box of all points closer than the padding.
                Vec3d far = exact;
                for (int i = 0; i < 3; ++i)
                    far[i] += static_cast<double>(pad[i]) * (rng.below(2) ? 0.99 : -0.99);
                Vec3 p = max(boxes[0].lo, min(boxes[0].hi, Vec3(far)));
                bool is_left = exact[axis] <= static_cast<double>(plane);
                EXPECT_TRUE(holds(is_left ? pieces.left : pieces.right, p)) << scale << " " << round;
            }
        }
}

TEST(Shapes, PiecesAreTight) {
    // The triangle (0,0) (4,0) (0,4) at x = 1: the left piece reaches up to y = 4, the right one to 3.
    Triangles t({{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}});
    Shapes shapes(t, t.boxes());
    Pieces pieces = shapes.cut(make_reference(t.boxes()[0], 0), 0, 1);
    auto expect_near = [](const LaneBox& box, Vec3 lo, Vec3 hi) {
        for (int i = 0; i < 3; ++i) {
            EXPECT_NEAR(box.lo[i], lo[i], 1e-5);
            EXPECT_NEAR(box.hi[i], hi[i], 1e-5);
        }
    };
    expect_near(pieces.left, {0, 0, 0}, {1, 4, 0});
    expect_near(pieces.right, {1, 0, 0}, {4, 3, 0});
    // Chopped into four slices along x.
    BinGrid grid(LaneBox(to_lanes({0, 0, 0}), to_lanes({4, 4, 0})), 4);
    Bins bins;
    bins.clear(4);
    shapes.chop(make_reference(t.boxes()[0], 0), grid, 0, 0, 3, bins);
    for (int k = 0; k < 4; ++k) {
        auto x = static_cast<float>(k);
        expect_near({bins[k].box[0].lo, bins[k].box[0].hi}, {x, 0, 0}, {x + 1, 4 - x, 0});
    }
}

TEST(SpatialSplitter, CutsWhatPaysAndLeavesTheRestWhole) {
    // A long triangle through both halves, and one that reaches over the middle by a little.
    Triangles t;
    for (int i = 0; i < 8; ++i) {
        float x = i < 4 ? -4 : 4, y = static_cast<float>(i % 4);
        t.list.push_back({{x - 1, y, 0}, {x + 1, y, 0}, {x, y + 1, 1}});
    }
    t.list.push_back({{-5, 0, 0}, {5, 4, 0}, {5, 4, 1}});
    t.list.push_back({{-5, 0, 0}, {-5, 4, 0}, {0.7f, 2, 1}});
    auto boxes = t.boxes();
    ReferenceList list = make_references(boxes);
    SpatialSplitter splitter(t, boxes, list.extent.box);
    SpatialSplit split;
    split.grid = BinGrid(LaneBox(to_lanes({-8, -8, -8}), to_lanes({8, 8, 8})), 16);
    split.split.axis = 0;
    split.split.bin = 8;
    split.split.left = LaneBox(to_lanes({-5, 0, 0}), to_lanes({0, 4, 1}));
    split.split.right = LaneBox(to_lanes({0, 0, 0}), to_lanes({5, 5, 1}));
    split.split.left_count = split.split.right_count = 6;
    std::vector<Reference> room(20);
    SpatialChildren parts = splitter.partition({list.references.data(), list.count}, split, room);
    ASSERT_EQ(parts.left_count, 6u);
    ASSERT_EQ(parts.right_count, 5u);
    std::multiset<std::uint32_t> left, right;
    for (std::size_t i = 0; i < 6; ++i) left.insert(room[i].primitive());
    for (std::size_t i = 15; i < 20; ++i) right.insert(room[i].primitive());
    EXPECT_EQ(left, (std::multiset<std::uint32_t>{0, 1, 2, 3, 8, 9}));
    EXPECT_EQ(right, (std::multiset<std::uint32_t>{4, 5, 6, 7, 8}));
    // The whole one's box is whole, the cut one's is not.
    EXPECT_NEAR(parts.left.box.hi[0], 0.7f, 1e-4);
    EXPECT_NEAR(parts.right.box.lo[0], 0, 1e-4);
}

TEST(SpatialSplitter, ManyReferencesArePartedAsFewAre) {
    // So many that several threads share them; each piece alone must be parted the same way.
    Triangles t = slivers(70000, 0.1f, 10);
    auto boxes = t.boxes();
    ReferenceList list = make_references(boxes);
    SpatialSplitter splitter(t, boxes, list.extent.box);
    SpatialSplit split =
        splitter.find({list.references.data(), list.count}, list.extent.box, {}, list.count, TestCount(1));
    ASSERT_TRUE(split.split.found());
    EXPECT_LE(split.split.left_count + split.split.right_count, 2 * list.count);
    std::vector<Reference> room(2 * list.count), little(2);
    SpatialChildren parts = splitter.partition({list.references.data(), list.count}, split, room);
    EXPECT_LE(parts.left_count, split.split.left_count);
    EXPECT_LE(parts.right_count, split.split.right_count);
    std::size_t left = 0, right = room.size() - parts.right_count, differences = 0;
    auto same = [](const Reference& a, const Reference& b) { return std::memcmp(&a, &b, sizeof a) == 0; };
    for (std::size_t i = 0; i < list.count; ++i) {
        SpatialChildren one = splitter.partition({&list.references[i], 1}, split, little);
        if (one.left_count) differences += !same(room[left++], little[0]);
        if (one.right_count) differences += !same(room[right++], little[1]);
    }
    EXPECT_EQ(differences, 0u);
    EXPECT_EQ(left, parts.left_count);
    EXPECT_EQ(right, room.size());
    Extent whole;
    for (std::size_t i = 0; i < left; ++i) whole.add(room[i]);
    EXPECT_EQ(std::memcmp(&whole.box.lo, &parts.left.box.lo, 12), 0);
    EXPECT_EQ(std::memcmp(&whole.centroids.hi, &parts.left.centroids.hi, 12), 0);
}

} // namespace
} // namespace alhazen
