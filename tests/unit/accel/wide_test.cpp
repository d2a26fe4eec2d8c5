/// The production structure: its kernels for every instruction set this processor has, its collapse and its
/// layout.

#include "accel/wide/layout.h"

#include <gtest/gtest.h>

#include "accel/wide/dispatch.h"
#include "base/frame.h"
#include "tests/unit/accel/support.h"

namespace alhazen {
namespace {

using namespace accel_test;

class Kernels : public testing::TestWithParam<std::string> {
  protected:
    using RayMaker = std::vector<Ray>(const Triangles& triangles, float scale, Rng& rng);

    static std::vector<Ray> rays_of_all_kinds(const Triangles& triangles, float scale, Rng& rng) {
        std::vector<Ray> rays;
        for (int i = 0; i < 6000; ++i) {
            rays.push_back(random_ray(triangles, scale, rng));
            if (i % 4 == 0) rays.back().tmax = rng.uniform() * scale;
        }
        return rays;
    }

    // Tiles of rays from one point or a small lens, some through vertices, wide and narrow; among them tiles
    // that are none, rays that hit nothing by what they are, and a tile that is cut short.
    static std::vector<Ray> tiles_of_rays(const Triangles& triangles, float scale, Rng& rng) {
        std::vector<Ray> rays;
        for (int tile = 0; tile < 60; ++tile) {
            const Corners& target = triangles.list[rng.below(triangles.count())];
            const Vec3 o = random_point(rng, tile % 2 ? 3 * scale : scale);
            const Vec3 d = (target.a - o) * (0.5f + rng.uniform());
            const float width = std::pow(10.0f, -5 * rng.uniform()) * 0.1f * length(d);
            const float lens = tile % 3 == 0 ? 0.01f * scale : 0;
            for (int i = 0; i < (tile == 59 ? 40 : 64); ++i) {
                Ray ray(o + random_point(rng, lens), d + random_point(rng, width));
                if (i % 9 == 0) ray.d = target.a - ray.o;
                if (i % 4 == 0) ray.tmax = rng.uniform() * 4;
                if (tile % 11 == 10 && i == 30) ray.d.x = std::numeric_limits<float>::quiet_NaN();
                if (tile % 13 == 12 && i % 2) ray = random_ray(triangles, scale, rng);
                rays.push_back(ray);
            }
        }
        return rays;
    }

    // From points of triangles, and from a little to either side of them, to where the normal points and to
    // the other side, steep and flat: what kernels decide for themselves about a triangle that a ray has just
    // left.
    static std::vector<Ray> rays_from_surfaces(const Triangles& triangles, float scale, Rng& rng) {
        std::vector<Ray> rays;
        for (int i = 0; i < 12000; ++i) {
            const Corners& t = triangles.list[rng.below(triangles.count())];
            const float u = rng.uniform(), v = rng.uniform() * (1 - u);
            const Vec3 p = t.a + (t.b - t.a) * u + (t.c - t.a) * v,
                       n = normalize(cross(t.b - t.a, t.c - t.a));
            const float size = std::max({max_component(abs(t.a)), max_component(abs(t.b)), scale * 1e-6f});
            const float off =
                (rng.uniform() - 0.5f) * std::pow(2.0f, -static_cast<float>(18 + rng.below(10)));
            const Vec3 along = random_point(rng, 1),
                       d = along - n * (dot(along, n) * (rng.below(3) ? 0.0f : 0.999f));
            rays.emplace_back(i % 7 ? p + n * (off * size) : p, d * (i % 2 ? scale : 1.0f));
        }
        return rays;
    }

    void expect_same_as_stack(const Triangles& triangles, float scale, std::uint64_t seed,
                              RayMaker& make_rays = rays_of_all_kinds) {
        AccelChoice choice{"sah", "wide", {}};
        choice.walk_options.instructions = GetParam();
        auto wide = make_structure(triangles, choice),
             stack = make_structure(triangles, {"sah", "stack", {}});
        TriangleTests tests(triangles);
        Rng rng(seed);
        std::vector<Ray> rays = make_rays(triangles, scale, rng);
        std::vector<Intersection> hits(rays.size());
        std::vector<std::uint8_t> blocked(rays.size());
        wide->closest(rays, hits, tests);
        wide->any(rays, blocked, tests);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            Intersection expected, one;
            bool found = stack->closest(rays[i], expected, tests);
            wide->closest(rays[i], one, tests);
            for (const Intersection& hit : {hits[i], one}) {
                ASSERT_EQ(hit.primitive, expected.primitive) << "ray " << i;
                ASSERT_EQ(hit.t, expected.t) << "ray " << i;
                ASSERT_EQ(hit.u, expected.u) << "ray " << i;
                ASSERT_EQ(hit.v, expected.v) << "ray " << i;
            }
            ASSERT_EQ(blocked[i] != 0, found) << "ray " << i;
            ASSERT_EQ(wide->any(rays[i], tests), found) << "ray " << i;
        }
    }
};

TEST_P(Kernels, GiveTheSameBits) {
    for (float scale : {1e-6f, 1.0f, 1e6f})
        for (std::size_t n : {1u, 5u, 300u, 20000u}) {
            Triangles t = random_triangles(n, scale, (n > 1000 ? 0.03f : 0.3f) * scale, 5);
            for (std::size_t i = 0; i < n; i += 5) t.list.push_back(t.list[i]); // ties
            expect_same_as_stack(t, scale, n);
        }
}

TEST_P(Kernels, GiveTheSameBitsForPrimitivesOfAllKinds) {
    Triangles t = random_triangles(3000, 1, 0.1f, 6);
    for (std::size_t i = 0; i < t.list.size(); ++i)
        t.kinds.push_back(i % 5 < 2   ? PrimitiveKind::triangle
                          : i % 5 < 4 ? PrimitiveKind::filtered_triangle
                                      : PrimitiveKind::custom);
    expect_same_as_stack(t, 1, 7);
}

TEST_P(Kernels, GiveTheSameBitsForRaysThatGoTheSameWay) {
    for (float scale : {1e-6f, 1.0f, 1e6f})
        for (std::size_t n : {1u, 300u, 20000u}) {
            Triangles t = random_triangles(n, scale, (n > 1000 ? 0.03f : 0.3f) * scale, 5);
            for (std::size_t i = 0; i < n; i += 5) t.list.push_back(t.list[i]); // ties
            expect_same_as_stack(t, scale, n, tiles_of_rays);
        }
    Triangles mixed = random_triangles(3000, 1, 0.1f, 6);
    for (std::size_t i = 0; i < mixed.list.size(); ++i)
        mixed.kinds.push_back(i % 5 < 3   ? PrimitiveKind::triangle
                              : i % 5 < 4 ? PrimitiveKind::filtered_triangle
                                          : PrimitiveKind::custom);
    expect_same_as_stack(mixed, 1, 7, tiles_of_rays);
    // Large triangles, which all rays of a tile meet.
    expect_same_as_stack(random_triangles(40, 1, 2, 9), 1, 8, tiles_of_rays);
}

// Boxes of many sizes, one like another on the axes and turned.
Triangles boxes(float scale, std::uint64_t seed) {
    Rng rng(seed);
    Triangles t;
    for (int i = 0; i < 60; ++i) {
        const Vec3 middle = random_point(rng, scale), half = random_point(rng, i % 10 ? 0.1f * scale : scale);
        Frame frame;
        if (i % 2) frame = Frame::from_z(normalize(random_point(rng, 1)));
        auto corner = [&](int k) {
            return middle + frame.to_world({k & 1 ? half.x : -half.x, k & 2 ? half.y : -half.y,
                                            k & 4 ? half.z : -half.z});
        };
        for (int axis = 0; axis < 3; ++axis)
            for (int side = 0; side < 2; ++side) {
                const int first = side << axis, u = 1 << (axis + 1) % 3, v = 1 << (axis + 2) % 3;
                t.list.push_back(Corners{corner(first), corner(first | u), corner(first | u | v)});
                t.list.push_back(Corners{corner(first), corner(first | u | v), corner(first | v)});
            }
    }
    return t;
}

TEST_P(Kernels, GiveTheSameBitsForRaysThatLeaveATriangle) {
    // Of the smallest, products are hardly numbers any more.
    for (float scale : {2e-15f, 1e-14f, 1e-13f, 1e-6f, 1.0f, 1e6f}) {
        expect_same_as_stack(boxes(scale, 11), scale, 12, rays_from_surfaces);
        expect_same_as_stack(random_triangles(300, scale, 0.3f * scale, 13), scale, 14, rays_from_surfaces);
    }
}

std::vector<std::string> supported() {
    std::vector<std::string> names;
    for (const WideKernels* k : supported_wide_kernels()) names.emplace_back(k->name);
    return names;
}
std::string name_of(const testing::TestParamInfo<std::string>& kernels) {
    return kernels.param;
}
INSTANTIATE_TEST_SUITE_P(All, Kernels, testing::ValuesIn(supported()), name_of);

TEST(WideKernels, ThereIsOneForEveryProcessor) {
    EXPECT_STREQ(supported_wide_kernels().back()->name, "plain");
    EXPECT_STREQ(wide_kernels("plain").name, "plain");
    // Unknown names give the best.
    EXPECT_EQ(&wide_kernels("mmx"), supported_wide_kernels().front());
}

// Every place of the order once, every child's box around its primitives, and the promised stack.
void check_collapse(const Tree& tree, const CollapsedTree& collapsed, std::uint32_t stack_limit) {
    std::vector<int> seen(tree.order.size(), 0);
    auto note = [&](const WideLeaf& leaf) {
        EXPECT_LE(leaf.count, 8u);
        for (std::uint32_t i = 0; i < leaf.count; ++i) ++seen[leaf.first + i];
    };
    if (collapsed.single_leaf.count > 0) note(collapsed.single_leaf);
    for (const CollapsedNode& node : collapsed.nodes.all()) {
        EXPECT_GE(node.count, 2);
        EXPECT_LE(node.count, 8);
        for (std::size_t k = 0; k < static_cast<std::size_t>(node.count); ++k)
            if (node.child[k].is_leaf()) note(node.child[k].leaf);
    }
    EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), static_cast<std::ptrdiff_t>(seen.size()));
    EXPECT_LE(collapsed.stack, stack_limit);
}

TEST(Collapse, KeepsAllPrimitives) {
    for (std::size_t n : {1u, 2u, 8u, 9u, 100u, 5000u})
        for (std::uint32_t leaf_size : {1u, 4u, 8u}) {
            Triangles t = random_triangles(n, 1, 0.1f, n);
            Tree tree = sah_builder().build(t, t.boxes(), {.leaf_size = leaf_size});
            check_collapse(tree, collapse(tree, t, {}, wide_stack), wide_stack);
        }
}

// A wavy sheet of n x n squares.
Triangles sheet(int n) {
    Triangles t;
    auto at = [](int i, int j) {
        auto x = static_cast<float>(i), y = static_cast<float>(j);
        return Vec3{x, y, std::sin(0.3f * x) * std::cos(0.2f * y)};
    };
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            t.list.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            t.list.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    return t;
}

TEST(Collapse, FillsNodesAndLeaves) {
    Triangles t = sheet(100);
    Tree tree = sah_builder().build(t, t.boxes(), {.leaf_size = 1});
    CollapsedTree collapsed = collapse(tree, t, {}, wide_stack);
    double children = 0, leaves = 0;
    for (const CollapsedNode& node : collapsed.nodes.all()) {
        children += node.count;
        for (std::size_t k = 0; k < static_cast<std::size_t>(node.count); ++k)
            leaves += node.child[k].is_leaf();
    }
    // Of eight each; measured: 7.7 children a node, 5.1 triangles a leaf.
    EXPECT_GT(children / static_cast<double>(collapsed.nodes.size()), 6.5);
    EXPECT_GT(20000 / leaves, 3.5);
}

TEST(Collapse, CostsLessThanTheTreeItComesFrom) {
    Triangles t = random_triangles(5000, 1, 0.05f, 4);
    Tree tree = sah_builder().build(t, t.boxes(), {.leaf_size = 1});
    EXPECT_LT(collapse(tree, t, {}, wide_stack).cost, stats_of(tree).sah_cost);
}

TEST(Collapse, ADeepTreeIsCollapsedByHeightAndStaysWithinTheStack) {
    // A chain: each node splits one primitive off. By cost every place might go elsewhere than along the
    // chain.
    const std::uint32_t n = Tree::max_depth;
    Triangles t = random_triangles(n, 1, 0.1f, 5);
    Tree tree;
    for (std::uint32_t i = 0; i < n; ++i) {
        Tree::Node leaf{t.bounds(i), i, 1};
        tree.order.push_back(i);
        if (i + 1 < n) {
            Tree::Node inner{{}, static_cast<std::uint32_t>(tree.nodes.size() + 2), 0};
            for (std::uint32_t k = i; k < n; ++k) inner.bounds.extend(t.bounds(k));
            tree.nodes.push_back(inner);
        }
        tree.nodes.push_back(leaf);
    }
    CollapsedTree collapsed = collapse(tree, t, {}, 8);
    check_collapse(tree, collapsed, wide_stack - 8);
    EXPECT_LE(collapsed.depth, Tree::max_depth / 3 + 1);
    auto wide = wide_walk().make(t, tree, {});
    NoTests tests;
    Rng rng(6);
    for (int i = 0; i < 500; ++i) {
        Ray ray = random_ray(t, 1, rng);
        Intersection hit, expected = t.brute_force(ray);
        wide->closest(ray, hit, tests);
        ASSERT_EQ(hit.primitive, expected.primitive);
    }
}

TEST(WideLayout, TakesAboutFiftyBytesATriangle) {
    Triangles t = sheet(158);
    Tree tree = sah_builder().build(t, t.boxes(), {.leaf_size = 1});
    WideLayout layout(tree, t);
    // 40 a triangle in a leaf, a node of 256 for each 33 triangles or so, and what is lost to alignment.
    EXPECT_GT(static_cast<double>(layout.stats().bytes) / t.count(), 40);
    EXPECT_LT(static_cast<double>(layout.stats().bytes) / t.count(), 60);
}

} // namespace
} // namespace alhazen
