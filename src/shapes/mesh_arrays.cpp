#include "shapes/mesh_arrays.h"

#include <fmt/format.h>

#include <algorithm>

namespace alhazen {

namespace {

template <class V>
std::size_t first_not_finite(const std::vector<V>& values) {
    auto is_bad = [](V v) {
        if constexpr (std::is_same_v<V, Vec3>)
            return !is_finite(v);
        else
            return !std::isfinite(v.x) || !std::isfinite(v.y);
    };
    return static_cast<std::size_t>(std::find_if(values.begin(), values.end(), is_bad) - values.begin());
}

} // namespace

void MeshChecks::error(const std::string& text) const {
    messages.add_error(place, prefix + text);
}

void MeshChecks::counts(std::size_t vertices, std::initializer_list<Count> arrays) const {
    if (vertices == 0) error("there are no vertices; the parameter \"point3 P\" gives them");
    for (const Count& array : arrays)
        if (array.count != 0 && array.count != vertices)
            error(
                fmt::format("\"{}\" has {} values for {} vertices; it must have one for each vertex in \"P\"",
                            array.name, array.count, vertices));
}

void MeshChecks::indices(const std::vector<int>& indices, int corners, std::string_view face,
                         std::size_t vertices) const {
    if (indices.empty()) {
        error(fmt::format(
            "there are no {}; the parameter \"integer indices\" gives them, and may be left out only "
            "with exactly {} vertices (there are {})",
            face == "patch" ? "patches" : "triangles", corners, vertices));
        return;
    }
    if (indices.size() % static_cast<std::size_t>(corners) != 0)
        error(fmt::format("\"indices\" has {} values; it must have {} for each {}", indices.size(), corners,
                          face));
    for (std::size_t i = 0; i < indices.size(); ++i)
        if (indices[i] < 0 || static_cast<std::size_t>(indices[i]) >= vertices) {
            error(fmt::format(
                "the {} value of \"indices\" is {}; it must be from 0 to {}, as there are {} vertices",
                ordinal(i + 1), indices[i], static_cast<long>(vertices) - 1, vertices));
            return;
        }
}

void MeshChecks::finite(std::string_view name, const std::vector<Vec3>& values) const {
    std::size_t i = first_not_finite(values);
    if (i < values.size())
        error(fmt::format("the {} value of \"{}\" is ({}, {}, {}); it must be finite", ordinal(i + 1), name,
                          values[i].x, values[i].y, values[i].z));
}

void MeshChecks::finite(std::string_view name, const std::vector<Vec2>& values) const {
    std::size_t i = first_not_finite(values);
    if (i < values.size())
        error(fmt::format("the {} value of \"{}\" is ({}, {}); it must be finite", ordinal(i + 1), name,
                          values[i].x, values[i].y));
}

void MeshChecks::finite_in_world(const std::vector<Vec3>& positions) const {
    std::size_t i = first_not_finite(positions);
    if (i < positions.size())
        error(fmt::format("the {} vertex is not finite in world space; the transformation makes it too large",
                          ordinal(i + 1)));
}

void positions_to_world(std::vector<Vec3>& positions, const Transform& world_from_object) {
    if (world_from_object.is_identity()) return;
    for (Vec3& p : positions) p = Vec3(world_from_object.point(Vec3d(p)));
}

void normals_to_world(std::vector<Vec3>& normals, const Transform& world_from_object, bool reversed) {
    bool is_identity = world_from_object.is_identity();
    for (Vec3& n : normals) {
        if (!is_identity) n = world_from_object.normal(n);
        if (reversed) n = -n;
    }
}

} // namespace alhazen
