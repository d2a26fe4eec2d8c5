/// What is measured is right wherever it does not depend on the clock.
#include <set>

#include <gtest/gtest.h>

#include "lab/measure.h"
#include "lab/timing.h"
#include "tests/unit/lab/scenes.h"

namespace alhazen {
namespace {

using namespace lab_test;

AccelChoice choice(std::string builder, std::string walk) {
    AccelChoice c;
    c.builder = std::move(builder);
    c.walk = std::move(walk);
    return c;
}

LabOptions quick() {
    LabOptions options;
    options.rays.rays = 768;
    options.repeat = 1;
    options.heat_map_pixels = 768;
    return options;
}

TEST(Lab, MeasuresEveryChoiceWithEveryKindOfRays) {
    auto world = mesh_world();
    LabReport report =
        measure(*world, "fence", {choice("sah", "stack"), choice("lbvh", "stackless")}, quick());
    EXPECT_EQ(report.scene, "fence");
    EXPECT_EQ(report.triangles, 258u);
    EXPECT_EQ(report.builds.size(), 2u);
    EXPECT_EQ(report.visits.size(), 2u);
    std::set<std::string> asked;
    for (const WalkRecord& w : report.walks) {
        asked.insert(std::to_string(w.build) + " " + std::string(name_of(w.rays)) + " " +
                     std::string(name_of(w.query)) + " " + std::string(name_of(w.mode)));
        EXPECT_GT(w.mrays_per_s, 0);
        EXPECT_GE(w.nodes_per_ray, 0.5);
        EXPECT_EQ(w.peer_ratio.has_value(), !report.peer.empty());
    }
    // Primary rays ask for the nearest hit, shadow rays for any; the others for both; each in two modes.
    EXPECT_EQ(asked.size(), 2u * 6 * 2);
    EXPECT_EQ(report.walks.size(), asked.size());
    EXPECT_TRUE(asked.contains("1 shadow any batch"));
    for (const BuildRecord& b : report.builds) {
        EXPECT_GT(b.bytes_per_triangle, 10);
        EXPECT_GT(b.nodes, 30u);
        EXPECT_GT(b.depth, 3);
        EXPECT_GT(b.sah_cost, 1);
        EXPECT_GT(b.end_point_overlap, 0);
    }
}

TEST(Lab, CountsDoNotDependOnTheRunOrOnThreads) {
    auto world = mesh_world();
    LabOptions options = quick();
    LabReport a = measure(*world, "", {choice("ploc", "cwbvh")}, options);
    options.threads = 2;
    LabReport b = measure(*world, "", {choice("ploc", "cwbvh")}, options);
    EXPECT_EQ(b.threads, 2);
    for (std::size_t i = 0; i < a.walks.size(); ++i) {
        EXPECT_EQ(a.walks[i].nodes_per_ray, b.walks[i].nodes_per_ray);
        EXPECT_EQ(a.walks[i].leaves_per_ray, b.walks[i].leaves_per_ray);
        EXPECT_EQ(a.walks[i].max_stack, b.walks[i].max_stack);
    }
    EXPECT_EQ(a.builds[0].sah_cost, b.builds[0].sah_cost);
    for (std::size_t i = 0; i < a.visits[0].values().size(); ++i)
        EXPECT_EQ(a.visits[0].values()[i], b.visits[0].values()[i]);
}

TEST(Lab, AStackOfOneEntryRestarts) {
    auto world = mesh_world();
    AccelChoice one = choice("sah", "shortstack"), many = one;
    one.walk_options.stack_entries = 1;
    many.walk_options.stack_entries = 64;
    LabReport report = measure(*world, "", {one, many}, quick());
    double restarts[2] = {0, 0};
    for (const WalkRecord& w : report.walks) restarts[w.build] += w.restarts_per_ray;
    EXPECT_GT(restarts[0], 0);
    EXPECT_EQ(restarts[1], 0);
    for (const WalkRecord& w : report.walks) EXPECT_LE(w.max_stack, w.build == 0 ? 1u : 64u);
}

TEST(Lab, EveryWayOfTracingFindsTheSame) {
    auto world = mesh_world();
    auto sets = make_ray_sets(*world, {1024, 1});
    Answers expected, found;
    for (Query query : {Query::closest, Query::any}) {
        world->scene->rebuild(choice("sah", "stack"));
        trace(world->scene->root(), query, TraceMode::single, sets[1].rays, 1, expected);
        for (const AccelWalk& walk : accel_walks()) {
            world->scene->rebuild(choice("sbvh", std::string(walk.name)));
            for (TraceMode mode : {TraceMode::single, TraceMode::batch})
                for (int threads : {1, 2}) {
                    EXPECT_GT(trace(world->scene->root(), query, mode, sets[1].rays, threads, found), 0);
                    EXPECT_EQ(compare(query, expected, found).same, 1) << walk.name << " " << name_of(mode);
                }
        }
    }
    std::size_t hits = 0;
    for (std::size_t i = 0; i < 1024; ++i) hits += expected.found(Query::any, i);
    EXPECT_GT(hits, 50u);
    EXPECT_LT(hits, 1000u);
}

TEST(Lab, ThePeerFindsTheSameTriangles) {
    auto world = mesh_world();
    LabReport report = measure(*world, "", {choice("sah", "stack")}, quick());
    if (peer_library().empty()) {
        EXPECT_NE(report.why_alone, "");
        GTEST_SKIP() << "built without Embree";
    }
    EXPECT_EQ(report.peer, peer_library());
    for (const WalkRecord& w : report.walks) {
        // A ray in a thousand may graze an edge.
        EXPECT_GE(w.agreement->same + w.agreement->ties, 0.998) << name_of(w.rays) << name_of(w.query);
        EXPECT_NE(w.opponent, "");
        EXPECT_GT(*w.peer_ratio, 0);
    }
    for (PeerQuality quality : {PeerQuality::low, PeerQuality::medium, PeerQuality::high}) {
        auto peer = make_peer(world->scene->root(), {quality, 1, false});
        auto sets = make_ray_sets(*world, {1000, 3});
        Answers ours, single, packets;
        trace(world->scene->root(), Query::closest, TraceMode::single, sets[1].rays, 1, ours);
        trace(*peer, Query::closest, PeerCall::single, sets[1].rays, 1, single);
        trace(*peer, Query::closest, PeerCall::packet16, sets[1].rays, 1, packets);
        EXPECT_GE(compare(Query::closest, ours, single).same, 0.998);
        EXPECT_GE(compare(Query::closest, ours, packets).same, 0.998);
        EXPECT_GT(peer->bytes(), 258u * 20);
    }
}

TEST(Lab, ScenesOfOtherShapesAreMeasuredAlone) {
    auto world = world_of(view + lamp + ground + "Shape \"sphere\"\n");
    LabReport report = measure(*world, "", {choice("sah", "guthe")}, quick());
    EXPECT_EQ(report.peer, "");
    EXPECT_NE(report.why_alone, "");
    EXPECT_EQ(report.walks.size(), 12u);
    for (const WalkRecord& w : report.walks) EXPECT_FALSE(w.peer_ratio || w.agreement);
}

TEST(Lab, CountsReachIntoInstances) {
    std::string object = "ObjectBegin \"o\"\n" + fence(256) + "ObjectEnd\nObjectInstance \"o\"\n";
    auto direct = world_of(view + lamp + fence(256)), placed = world_of(view + lamp + object);
    Image a = count_visits(*direct, {64, 48}), b = count_visits(*placed, {64, 48});
    double nodes_a = 0, nodes_b = 0;
    for (float v : a.values()) nodes_a += static_cast<double>(v);
    for (float v : b.values()) nodes_b += static_cast<double>(v);
    // The same tree, found through one more box.
    EXPECT_GE(nodes_b, 0.9 * nodes_a);
    EXPECT_LE(nodes_b, 1.5 * nodes_a + 64 * 48);
}

TEST(Lab, AnEmptySceneIsMeasuredToo) {
    auto world = world_of(view);
    LabReport report = measure(*world, "", {choice("lbvh", "cwbvh")}, quick());
    EXPECT_EQ(report.walks.size(), 2u);
    EXPECT_EQ(report.walks[0].leaves_per_ray, 0);
}

TEST(Compare, TellsTiesFromMistakes) {
    Answers a, b;
    a.reset(Query::closest, 4);
    b.reset(Query::closest, 4);
    a.hits[1] = b.hits[1] = {2, 0, 0, 7, 0};
    a.hits[2] = {2, 0, 0, 7, 0};
    b.hits[2] = {2.000001f, 0, 0, 8, 0};
    b.hits[3] = {2, 0, 0, 7, 0};
    Agreement closest = compare(Query::closest, a, b);
    EXPECT_EQ(closest.same, 0.5);
    EXPECT_EQ(closest.ties, 0.25);
    a.blocked = {0, 1, 1, 0};
    b.blocked = {0, 1, 0, 0};
    EXPECT_EQ(compare(Query::any, a, b).same, 0.75);
}

TEST(Timing, MedianAndSpread) {
    EXPECT_EQ(median_of({}), 0);
    EXPECT_EQ(median_of({3, 1, 2}), 2);
    EXPECT_EQ(median_of({4, 1, 2, 3}), 2.5);
    EXPECT_EQ(spread_of({2, 1, 4}), 1.5);
    EXPECT_EQ(spread_of({}), 0);
    EXPECT_GT(seconds_of(1, [] {}), 0);
}

} // namespace
} // namespace alhazen
