/// Ten million triangles: every builder with every walk.

#include <gtest/gtest.h>

#include "accel/accel.h"
#include "accel/triangle.h"
#include "base/hash.h"

namespace alhazen {
namespace {

/// A landscape on a grid: hills that are parabolas, roughened by hashes; nothing is stored.
struct Landscape final : Primitives {
    static constexpr std::uint32_t side = 2237;

    std::uint32_t count() const override { return 2 * side * side; }
    PrimitiveKind kind(std::uint32_t) const override { return PrimitiveKind::triangle; }
    Bounds3 bounds(std::uint32_t i) const override {
        const Corners t = corners(i);
        Bounds3 box;
        for (Vec3 p : {t.a, t.b, t.c}) box.extend(p);
        return box;
    }
    Corners corners(std::uint32_t i) const override {
        const std::uint32_t x = i / 2 % side, y = i / 2 / side;
        return i % 2 ? Corners{point(x, y), point(x + 1, y + 1), point(x, y + 1)}
                     : Corners{point(x, y), point(x + 1, y), point(x + 1, y + 1)};
    }
    static Vec3 point(std::uint32_t x, std::uint32_t y) {
        const auto u = static_cast<float>(x), v = static_cast<float>(y);
        const float a = static_cast<float>(x % 300) / 300, b = static_cast<float>(y % 400) / 400;
        return {u, 600 * a * (1 - a) * b * (1 - b) + unit_float(hash_of(x, y)), v};
    }

    Intersection brute_force(Ray ray) const {
        const RayShear shear(ray);
        Intersection best;
        for (std::uint32_t i = 0; i < count(); ++i) {
            const Corners t = corners(i);
            Intersection hit;
            if (!intersect_triangle(ray, shear, t.a, t.b, t.c, hit)) continue;
            best = hit;
            best.primitive = i;
            ray.tmax = hit.t;
        }
        return best;
    }
};

// From above, along the ground, and through vertices.
std::vector<Ray> rays() {
    Rng rng(1);
    auto place = [&](float height) {
        const auto side = static_cast<float>(Landscape::side);
        const float x = side * rng.uniform(), y = side * rng.uniform();
        return Vec3{x, height, y};
    };
    std::vector<Ray> list;
    for (int i = 0; i < 3000; ++i) {
        const Vec3 o = place(i % 2 ? 500.0f : 30 * rng.uniform());
        Vec3 target = place(0);
        if (i % 3 == 0) target = Landscape::point(rng.below(Landscape::side), rng.below(Landscape::side));
        list.push_back({o, target - o});
    }
    return list;
}

struct Answers {
    std::vector<Intersection> hits;
    std::vector<std::uint8_t> blocked;
};
Answers ask(const Structure& structure, const std::vector<Ray>& rays) {
    Answers answers{std::vector<Intersection>(rays.size()), std::vector<std::uint8_t>(rays.size())};
    NoTests tests;
    structure.closest(rays, answers.hits, tests);
    structure.any(rays, answers.blocked, tests);
    return answers;
}

void expect_same(const Answers& found, const Answers& expected) {
    for (std::size_t i = 0; i < expected.hits.size(); ++i) {
        ASSERT_EQ(found.hits[i].primitive, expected.hits[i].primitive) << "ray " << i;
        ASSERT_EQ(found.hits[i].t, expected.hits[i].t) << "ray " << i;
        ASSERT_EQ(found.hits[i].u, expected.hits[i].u) << "ray " << i;
        ASSERT_EQ(found.hits[i].v, expected.hits[i].v) << "ray " << i;
        ASSERT_EQ(found.blocked[i] != 0, expected.hits[i].found()) << "ray " << i;
    }
}

// Large leaves: what takes time here is to write the layouts' nodes.
constexpr BuildOptions options{.node_cost = 4, .leaf_size = 8};

std::unique_ptr<Structure> lay_out(const Landscape& landscape, const Tree& tree, std::string_view walk) {
    return make_structure(landscape, tree, {"", std::string(walk), {}});
}

class TenMillion : public testing::TestWithParam<AccelBuilder> {};

// One structure after another, since all together would take tens of gigabytes. What is expected comes from
// the quickest builder and the simplest walk, and for a few rays from trying every triangle.
TEST_P(TenMillion, EveryWalkFindsTheSame) {
    const Landscape landscape;
    const std::vector<Ray> list = rays();
    const std::vector<Bounds3> boxes = padded_boxes(landscape);
    const Answers expected =
        ask(*lay_out(landscape, lbvh_builder().build(landscape, boxes, options), "stack"), list);
    std::size_t hits = 0;
    for (const Intersection& hit : expected.hits) hits += hit.found();
    EXPECT_GT(hits, list.size() / 2);
    const Tree tree = GetParam().build(landscape, boxes, options);
    for (const AccelWalk& walk : accel_walks()) {
        SCOPED_TRACE(walk.name);
        expect_same(ask(*lay_out(landscape, tree, walk.name), list), expected);
        if (HasFatalFailure()) return;
    }
    for (std::size_t i = 0; i < 2; ++i) {
        const Intersection hit = landscape.brute_force(list[i]);
        EXPECT_EQ(expected.hits[i].primitive, hit.primitive) << "ray " << i;
        EXPECT_EQ(expected.hits[i].t, hit.t) << "ray " << i;
    }
}

INSTANTIATE_TEST_SUITE_P(Builders, TenMillion,
                         testing::ValuesIn(accel_builders().begin(), accel_builders().end()),
                         [](const auto& test) { return std::string(test.param.name); });

} // namespace
} // namespace alhazen
