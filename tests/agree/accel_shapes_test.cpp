/// The acceleration structure against trying every primitive, for all kinds of shapes mixed in one object.

#include <gtest/gtest.h>

#include "accel/accel.h"
#include "tests/conformance/shape_cases.h"

namespace alhazen {
namespace {

using namespace shape_cases;

struct Mix final : Primitives {
    struct Item {
        const Shape* shape;
        std::uint32_t primitive;
    };
    std::vector<std::unique_ptr<Shape>> shapes;
    std::vector<Item> items;
    std::vector<Bounds3> boxes;
    Bounds3 whole;

    std::uint32_t count() const override { return static_cast<std::uint32_t>(items.size()); }
    PrimitiveKind kind(std::uint32_t) const override { return PrimitiveKind::custom; }
    Bounds3 bounds(std::uint32_t i) const override { return boxes[i]; }
    Corners corners(std::uint32_t) const override { return {}; }

    bool test(std::uint32_t i, const Ray& ray, Intersection& hit) const {
        return items[i].shape->intersect(ray, items[i].primitive, hit);
    }
};

struct MixTests final : PrimitiveTests {
    const Mix& mix;
    explicit MixTests(const Mix& m) : mix(m) {}
    bool intersect(const Question& q, Intersection& hit) override {
        return mix.test(q.primitive, q.ray, hit);
    }
    bool accept(const Question&, const Intersection&) override { return true; }
};

// Every example of every kind, scattered; each stands there twice, so that ties abound.
Mix scatter(double scale, std::uint64_t seed) {
    Mix mix;
    Rng rng(seed);
    auto number = [&] { return 2 * static_cast<double>(rng.uniform()) - 1; };
    for (const Kind<Shape>& kind : shape_kinds().all())
        for (const Example& example : kind.doc().examples)
            for (int i = 0; i < 6; ++i) {
                Matrix4 m = Matrix4::scale({scale, scale, scale}) *
                            Matrix4::translate({8 * number(), 8 * number(), 8 * number()}) *
                            Matrix4::rotate(180 * number(), {number(), number(), number()}) *
                            Matrix4::scale({1, 1 + 0.5 * number(), 1});
                for (int copy = 0; copy < 2; ++copy)
                    mix.shapes.push_back(make_case(kind, example, {"", m, copy == 1}).shape);
            }
    for (const auto& shape : mix.shapes)
        for (std::uint32_t k = 0; k < shape->primitive_count(); ++k) {
            mix.items.push_back({shape.get(), k});
            mix.boxes.push_back(shape->bounds(k));
            mix.whole.extend(mix.boxes.back());
        }
    return mix;
}

TEST(AccelAgreement, AllShapesAtAllScales) {
    for (double scale : {1e-6, 1.0, 1e6}) {
        Mix mix = scatter(scale, 1);
        MixTests tests(mix);
        std::vector<std::unique_ptr<Structure>> structures;
        for (const AccelWalk& walk : accel_walks())
            structures.push_back(make_structure(mix, {"sah", std::string(walk.name), {}}));
        Sphere3 ball = bounding_sphere(mix.whole);
        Rng rng(2);
        int hits = 0;
        for (int i = 0; i < 10000; ++i) {
            Ray ray = random_line(ball, rng);
            if (i % 3 == 0) ray.d = ray.d * 1e3f;
            if (i % 5 == 0) ray.tmax = 2 * rng.uniform() * ball.radius;
            Intersection expected;
            Ray rest = ray;
            for (std::uint32_t k = 0; k < mix.items.size(); ++k) {
                Intersection candidate;
                if (!mix.test(k, rest, candidate)) continue;
                expected = candidate;
                expected.primitive = k;
                rest.tmax = candidate.t;
            }
            for (const auto& structure : structures) {
                Intersection found;
                ASSERT_EQ(structure->closest(ray, found, tests), expected.found()) << scale << " ray " << i;
                ASSERT_EQ(found.primitive, expected.primitive) << scale << " ray " << i;
                ASSERT_EQ(found.t, expected.t);
                ASSERT_EQ(structure->any(ray, tests), expected.found());
            }
            hits += expected.found();
        }
        EXPECT_GT(hits, 1000);
    }
}

} // namespace
} // namespace alhazen
