/// The body of a PLY file, element after element, into a mesh. One algorithm over both kinds of cursor, with
/// short cuts for the layouts nearly every file has.
#pragma once

#include <limits>

#include <array>

#include "describe/mesh_file.h"
#include "formats/ply/cursor.h"

namespace alhazen {

/// For each property of the vertices the slot it fills: x y z, nx ny nz, u v; -1 for those not used.
struct PlyVertexPlan {
    static constexpr int slots = 8;
    std::vector<int> slot;
    bool has_normals = false, has_uv = false;
};
/// Throws std::runtime_error when x, y or z are not there.
PlyVertexPlan plan_ply_vertices(const PlyElement& vertices);

/// Which properties of the faces are used; -1 for none.
struct PlyFacePlan {
    int indices = -1, face_index = -1;
};
PlyFacePlan plan_ply_faces(const PlyElement& faces);

template <class Cursor>
class PlyBody {
  public:
    PlyBody(Cursor cursor, const PlyHeader& header) : cursor_(std::move(cursor)), header_(header) {}

    MeshData read() {
        for (const PlyElement& element : header_.elements) {
            cursor_.progress = {element.name, 0};
            if (element.properties.empty()) continue;
            if (element.name == "vertex")
                read_vertices(element);
            else if (element.name == "face")
                read_faces(element);
            else
                skip_elements(element);
        }
        // Triangles first, then quadrilaterals, as the arrays have them.
        mesh_.face_indices.insert(mesh_.face_indices.end(), quad_faces_.begin(), quad_faces_.end());
        return std::move(mesh_);
    }

  private:
    /// Before anything is allocated: a count may be a lie.
    void check_room(const PlyElement& element, std::size_t least) const {
        // In text the last value needs no blank behind it.
        std::uint64_t room = (cursor_.left() + (Cursor::is_binary ? 0 : 1)) / std::max(least, std::size_t{1});
        if (element.count > room)
            cursor_.fail("element \"" + element.name + "\" is declared " + std::to_string(element.count) +
                         " times; the file has room for " + std::to_string(room) + " at most");
    }
    std::size_t least_size(const PlyElement& element) const {
        std::size_t least = 0;
        for (const PlyProperty& p : element.properties)
            least += Cursor::least_size(p.is_list ? p.count_type : p.type);
        return least;
    }
    std::uint64_t list_length(const PlyProperty& p) {
        std::int64_t n = cursor_.whole(p.count_type);
        if (n < 0)
            cursor_.fail(std::string(cursor_.progress.element) + " " +
                         std::to_string(cursor_.progress.number) + " has a list of length " +
                         std::to_string(n));
        return static_cast<std::uint64_t>(n);
    }
    void skip_property(const PlyProperty& p) {
        // A length is believed one value at a time: the file's end comes first.
        std::uint64_t n = p.is_list ? list_length(p) : 1;
        for (; n > 0; --n) cursor_.skip(p.type);
    }
    void skip_elements(const PlyElement& element) {
        check_room(element, least_size(element));
        for (std::uint64_t& i = cursor_.progress.number; i < element.count; ++i)
            for (const PlyProperty& p : element.properties) skip_property(p);
    }

    void read_vertices(const PlyElement& element) {
        PlyVertexPlan plan = plan_ply_vertices(element);
        check_room(element, least_size(element));
        if (element.count > static_cast<std::uint64_t>(std::numeric_limits<int>::max()))
            cursor_.fail("more than 2147483647 vertices");
        auto count = static_cast<std::size_t>(element.count);
        mesh_.P.resize(count);
        if (plan.has_normals) mesh_.N.resize(count);
        if (plan.has_uv) mesh_.uv.resize(count);
        if (copy_vertices(element, plan)) return;
        std::array<float, PlyVertexPlan::slots> row{};
        for (std::uint64_t& i = cursor_.progress.number; i < element.count; ++i) {
            for (std::size_t k = 0; k < element.properties.size(); ++k) {
                const PlyProperty& p = element.properties[k];
                if (plan.slot[k] < 0)
                    skip_property(p);
                else
                    row[static_cast<std::size_t>(plan.slot[k])] = cursor_.real(p.type);
            }
            mesh_.P[i] = {row[0], row[1], row[2]};
            if (plan.has_normals) mesh_.N[i] = {row[3], row[4], row[5]};
            if (plan.has_uv) mesh_.uv[i] = {row[6], row[7]};
        }
    }

    /// The short cut for floats in this machine's byte order; false when it does not fit.
    bool copy_vertices(const PlyElement& element, const PlyVertexPlan& plan) {
        if constexpr (!Cursor::is_binary) {
            return false;
        } else {
            if (Cursor::is_swapped) return false;
            std::array<std::size_t, PlyVertexPlan::slots> offset{};
            std::size_t stride = 0;
            for (std::size_t k = 0; k < element.properties.size(); ++k) {
                const PlyProperty& p = element.properties[k];
                if (p.is_list || (plan.slot[k] >= 0 && p.type != PlyType::f32)) return false;
                if (plan.slot[k] >= 0) offset[static_cast<std::size_t>(plan.slot[k])] = stride;
                stride += ply_size(p.type);
            }
            copy_rows(stride, offset, plan);
            cursor_.skip(stride * mesh_.P.size());
            return true;
        }
    }
    void copy_rows(std::size_t stride, const std::array<std::size_t, PlyVertexPlan::slots>& offset,
                   const PlyVertexPlan& plan) {
        auto at = [](const char* row, std::size_t where) {
            float value;
            std::memcpy(&value, row + where, sizeof value);
            return value;
        };
        const char* row = cursor_.here();
        for (std::size_t i = 0; i < mesh_.P.size(); ++i, row += stride) {
            mesh_.P[i] = {at(row, offset[0]), at(row, offset[1]), at(row, offset[2])};
            if (plan.has_normals) mesh_.N[i] = {at(row, offset[3]), at(row, offset[4]), at(row, offset[5])};
            if (plan.has_uv) mesh_.uv[i] = {at(row, offset[6]), at(row, offset[7])};
        }
    }

    void read_faces(const PlyElement& element) {
        PlyFacePlan plan = plan_ply_faces(element);
        const PlyProperty& list = element.properties[static_cast<std::size_t>(plan.indices)];
        std::size_t least = least_size(element) + 3 * Cursor::least_size(list.type);
        check_room(element, least);
        mesh_.indices.reserve(static_cast<std::size_t>(element.count) * 3);
        std::uint64_t& i = cursor_.progress.number;
        if (Cursor::is_binary && element.properties.size() == 1) copy_triangles(element, list);
        for (; i < element.count; ++i) {
            std::size_t corners = 3;
            int face = 0;
            for (std::size_t k = 0; k < element.properties.size(); ++k) {
                const PlyProperty& p = element.properties[k];
                if (static_cast<int>(k) == plan.indices)
                    corners = read_face(p);
                else if (static_cast<int>(k) == plan.face_index)
                    face = whole_int(p.type);
                else
                    skip_property(p);
            }
            if (plan.face_index >= 0 && corners != 0)
                (corners == 3 ? mesh_.face_indices : quad_faces_).push_back(face);
        }
    }

    /// The short cut for the faces up to the first that is not a triangle with a one-byte length and
    /// four-byte indices in this machine's byte order.
    void copy_triangles(const PlyElement& element, const PlyProperty& list) {
        if constexpr (Cursor::is_binary) {
            bool fits = !Cursor::is_swapped && ply_size(list.count_type) == 1 && ply_size(list.type) == 4 &&
                        is_whole(list.type);
            if (!fits) return;
            constexpr std::size_t size = 1 + 3 * sizeof(int);
            std::size_t most = std::min(static_cast<std::size_t>(element.count), cursor_.left() / size);
            const char* face = cursor_.here();
            mesh_.indices.resize(most * 3);
            std::size_t n = 0;
            for (; n < most && *face == 3; ++n, face += size)
                std::memcpy(mesh_.indices.data() + 3 * n, face + 1, 3 * sizeof(int));
            mesh_.indices.resize(n * 3);
            cursor_.skip(n * size);
            cursor_.progress.number = n;
        }
    }

    int whole_int(PlyType type) {
        std::int64_t value = cursor_.whole(type);
        if (value < std::numeric_limits<int>::min() || value > std::numeric_limits<int>::max())
            cursor_.fail("face " + std::to_string(cursor_.progress.number) + ": " + std::to_string(value) +
                         " is out of range");
        return static_cast<int>(value);
    }

    std::size_t read_face(const PlyProperty& p) {
        std::uint64_t n = list_length(p);
        if (n != 3 && n != 4) {
            if (mesh_.odd_faces++ == 0)
                mesh_.first_odd_face =
                    cursor_.located("face " + std::to_string(cursor_.progress.number) + " has " +
                                    std::to_string(n) + " vertices; expected 3 or 4");
            for (std::uint64_t i = 0; i < n; ++i) cursor_.skip(p.type);
            return 0;
        }
        std::array<int, 4> v{};
        for (std::size_t i = 0; i < n; ++i) v[i] = whole_int(p.type);
        if (n == 3)
            mesh_.indices.insert(mesh_.indices.end(), {v[0], v[1], v[2]});
        else // round the edge in the file, by rows in a patch
            mesh_.quad_indices.insert(mesh_.quad_indices.end(), {v[0], v[1], v[3], v[2]});
        return static_cast<std::size_t>(n);
    }

    Cursor cursor_;
    const PlyHeader& header_;
    MeshData mesh_;
    std::vector<int> quad_faces_;
};

} // namespace alhazen
