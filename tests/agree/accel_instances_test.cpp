/// Objects placed in objects, with every builder and walk: the same bits from all of them, and what trying
/// every primitive of every instance finds.

#include <gtest/gtest.h>

#include "scene/object.h"
#include "tests/conformance/shape_cases.h"

namespace alhazen {
namespace {

using namespace shape_cases;

/// A picket of shapes in a ring, the ring placed many times, beside shapes of its own.
struct SmallWorld {
    std::unique_ptr<Object> ring, root;

    explicit SmallWorld(const AccelChoice& accel) {
        Rng rng(1);
        auto number = [&] { return 2 * static_cast<double>(rng.uniform()) - 1; };
        auto shapes = [&](double reach) {
            std::vector<PlacedShape> list;
            for (const Kind<Shape>& kind : shape_kinds().all())
                for (const Example& example : kind.doc().examples) {
                    Matrix4 m = Matrix4::translate({reach * number(), reach * number(), reach * number()}) *
                                Matrix4::rotate(180 * number(), {number(), number(), 1});
                    PlacedShape placed;
                    placed.shape = make_case(kind, example, {"", m, false}).shape;
                    list.push_back(std::move(placed));
                }
            return list;
        };
        ring = std::make_unique<Object>(shapes(2), std::vector<PlacedObject>{}, accel);
        std::vector<PlacedObject> places;
        for (std::uint32_t i = 0; i < 12; ++i) {
            // The last two at the same place: ties.
            Matrix4 m = Matrix4::translate({4, 1, 2});
            if (i < 10)
                m = Matrix4::translate({6 * number(), 6 * number(), 6 * number()}) *
                    Matrix4::rotate(180 * number(), {number(), 1, number()}) *
                    Matrix4::scale({1 + 0.5 * number(), 1, i % 2 ? -1.0 : 0.3});
            PlacedObject placed;
            placed.object = ring.get();
            placed.world_from_object = Transform(m);
            placed.object_from_world = placed.world_from_object.inverse();
            placed.number = i;
            // Some move, and turn and stretch on the way.
            if (i >= 4 && i < 8)
                placed.movement = std::make_shared<const MovingTransform>(
                    *MovingTransform::make(m,
                                           Matrix4::translate({3 * number(), number(), 0}) *
                                               Matrix4::rotate(150 * number(), {1, 2, 0}) * m,
                                           0.25f, 1.5f));
            places.push_back(placed);
        }
        root = std::make_unique<Object>(shapes(6), std::move(places), accel);
    }

    /// By trying everything; up to the rounding of the ray's way into instances.
    float nearest(const Ray& ray) const {
        Ray rest = ray;
        rest.tmax = nearest_in(*root, rest);
        for (const PlacedObject& placed : root->instances()) {
            Ray local = placed.movement ? placed.movement->at(ray.time).inverse_ray(rest)
                                        : placed.object_from_world.ray(rest);
            local.tmax = rest.tmax;
            rest.tmax = nearest_in(*placed.object, local);
        }
        return rest.tmax;
    }

  private:
    static float nearest_in(const Object& object, Ray ray) {
        for (const PlacedShape& placed : object.shapes())
            for (std::uint32_t i = 0; i < placed.shape->primitive_count(); ++i) {
                Intersection hit;
                if (placed.shape->intersect(ray, i, hit)) ray.tmax = hit.t;
            }
        return ray.tmax;
    }
};

std::vector<Ray> rays_through(const Object& root, int count) {
    Rng rng(2);
    Sphere3 ball = bounding_sphere(root.bounds());
    std::vector<Ray> rays;
    for (int i = 0; i < count; ++i) {
        rays.push_back(random_line(ball, rng));
        rays.back().time = 2 * rng.uniform();
    }
    return rays;
}

struct Answer {
    Found found;
    bool any;
};
std::vector<Answer> answers(const Object& root, const std::vector<Ray>& rays) {
    std::vector<Answer> list(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) {
        root.closest(rays[i], list[i].found);
        list[i].any = root.any(rays[i]);
    }
    return list;
}
void expect_same(const Found& a, const Found& b, const SmallWorld& of_a, const SmallWorld& of_b) {
    ASSERT_EQ(a.object == nullptr, b.object == nullptr);
    if (!a.object) return;
    // The same object, of two worlds.
    ASSERT_EQ(a.object == of_a.root.get(), b.object == of_b.root.get());
    ASSERT_EQ(a.depth, b.depth);
    for (std::size_t k = 0; k < a.depth; ++k) ASSERT_EQ(a.instances[k]->number, b.instances[k]->number);
    ASSERT_EQ(a.hit.primitive, b.hit.primitive);
    ASSERT_EQ(a.hit.t, b.hit.t);
    ASSERT_EQ(a.hit.u, b.hit.u);
    ASSERT_EQ(a.hit.v, b.hit.v);
}

TEST(Instances, AreFoundAsByTryingEverything) {
    SmallWorld world(AccelChoice{});
    auto rays = rays_through(*world.root, 4000);
    int hits = 0, inside = 0, different = 0;
    auto list = answers(*world.root, rays);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const Found& found = list[i].found;
        const float expected = world.nearest(rays[i]);
        const bool agree =
            found.object ? std::abs(found.hit.t - expected) < 1e-3f * expected : expected == rays[i].tmax;
        different += !agree;
        hits += found.object != nullptr;
        inside += found.object == world.ring.get();
    }
    EXPECT_GT(hits, 400);
    EXPECT_GT(inside, 300);
    // Rays that graze an edge.
    EXPECT_LE(different, 4);
}

TEST(Instances, GiveTheSameBitsWithEveryBuilderAndWalk) {
    SmallWorld reference(AccelChoice{"sah", "stack", {}});
    auto rays = rays_through(*reference.root, 1000);
    auto expected = answers(*reference.root, rays);
    for (const AccelBuilder& builder : accel_builders())
        for (const AccelWalk& walk : accel_walks()) {
            SCOPED_TRACE(std::string(builder.name) + "/" + std::string(walk.name));
            SmallWorld world(AccelChoice{std::string(builder.name), std::string(walk.name), {}});
            auto found = answers(*world.root, rays);
            std::vector<Intersection> hits(rays.size());
            std::vector<Found> batch(rays.size());
            std::vector<std::uint8_t> blocked(rays.size());
            world.root->closest(rays, hits, batch);
            world.root->any(rays, blocked);
            for (std::size_t i = 0; i < rays.size(); ++i) {
                expect_same(found[i].found, expected[i].found, world, reference);
                expect_same(batch[i], expected[i].found, world, reference);
                ASSERT_EQ(found[i].any, expected[i].any) << "ray " << i;
                ASSERT_EQ(blocked[i] != 0, expected[i].any) << "ray " << i;
                if (HasFatalFailure()) return;
            }
        }
}

} // namespace
} // namespace alhazen
