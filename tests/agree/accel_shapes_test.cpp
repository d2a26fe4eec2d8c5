/// The acceleration structure against trying every primitive, for all kinds of shapes mixed in one object.

#include <gtest/gtest.h>

#include "accel/bvh.h"
#include "tests/conformance/shape_cases.h"

namespace alhazen {
namespace {

using namespace shape_cases;

struct Mix {
    struct Item {
        const Shape* shape;
        std::uint32_t primitive;
    };
    std::vector<std::unique_ptr<Shape>> shapes;
    std::vector<Item> items;
    std::vector<Bounds3> boxes;
    Bounds3 bounds;

    bool test(std::uint32_t i, const Ray& ray, Intersection& hit) const {
        return items[i].shape->intersect(ray, items[i].primitive, hit);
    }
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
            mix.bounds.extend(mix.boxes.back());
        }
    return mix;
}

TEST(AccelAgreement, AllShapesAtAllScales) {
    for (double scale : {1e-6, 1.0, 1e6}) {
        Mix mix = scatter(scale, 1);
        Bvh bvh(mix.boxes);
        Sphere3 ball = bounding_sphere(mix.bounds);
        Rng rng(2);
        int hits = 0;
        for (int i = 0; i < 10000; ++i) {
            Ray ray = random_line(ball, rng);
            if (i % 3 == 0) ray.d = ray.d * 1e3f;
            if (i % 5 == 0) ray.tmax = 2 * rng.uniform() * ball.radius;
            Intersection expected, hit;
            Ray rest = ray;
            for (std::uint32_t k = 0; k < mix.items.size(); ++k) {
                Intersection candidate;
                if (!mix.test(k, rest, candidate)) continue;
                expected = candidate;
                expected.primitive = k;
                rest.tmax = candidate.t;
            }
            auto leaf = [&](std::uint32_t k, const Ray& r, Intersection& candidate) {
                return mix.test(k, r, candidate);
            };
            ASSERT_EQ(bvh.closest(ray, hit, leaf), expected.found()) << scale << " ray " << i;
            ASSERT_EQ(hit.primitive, expected.primitive) << scale << " ray " << i;
            ASSERT_EQ(hit.t, expected.t);
            ASSERT_EQ(bvh.any(ray, leaf), expected.found());
            hits += hit.found();
        }
        EXPECT_GT(hits, 1000);
    }
}

} // namespace
} // namespace alhazen
