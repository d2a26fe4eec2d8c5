/// Meshes from files: their triangles, and their quadrilaterals as bilinear patches.

#include <fmt/format.h>

#include "describe/mesh_file.h"
#include "shapes/bilinear_mesh.h"
#include "shapes/mesh_displacement.h"
#include "shapes/triangle_mesh.h"

namespace alhazen {

namespace {

struct FileTriangles final : TriangleMesh {
    using TriangleMesh::prepare;
};
struct FilePatches final : BilinearMesh {
    using BilinearMesh::prepare;
};

/// Copies of those values that the indices use, which are then numbered anew.
struct UsedVertices {
    std::vector<int> number; ///< of each vertex in the copies; -1: not used
    std::vector<std::size_t> kept;

    UsedVertices(std::vector<int>& indices, std::size_t vertices) : number(vertices, -1) {
        for (int& i : indices) {
            int& n = number[static_cast<std::size_t>(i)];
            if (n < 0) {
                n = static_cast<int>(kept.size());
                kept.push_back(static_cast<std::size_t>(i));
            }
            i = n;
        }
    }
    template <class V>
    std::vector<V> of(const std::vector<V>& values) const {
        std::vector<V> used;
        if (values.empty()) return used;
        used.reserve(kept.size());
        for (std::size_t i : kept) used.push_back(values[i]);
        return used;
    }
};

/// A mesh of both, triangles first. One that has only one of them is made that: see whole().
struct FileMesh final : Shape {
    std::string filename;
    std::optional<FloatTexture> displacement;
    float longest_edge = 1;
    std::optional<float> longest_edge_too;

    static void describe(Fields<FileMesh>& f) {
        f.about(
            "Triangles and quadrilaterals from a PLY file, perhaps compressed by gzip. Quadrilaterals are "
            "bilinear patches. With a displacement, quadrilaterals become two triangles each, all are cut "
            "until "
            "their edges are short, and every vertex moves along its normal; normals are then those of the "
            "displaced triangles.");
        f.field("filename", &FileMesh::filename, "the file, relative to the scene's folder").required();
        f.field("displacement", &FileMesh::displacement,
                "how far the surface moves along its normals, in object space; the mesh must have texture "
                "coordinates")
            .otherwise("none");
        f.field("displacement.edgelength", &FileMesh::longest_edge,
                "edges are cut in two until all are shorter, where there is a displacement")
            .above(0)
            .unit("world space");
        f.field("edgelength", &FileMesh::longest_edge_too, "another name of displacement.edgelength")
            .above(0)
            .otherwise("displacement.edgelength")
            .unit("world space");
        describe_common(f);
        f.example("statue", {make_string("filename", "meshes/statue.ply")});
    }

    void finish(const Node& node, BuildContext& context);

    /// The shape itself, or the only part of it.
    static std::unique_ptr<Shape> whole(std::unique_ptr<FileMesh> mesh) {
        std::unique_ptr<Shape> only;
        if (!mesh->patches_)
            only = std::move(mesh->triangles_);
        else if (!mesh->triangles_)
            only = std::move(mesh->patches_);
        else
            return mesh;
        only->alpha = mesh->alpha;
        return only;
    }

    std::uint32_t primitive_count() const override { return split_ + patches_->primitive_count(); }
    Bounds3 bounds(std::uint32_t i) const override { return part(i).bounds(within(i)); }
    bool intersect(const Ray& ray, std::uint32_t i, Intersection& hit) const override {
        return part(i).intersect(ray, within(i), hit);
    }
    Hit surface(const Ray& ray, std::uint32_t i, const Intersection& met) const override {
        return numbered(part(i).surface(ray, within(i), met), i);
    }
    Hit plain_surface(const Ray& ray, std::uint32_t i, const Intersection& met) const override {
        return numbered(part(i).plain_surface(ray, within(i), met), i);
    }
    NormalChange normal_change(const Hit& hit) const override {
        return part(hit.primitive).normal_change(numbered(hit, within(hit.primitive)));
    }
    float area(std::uint32_t i) const override { return part(i).area(within(i)); }
    ShapeSample sample(std::uint32_t i, Vec2 u) const override { return part(i).sample(within(i), u); }
    std::optional<ShapeSample> sample_from(std::uint32_t i, Vec3 reference, Vec2 u) const override {
        return part(i).sample_from(within(i), reference, u);
    }
    float pdf_from(std::uint32_t i, Vec3 reference, const Hit& hit, Vec3 wi) const override {
        return part(i).pdf_from(within(i), reference, numbered(hit, within(i)), wi);
    }
    NormalCone normals(std::uint32_t i) const override { return part(i).normals(within(i)); }
    bool tessellate(double tolerance, const TriangleSink& out) const override {
        return triangles_->tessellate(tolerance, out) && patches_->tessellate(tolerance, out);
    }
    std::size_t bytes() const override { return sizeof *this + triangles_->bytes() + patches_->bytes(); }

  private:
    const Shape& part(std::uint32_t i) const {
        return i < split_ ? static_cast<const Shape&>(*triangles_) : *patches_;
    }
    std::uint32_t within(std::uint32_t i) const { return i < split_ ? i : i - split_; }
    static Hit numbered(Hit hit, std::uint32_t primitive) {
        hit.primitive = primitive;
        return hit;
    }
    std::optional<MeshData> read(const Place& place, const std::string& prefix, BuildContext& context) const;
    void make_parts(MeshData& data, const Place& place, const std::string& prefix, BuildContext& context);

    std::unique_ptr<FileTriangles> triangles_;
    std::unique_ptr<FilePatches> patches_;
    std::uint32_t split_ = 0; ///< number of triangles
};

std::optional<MeshData> FileMesh::read(const Place& place, const std::string& prefix,
                                       BuildContext& context) const {
    if (!context.mesh_reader || !*context.mesh_reader) {
        context.messages.add_error(place, prefix + "mesh files cannot be read here");
        return std::nullopt;
    }
    MeshData data;
    try {
        data = (*context.mesh_reader)(context.resolve(filename));
    } catch (const std::runtime_error& e) {
        context.messages.add_error(place, prefix + e.what());
        return std::nullopt;
    }
    if (data.odd_faces > 0) {
        std::string more = data.odd_faces > 1 ? fmt::format(" ({} faces like this)", data.odd_faces) : "";
        context.messages.add_unsupported(place, prefix + data.first_odd_face + more,
                                         Remedy{"leave such faces out", "leaving such faces out"});
        if (!context.messages.lenient) return std::nullopt;
    }
    return data;
}

void FileMesh::finish(const Node& node, BuildContext& context) {
    const Place& place = node.place_of("filename");
    const std::string prefix = fmt::format("mesh file \"{}\": ", filename);
    if (longest_edge_too && node.find("displacement.edgelength"))
        return context.messages.add_error(
            node.find("edgelength")->place,
            "\"edgelength\" and \"displacement.edgelength\" are one parameter; give "
            "one of them");
    std::optional<MeshData> data = read(place, prefix, context);
    if (!data) return;
    if (displacement) {
        const std::size_t errors = context.messages.error_count();
        MeshChecks{context.messages, place, prefix}.finite("P", data->P);
        if (context.messages.error_count() != errors) return;
        const std::string problem =
            Displacement{*displacement,
                         longest_edge_too.value_or(longest_edge) * context.displacement_edge_scale,
                         context.world_from_node}
                .apply(*data);
        if (!problem.empty()) return context.messages.add_error(place, prefix + problem);
    }
    make_parts(*data, place, prefix, context);
}

void FileMesh::make_parts(MeshData& data, const Place& place, const std::string& prefix,
                          BuildContext& context) {
    const bool has_patches = !data.quad_indices.empty(),
               has_triangles = !data.indices.empty() || !has_patches;
    auto fill = [&](auto& part, std::vector<int>& indices) {
        part = std::make_unique<std::decay_t<decltype(*part)>>();
        part->indices = std::move(indices);
        if (has_patches && has_triangles) {
            const UsedVertices used(part->indices, data.P.size());
            part->P = used.of(data.P);
            part->N = used.of(data.N);
            part->uv = used.of(data.uv);
        } else {
            part->P = std::move(data.P);
            part->N = std::move(data.N);
            part->uv = std::move(data.uv);
        }
        part->prepare(place, prefix, context);
    };
    const std::size_t errors = context.messages.error_count();
    if (has_triangles) fill(triangles_, data.indices);
    if (context.messages.error_count() != errors) return;
    if (has_patches) fill(patches_, data.quad_indices);
    if (triangles_) split_ = triangles_->primitive_count();
}

} // namespace

Kind<Shape> plymesh_shape() {
    Kind<Shape> kind = make_kind<Shape, FileMesh>("plymesh");
    kind.make = [make = kind.make](const Node& node, BuildContext& context) -> std::unique_ptr<Shape> {
        std::unique_ptr<Shape> made = make(node, context);
        if (!made) return nullptr;
        return FileMesh::whole(std::unique_ptr<FileMesh>(static_cast<FileMesh*>(made.release())));
    };
    return kind;
}

} // namespace alhazen
