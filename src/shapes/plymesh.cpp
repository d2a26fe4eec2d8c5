/// Triangles from a mesh file. Quadrilaterals in it are split.

#include <fmt/format.h>

#include "describe/mesh_file.h"
#include "shapes/triangle_mesh.h"

namespace alhazen {

namespace {

struct FileTriangles final : TriangleMesh {
    std::string filename;

    static void describe(Fields<FileTriangles>& f) {
        f.about("Triangles and quadrilaterals from a PLY file, perhaps compressed by gzip.");
        f.field("filename", &FileTriangles::filename, "the file, relative to the scene's folder").required();
        describe_common(f);
        f.example("statue", {make_string("filename", "meshes/statue.ply")});
    }

    void finish(const Node& node, BuildContext& context) {
        const Parameter* parameter = node.find("filename");
        const Place& place = parameter ? parameter->place : node.place;
        std::string prefix = fmt::format("mesh file \"{}\": ", filename);
        if (!context.mesh_reader || !*context.mesh_reader) {
            context.messages.add_error(place, prefix + "mesh files cannot be read here");
            return;
        }
        MeshData data;
        try {
            data = (*context.mesh_reader)(context.resolve(filename));
        } catch (const std::runtime_error& e) {
            context.messages.add_error(place, prefix + e.what());
            return;
        }
        if (data.odd_faces > 0) {
            std::string more = data.odd_faces > 1 ? fmt::format(" ({} faces like this)", data.odd_faces) : "";
            context.messages.add_unsupported(place, prefix + data.first_odd_face + more,
                                             Remedy{"leave such faces out", "leaving such faces out"});
            if (!context.messages.lenient) return;
        }
        split_quads(data);
        P = std::move(data.P);
        N = std::move(data.N);
        uv = std::move(data.uv);
        indices = std::move(data.indices);
        prepare(place, prefix, context);
    }
};

} // namespace

Kind<Shape> plymesh_shape() {
    return make_kind<Shape, FileTriangles>("plymesh");
}

} // namespace alhazen
