/// The short stack: right with any number of entries, and with enough of them no restarts.

#include <gtest/gtest.h>

#include "tests/unit/accel/support.h"

namespace alhazen {
namespace {

using namespace accel_test;

// The counts of many rays, after a comparison of each with trying every primitive.
WalkCounts counts_with(int entries, const Triangles& t, const Tree& tree, std::uint64_t seed) {
    auto structure = shortstack_walk().make(t, tree, {.stack_entries = entries});
    TriangleTests tests(t);
    Rng rng(seed);
    WalkCounts counts;
    for (int i = 0; i < 400; ++i) {
        Ray ray = random_ray(t, 1, rng);
        Intersection hit, expected = t.brute_force(ray);
        EXPECT_EQ(structure->closest(ray, hit, tests), expected.found());
        EXPECT_EQ(hit.primitive, expected.primitive) << "ray " << i << ", entries " << entries;
        EXPECT_EQ(hit.t, expected.t);
        EXPECT_EQ(structure->any(ray, tests), expected.found());
        structure->count(Query::closest, ray, tests, counts);
    }
    return counts;
}

TEST(ShortStack, RestartsFallWithTheNumberOfEntriesAndTheAnswersStay) {
    Triangles t = random_triangles(3000, 1, 0.1f, 1);
    Tree tree = sah_builder().build(t, t.boxes(), {});
    WalkCounts last;
    std::uint64_t most_nodes = 0;
    for (int entries : {1, 2, 3, 5, 8, 16, 64}) {
        WalkCounts counts = counts_with(entries, t, tree, 2);
        EXPECT_LE(counts.max_stack, static_cast<std::uint32_t>(entries));
        if (entries > 1) {
            EXPECT_LE(counts.restarts, last.restarts) << entries;
            // A restart repeats nodes, never leaves.
            EXPECT_EQ(counts.leaves, last.leaves) << entries;
        } else {
            EXPECT_GT(counts.restarts, 400u);
            most_nodes = counts.nodes;
        }
        last = counts;
    }
    EXPECT_EQ(last.restarts, 0u);
    EXPECT_LT(last.nodes, most_nodes);
}

// Where many boxes are entered at the same distance only the fixed order tells children apart.
TEST(ShortStack, ChildrenAtTheSameDistanceAreAllVisited) {
    Triangles t;
    for (int i = 0; i < 400; ++i) {
        auto x = static_cast<float>(i % 20) * 0.1f - 1, y = static_cast<float>(i / 20) * 0.1f - 1;
        t.list.push_back({{x, y, 0}, {x + 1, y, 0}, {x, y + 1, 0}});
    }
    std::reverse(t.list.begin(), t.list.end());
    Tree tree = sah_builder().build(t, t.boxes(), {1, 1});
    std::uint64_t leaves = 0;
    for (int entries : {1, 2, 3, 8, 64}) {
        WalkCounts counts = counts_with(entries, t, tree, 3);
        if (leaves == 0) leaves = counts.leaves;
        EXPECT_EQ(counts.leaves, leaves);
    }
}

} // namespace
} // namespace alhazen
