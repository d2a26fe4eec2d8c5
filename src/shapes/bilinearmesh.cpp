/// Bilinear patches given in the scene file itself.

#include <fmt/format.h>

#include "shapes/bilinear_mesh.h"

namespace alhazen {

namespace {

struct InlinePatches final : BilinearMesh {
    std::vector<int> face_indices;
    std::string emission_file;

    static void describe(Fields<InlinePatches>& f);
    void finish(const Node& node, BuildContext& context) {
        prepare(node.place, "", context);
        if (!face_indices.empty() && face_indices.size() != primitive_count())
            context.messages.add_error(
                node.place,
                fmt::format("\"faceIndices\" has {} values for {} patches; it must have one for each",
                            face_indices.size(), primitive_count()));
        face_indices = {};
    }
};

void InlinePatches::describe(Fields<InlinePatches>& f) {
    f.about("Bilinear patches: four-cornered surfaces, flat or twisted, over shared vertices.");
    f.field("P", &InlinePatches::P, "vertex positions").required();
    f.field("indices", &InlinePatches::indices,
            "four vertex numbers for each patch: corners (0,0), (1,0), (0,1), (1,1), counted from 0")
        .otherwise("0 1 2 3 for four vertices");
    f.field("N", &InlinePatches::N, "shading normal of each vertex; its side is the outside");
    f.field("uv", &InlinePatches::uv, "texture coordinates of each vertex")
        .otherwise("the unit square for each patch");
    f.field("faceIndices", &InlinePatches::face_indices, "number of the face each patch came from; not used");
    f.field("emissionfilename", &InlinePatches::emission_file,
            "picture by which pbrt-v4 draws points of a patch that glows; not used: they are drawn by the "
            "picture of "
            "the area light itself");
    describe_common(f);
    std::vector<Vec3> flat{{-1, -1, 0}, {1, -1, 0}, {-1, 1, 0}, {1, 1, 0}};
    std::vector<Vec3> twisted{{-1, -1, 0.5f}, {1, -1, -0.5f}, {-1, 1, -0.5f}, {1.5f, 1, 0.75f}};
    std::vector<Vec2> turned{{1, 0}, {1, 2}, {0, 0}, {0, 2}};
    f.example("square", {make_array("P", ValueType::point3, flat)});
    f.example("saddle",
              {make_array("P", ValueType::point3, twisted), make_array("uv", ValueType::point2, turned)});
    f.example(
        "roof",
        {make_array("P", ValueType::point3,
                    std::vector<Vec3>{{-1, -1, 0}, {-1, 1, 0}, {0, -1, 1}, {0, 1, 1}, {1, -1, 0}, {1, 1, 0}}),
         make_array("indices", ValueType::integer, std::vector<int>{0, 2, 1, 3, 2, 4, 3, 5}),
         make_array("N", ValueType::normal,
                    std::vector<Vec3>{{-1, 0, 1}, {-1, 0, 1}, {0, 0, 1}, {0, 0, 1}, {1, 0, 1}, {1, 0, 1}})});
}

} // namespace

Kind<Shape> bilinearmesh_shape() {
    return make_kind<Shape, InlinePatches>("bilinearmesh");
}

} // namespace alhazen
