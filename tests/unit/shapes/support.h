/// Shapes made in code.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/hash.h"
#include "describe/mesh_file.h"
#include "shapes/shape.h"

namespace alhazen::shape_test {

struct Making {
    Matrix4 world_from_object = {};
    bool reverse = false;
    MeshReader reader = nullptr;
    float edge_scale = 1;
};

inline std::unique_ptr<Shape> try_make(const std::string& kind, std::vector<Parameter> parameters,
                                       Messages& messages, const Making& making = {}) {
    Node node;
    node.type = kind;
    node.parameters = std::move(parameters);
    node.place = Place::of_file("test.pbrt");
    BuildContext context{.messages = messages};
    context.displacement_edge_scale = making.edge_scale;
    context.world_from_node = Transform(making.world_from_object);
    context.reverse_orientation = making.reverse;
    context.mesh_reader = &making.reader;
    return shape_kinds().make(node, context, "");
}

inline std::unique_ptr<Shape> make(const std::string& kind, std::vector<Parameter> parameters,
                                   const Making& making = {}) {
    Messages messages;
    auto shape = try_make(kind, std::move(parameters), messages, making);
    messages.throw_if_errors();
    return shape;
}

/// All messages of a shape that cannot be made, one a line.
inline std::string errors_of(const std::string& kind, std::vector<Parameter> parameters,
                             const Making& making = {}) {
    Messages messages;
    auto shape = try_make(kind, std::move(parameters), messages, making);
    EXPECT_EQ(shape, nullptr);
    std::string text;
    for (const Message& m : messages.list()) text += m.full_text() + "\n";
    return text;
}

inline Parameter points(std::vector<Vec3> values) {
    return make_array("P", ValueType::point3, std::move(values));
}
inline Parameter indices(std::vector<int> values) {
    return make_array("indices", ValueType::integer, std::move(values));
}

/// The surface where the ray meets primitive 0; fails the test when it does not.
inline Hit hit(const Shape& shape, const Ray& ray) {
    Intersection met;
    EXPECT_TRUE(shape.intersect(ray, 0, met));
    return shape.surface(ray, 0, met);
}

} // namespace alhazen::shape_test
