/// The sdfs that examples refer to by name, as a scene would define them.
#pragma once

#include "describe/grid_file.h"
#include "sdf/sdf_set.h"

namespace alhazen::testing_support {

inline TextureNode sdf_node(std::string name, std::string type, std::vector<Parameter> parameters,
                            const Matrix4& place = {}) {
    TextureNode node;
    node.node.name = std::move(name);
    node.node.type = std::move(type);
    node.node.parameters = std::move(parameters);
    node.world_from_texture = {place, place};
    return node;
}

inline Parameter names(std::string parameter, std::vector<std::string> values) {
    return make_array(std::move(parameter), ValueType::string, std::move(values));
}

/// Builds the nodes; an error fails the test that asked.
inline SdfSet make_sdfs(const std::vector<TextureNode>& nodes) {
    SdfSet set;
    Messages messages;
    BuildContext context{.messages = messages};
    set.build(nodes, context);
    messages.throw_if_errors();
    return set;
}

/// What the examples of Sdf kinds name, and those of Shape "sdf".
inline const SdfSet& example_sdfs() {
    static const SdfSet set = make_sdfs(
        {sdf_node("sphere", "sphere", {make_float("radius", 0.8f)}),
         sdf_node("small box", "box", {make_point3("size", {1, 0.7f, 0.5f})},
                  Matrix4::translate({0.1, 0.2, 0.1}) * Matrix4::rotate(30, {1, 1, 0})),
         sdf_node("aside", "roundedbox", {make_point3("size", {1, 1, 1})},
                  Matrix4::translate({0.6, 0.1, 0}) * Matrix4::rotate(20, {0, 0, 1})),
         sdf_node("core", "ellipsoid", {make_point3("radii", {1, 0.8f, 0.6f})}),
         sdf_node("bump", "sphere", {make_float("radius", 0.5f)}, Matrix4::translate({0.6, 0.4, 0.3})),
         sdf_node("pebble", "union", {names("children", {"core", "bump"}), make_float("smooth", 0.5f)},
                  Matrix4::rotate(40, {1, 2, 3})),
         sdf_node("ring", "torus", {make_float("radius", 0.8f), make_float("tube", 0.3f)},
                  Matrix4::scale({1, 1.3, 1})),
         sdf_node("pretzel", "twist", {make_string("child", "ring"), make_float("angle", 25)})});
    return set;
}

/// A field sampled at n points along each axis, somewhat beyond its bounds.
inline GridData sampled(const PlacedSdf& field, int n) {
    GridData data;
    data.hi = {n - 1, n - 1, n - 1};
    double size = 1.1 * max_component(field.bounds().size());
    data.object_from_index = Matrix4::translate(field.bounds().centre() - Vec3d(0.5 * size)) *
                             Matrix4::scale(Vec3d(size / (n - 1)));
    for (int z = 0; z < n; z += 8)
        for (int y = 0; y < n; y += 8)
            for (int x = 0; x < n; x += 8) {
                GridBrick& brick = data.bricks.emplace_back();
                brick.origin = {x, y, z};
                for (int i = 0; i < 512; ++i) {
                    Vec3d p{x + static_cast<double>(i & 7), y + static_cast<double>(i >> 3 & 7),
                            z + static_cast<double>(i >> 6)};
                    brick.values[static_cast<std::size_t>(i)] =
                        static_cast<float>(field.value(data.object_from_index.point(p)));
                }
            }
    return data;
}

/// Stands in for the file of sdfgrid's examples.
inline const GridData& example_grid() {
    static const GridData data = sampled(*example_sdfs().find("pebble"), 37);
    return data;
}

/// The trilinear interpolation of a grid without gaps at a point of object space, from its definition.
inline Dual interpolated(const GridData& data, Vec3d object_point) {
    Vec3d p = data.object_from_index.inverse()->point(object_point);
    int n = (data.hi.x + 8) / 8;
    TVec3<Dual> q = dual_point(p);
    Dual sum;
    for (int i = 0; i < 8; ++i) {
        Dual weight = 1.0;
        int at[3];
        for (int k = 0; k < 3; ++k) {
            int cell = std::clamp(static_cast<int>(std::floor(p[k])), 0, data.hi[k] - 1);
            Dual w = q[k] - Dual(cell);
            weight = weight * (i >> k & 1 ? w : Dual(1.0) - w);
            at[k] = cell + (i >> k & 1);
        }
        std::size_t brick = static_cast<std::size_t>(at[0] / 8 + n * (at[1] / 8 + n * (at[2] / 8)));
        sum = sum + weight * Dual(static_cast<double>(
                                 data.bricks[brick].values[GridBrick::at(at[0] & 7, at[1] & 7, at[2] & 7)]));
    }
    // By object coordinates; the grid is a similarity.
    sum.d = sum.d * (1 / data.object_from_index.m[0][0]);
    return sum;
}

} // namespace alhazen::testing_support
