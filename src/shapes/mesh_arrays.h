/// What every mesh kind does with its arrays: check them against each other, and take them to world space.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/messages.h"
#include "base/transform.h"

namespace alhazen {

/// Each check adds an error at the place, beginning with prefix, for the first thing that is wrong.
struct MeshChecks {
    Messages& messages;
    Place place;
    std::string prefix; ///< "" or "mesh file \"x.ply\": "

    struct Count {
        std::string_view name;
        std::size_t count;
    };
    /// Arrays that hold one value a vertex, or none.
    void counts(std::size_t vertices, std::initializer_list<Count> arrays) const;
    /// corners a face, each within the vertices, and at least one face.
    void indices(const std::vector<int>& indices, int corners, std::string_view face,
                 std::size_t vertices) const;
    void finite(std::string_view name, const std::vector<Vec3>& values) const;
    void finite(std::string_view name, const std::vector<Vec2>& values) const;
    /// After positions_to_world: the transformation must not have made numbers overflow.
    void finite_in_world(const std::vector<Vec3>& positions) const;
    void error(const std::string& text) const;
};

template <class T>
std::size_t array_bytes(const std::vector<T>& array) {
    return array.capacity() * sizeof(T);
}

/// In double precision: what is lost is half a unit in the last place, even where large translations cancel.
void positions_to_world(std::vector<Vec3>& positions, const Transform& world_from_object);
/// By the inverse transpose, keeping lengths as they come; turned over when reversed.
void normals_to_world(std::vector<Vec3>& normals, const Transform& world_from_object, bool reversed);

} // namespace alhazen
