/// Every example of every registered shape, in several places of the world, and lines that cross them.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/hash.h"
#include "describe/mesh_file.h"
#include "shapes/shape.h"
#include "tests/support/effort.h"
#include "tests/support/sdf_world.h"

namespace alhazen::shape_cases {

struct ShapeCase {
    std::string name;
    std::string kind, example;
    Node node;
    Transform world_from_object;
    std::unique_ptr<Shape> shape;
    Bounds3 bounds;
    Sphere3 ball; ///< around the bounds

    float size() const { return ball.radius; }
};

/// Stands in for the mesh file of plymesh's example: a house of four quadrilaterals and two triangles.
inline MeshData house() {
    MeshData mesh;
    mesh.P = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {-1, 0, 1.5f}, {1, 0, 1.5f}};
    mesh.quad_indices = {0, 1, 4, 5, 2, 3, 5, 4, 1, 0, 2, 3};
    mesh.indices = {1, 2, 5, 3, 0, 4};
    return mesh;
}

struct ShapePlace {
    std::string name;
    Matrix4 matrix;
    bool reverse = false;
};

inline std::vector<ShapePlace> places() {
    Matrix4 turned = Matrix4::translate({3, -2, 5}) * Matrix4::rotate(50, {1, 2, -1});
    std::vector<ShapePlace> all{{"as it is", {}, false},
                                {"turned", turned, true},
                                {"mirrored", turned * Matrix4::scale({-1.5, 1.5, 1.5}), false},
                                {"stretched", turned * Matrix4::scale({2, 0.5, 1.25}), false},
                                {"stretched and mirrored", turned * Matrix4::scale({0.75, 2, -1.5}), true},
                                {"tiny", Matrix4::scale({1e-6, 1e-6, 1e-6}) * turned, false},
                                {"huge", Matrix4::scale({1e6, 1e6, 1e6}) * turned, false}};
    // Where everything takes ten times as long, the three that ask most of numbers.
    if (testing_support::is_sanitized) all.erase(all.begin(), all.end() - 3);
    return all;
}

inline ShapeCase make_case(const Kind<Shape>& kind, const Example& example, const ShapePlace& place) {
    ShapeCase c;
    c.name = kind.name + " \"" + example.name + "\" " + place.name;
    c.kind = kind.name;
    c.example = example.name;
    c.node.type = kind.name;
    c.node.parameters = example.parameters;
    c.world_from_object = Transform(place.matrix);
    MeshReader reader = [](const std::filesystem::path&) { return house(); };
    Messages messages;
    BuildContext context{.messages = messages};
    context.mesh_reader = &reader;
    context.sdfs = &testing_support::example_sdfs();
    GridReader grid_reader = [](const auto&, const auto&) { return testing_support::example_grid(); };
    context.grid_reader = &grid_reader;
    context.world_from_node = c.world_from_object;
    context.reverse_orientation = place.reverse;
    c.shape = kind.make(c.node, context);
    messages.throw_if_errors();
    for (std::uint32_t i = 0; i < c.shape->primitive_count(); ++i) c.bounds.extend(c.shape->bounds(i));
    c.ball = bounding_sphere(c.bounds);
    return c;
}

inline const std::vector<ShapeCase>& all_cases() {
    static const std::vector<ShapeCase> cases = [] {
        std::vector<ShapeCase> list;
        for (const Kind<Shape>& kind : shape_kinds().all())
            for (const Example& example : kind.doc().examples)
                for (const ShapePlace& place : places()) list.push_back(make_case(kind, example, place));
        return list;
    }();
    return cases;
}

inline Vec3 random_direction(Rng& rng) {
    for (;;) {
        Vec3 v{2 * rng.uniform() - 1, 2 * rng.uniform() - 1, 2 * rng.uniform() - 1};
        float l = length(v);
        if (l > 0.01f && l <= 1) return v / l;
    }
}

/// A line of the measure that is uniform over all lines through the ball: an isotropic direction, and a point
/// uniform over the disk across it.
inline Ray random_line(const Sphere3& ball, Rng& rng) {
    Vec3 d = random_direction(rng);
    Frame frame = Frame::from_z(d);
    float r = std::sqrt(rng.uniform()), phi = 2 * pi * rng.uniform();
    Vec3 across = frame.x * (r * std::cos(phi)) + frame.y * (r * std::sin(phi));
    return {ball.center + (across - d * 1.5f) * ball.radius, d};
}

/// All hits of the ray, primitive by primitive. After each hit the ray goes on from the surface.
inline std::vector<Hit> all_hits(const Shape& shape, const Ray& ray) {
    std::vector<Hit> hits;
    for (std::uint32_t i = 0; i < shape.primitive_count(); ++i) {
        Ray rest = ray;
        Intersection met;
        for (int n = 0; n < 4 && shape.intersect(rest, i, met); ++n) {
            hits.push_back(shape.surface(rest, i, met));
            rest = hits.back().spawn(ray.d);
            met = {};
        }
    }
    return hits;
}

/// The nearest hit.
inline std::optional<Hit> nearest_hit(const Shape& shape, Ray ray) {
    std::optional<Hit> hit;
    for (std::uint32_t i = 0; i < shape.primitive_count(); ++i) {
        Intersection met;
        if (!shape.intersect(ray, i, met)) continue;
        ray.tmax = met.t;
        hit = shape.surface(ray, i, met);
    }
    return hit;
}

} // namespace alhazen::shape_cases
