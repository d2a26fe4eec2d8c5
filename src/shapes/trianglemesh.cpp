/// Triangles given in the scene file itself.

#include <fmt/format.h>

#include "shapes/mesh_arrays.h"
#include "shapes/triangle_mesh.h"

namespace alhazen {

namespace {

struct InlineTriangles final : TriangleMesh {
    std::vector<int> face_indices;

    static void describe(Fields<InlineTriangles>& f);
    void finish(const Node& node, BuildContext& context) {
        prepare(node.place, "", context);
        if (!face_indices.empty() && face_indices.size() != primitive_count())
            context.messages.add_error(
                node.place,
                fmt::format("\"faceIndices\" has {} values for {} triangles; it must have one for each",
                            face_indices.size(), primitive_count()));
        face_indices = {};
    }
};

void InlineTriangles::describe(Fields<InlineTriangles>& f) {
    f.about(
        "Triangles over shared vertices. Normals and tangents at the vertices are interpolated for shading.");
    f.field("P", &InlineTriangles::P, "vertex positions").required();
    f.field("indices", &InlineTriangles::indices, "three vertex numbers for each triangle, counted from 0")
        .otherwise("0 1 2 for three vertices");
    f.field("N", &InlineTriangles::N, "shading normal of each vertex; its side is the outside");
    f.field("S", &InlineTriangles::S, "shading tangent of each vertex");
    f.field("uv", &InlineTriangles::uv, "texture coordinates of each vertex")
        .otherwise("(0,0) (1,0) (1,1) for each triangle");
    f.field("faceIndices", &InlineTriangles::face_indices,
            "number of the face each triangle came from; not used");
    describe_common(f);
    std::vector<Vec3> square{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    f.example("triangle",
              {make_array("P", ValueType::point3, std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0.5f}})});
    f.example("square",
              {make_array("P", ValueType::point3, square),
               make_array("indices", ValueType::integer, std::vector<int>{0, 1, 2, 0, 2, 3}),
               make_array("uv", ValueType::point2, std::vector<Vec2>{{0, 0}, {1, 0}, {1, 1}, {0, 1}})});
    f.example(
        "tetrahedron",
        {make_array("P", ValueType::point3,
                    std::vector<Vec3>{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}),
         make_array("indices", ValueType::integer, std::vector<int>{0, 1, 2, 0, 3, 1, 0, 2, 3, 1, 3, 2}),
         make_array("N", ValueType::normal,
                    std::vector<Vec3>{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}})});
}

} // namespace

Kind<Shape> trianglemesh_shape() {
    return make_kind<Shape, InlineTriangles>("trianglemesh");
}

} // namespace alhazen
