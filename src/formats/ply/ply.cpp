#include "formats/ply.h"

#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "base/file.h"
#include "formats/ply/body.h"

namespace alhazen {

PlyVertexPlan plan_ply_vertices(const PlyElement& vertices) {
    PlyVertexPlan plan;
    plan.slot.assign(vertices.properties.size(), -1);
    // Sets the slots of the names, unless one of them is not there.
    auto use = [&](std::initializer_list<std::string_view> names, int first_slot) {
        for (std::string_view name : names) {
            int at = vertices.find(name);
            if (at < 0 || vertices.properties[static_cast<std::size_t>(at)].is_list) return false;
        }
        for (std::string_view name : names)
            plan.slot[static_cast<std::size_t>(vertices.find(name))] = first_slot++;
        return true;
    };
    if (!use({"x", "y", "z"}, 0)) throw std::runtime_error("the vertices have no x, y and z");
    plan.has_normals = use({"nx", "ny", "nz"}, 3);
    plan.has_uv = use({"u", "v"}, 6) || use({"s", "t"}, 6) || use({"texture_u", "texture_v"}, 6) ||
                  use({"texture_s", "texture_t"}, 6);
    return plan;
}

PlyFacePlan plan_ply_faces(const PlyElement& faces) {
    PlyFacePlan plan;
    plan.indices = faces.find("vertex_indices");
    if (plan.indices < 0) plan.indices = faces.find("vertex_index");
    auto property = [&](int i) -> const PlyProperty& {
        return faces.properties[static_cast<std::size_t>(i)];
    };
    if (plan.indices < 0 || !property(plan.indices).is_list)
        throw std::runtime_error("the faces have no list vertex_indices");
    if (!is_whole(property(plan.indices).type))
        throw std::runtime_error("the faces' vertex_indices are not of a whole-number type");
    plan.face_index = faces.find("face_indices");
    if (plan.face_index >= 0 &&
        (property(plan.face_index).is_list || !is_whole(property(plan.face_index).type)))
        plan.face_index = -1;
    return plan;
}

namespace {

void check_index_range(const std::vector<int>& indices, std::size_t vertices, std::string_view what,
                       std::size_t corners) {
    // Negative ones are large as unsigned: one comparison, and the loop is made of SIMD instructions.
    unsigned largest = 0;
    for (int i : indices) largest = std::max(largest, static_cast<unsigned>(i));
    if (indices.empty() || largest < vertices) return;
    for (std::size_t i = 0; i < indices.size(); ++i)
        if (static_cast<unsigned>(indices[i]) >= vertices)
            throw std::runtime_error(
                fmt::format("{} {}: vertex index {} is out of range; there are {} vertices", what,
                            i / corners, indices[i], vertices));
}

template <class V>
void check_finite(const std::vector<V>& values, std::string_view what) {
    for (std::size_t i = 0; i < values.size(); ++i) {
        // Zero times infinity or not-a-number is not a number.
        float zero = dot(values[i], V{}) * 0.0f;
        if (zero != 0.0f) throw std::runtime_error(fmt::format("vertex {}: the {} is not finite", i, what));
    }
}

void check_mesh(const MeshData& mesh) {
    check_finite(mesh.P, "position");
    check_finite(mesh.N, "normal");
    check_finite(mesh.uv, "texture coordinate");
    check_index_range(mesh.indices, mesh.P.size(), "triangle", 3);
    check_index_range(mesh.quad_indices, mesh.P.size(), "quadrilateral", 4);
}

MeshData read_body(std::string_view bytes, const PlyHeader& header) {
    if (header.encoding == PlyHeader::Encoding::ascii)
        return PlyBody<PlyAsciiCursor>(PlyAsciiCursor(bytes, header), header).read();
    bool is_little = header.encoding == PlyHeader::Encoding::little_endian;
    if (is_little == (std::endian::native == std::endian::little))
        return PlyBody<PlyBinaryCursor<false>>(PlyBinaryCursor<false>(bytes, header), header).read();
    return PlyBody<PlyBinaryCursor<true>>(PlyBinaryCursor<true>(bytes, header), header).read();
}

} // namespace

MeshData parse_ply(std::string_view bytes) {
    PlyHeader header = parse_ply_header(bytes);
    const PlyElement* vertices = header.find("vertex");
    const PlyElement* faces = header.find("face");
    if (!vertices || vertices->count == 0) throw std::runtime_error("the file has no vertices");
    if (!faces || faces->count == 0) throw std::runtime_error("the file has no faces");
    // Asked for up front: an element without properties is not read at all.
    plan_ply_vertices(*vertices);
    plan_ply_faces(*faces);
    MeshData mesh = read_body(bytes, header);
    check_mesh(mesh);
    return mesh;
}

MeshData read_ply(const std::filesystem::path& file) {
    return parse_ply(read_file(file));
}

} // namespace alhazen
