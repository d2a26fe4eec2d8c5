/// Shapes of every way of sampling, to make light of.
#pragma once

#include "tests/support/light_probe.h"

namespace alhazen {

struct GlowingShape {
    std::unique_ptr<Shape> shape;
    /// Its largest; nullopt where directions are sampled (spheres, triangles) instead of points by area.
    std::optional<double> curvature;
};

inline std::vector<GlowingShape> shapes_to_light() {
    std::vector<Vec3> corners{{-1, -1, 0}, {1, -1, 0.3f}, {1, 1, 0}, {-1, 1, 0.4f}};
    auto points = [&](std::vector<int> order) {
        std::vector<Vec3> p;
        for (int i : order) p.push_back(corners[static_cast<std::size_t>(i)]);
        return make_array<Vec3>("P", ValueType::point3, p);
    };
    std::vector<Node> nodes{
        make_node("sphere", {make_float("radius", 0.7f)}),
        make_node("disk", {make_float("radius", 1.2f), make_float("innerradius", 0.3f)}),
        make_node("cylinder", {make_float("radius", 0.5f)}),
        make_node("trianglemesh",
                  {points({0, 1, 2, 3}), make_array<int>("indices", ValueType::integer, {0, 1, 2, 0, 2, 3})}),
        make_node("bilinearmesh", {points({0, 1, 3, 2})})};
    // The patch's twist is 0.7 over a square of side 2: z = 0.175 x y and a plane.
    std::optional<double> curvatures[] = {{}, 0, 1 / 0.5, {}, 0.175};
    std::vector<GlowingShape> shapes;
    LightSetting place{ColorMode::rgb, Matrix4::translate({0.5f, 0, 1}) * Matrix4::rotate(130, {1, 1, 0})};
    for (std::size_t i = 0; i < nodes.size(); ++i)
        shapes.push_back({build_or_fail(shape_kinds(), nodes[i], place), curvatures[i]});
    return shapes;
}

} // namespace alhazen
