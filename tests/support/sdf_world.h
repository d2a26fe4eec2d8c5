/// The sdfs that examples refer to by name, as a scene would define them.
#pragma once

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

} // namespace alhazen::testing_support
