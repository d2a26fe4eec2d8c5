#include "shapes/mesh_displacement.h"

#include <array>
#include <unordered_map>

#include <fmt/format.h>

#include "base/threads.h"

namespace alhazen {

namespace {

Vec3 unit_or_zero(Vec3d v) {
    const double size = length(v);
    return size > 0 && std::isfinite(size) ? Vec3(v * (1 / size)) : Vec3{};
}

// Bisection of the longest edge (Rivara 1984): an edge is cut only when it is too long, always in the middle
// and in all its triangles, so that none gets a vertex on an edge of another.
class EdgeSplitter {
  public:
    EdgeSplitter(MeshData& mesh, const Displacement& displacement)
        : mesh_(mesh), displacement_(displacement) {}

    /// "", or what is wrong.
    std::string split() {
        if (!(least_triangles() <= static_cast<double>(displacement_.most_triangles))) return too_many();
        std::vector<int> coarse = std::move(mesh_.indices);
        mesh_.indices.clear();
        std::vector<Corners> waiting;
        for (std::size_t i = 0; i < coarse.size(); i += 3) {
            waiting.push_back({coarse[i], coarse[i + 1], coarse[i + 2]});
            while (!waiting.empty()) {
                const Corners corners = waiting.back();
                waiting.pop_back();
                if (!split(corners, waiting))
                    return fmt::format(
                        "edges cannot be cut to be shorter than {}, since single precision has no "
                        "numbers between their ends; take a longer \"displacement.edgelength\"",
                        displacement_.edge_length);
                if (mesh_.indices.size() / 3 + waiting.size() > displacement_.most_triangles)
                    return too_many();
            }
        }
        return "";
    }

  private:
    using Corners = std::array<int, 3>;

    Vec3d world(int vertex) const {
        return displacement_.world_from_object.point(Vec3d(mesh_.P[static_cast<std::size_t>(vertex)]));
    }

    // No triangle with sides of at most e is larger than the one with three such sides.
    double least_triangles() const {
        const double side = static_cast<double>(displacement_.edge_length);
        const double largest = std::sqrt(3.0) / 4 * side * side;
        double area = 0;
        for (std::size_t i = 0; i < mesh_.indices.size(); i += 3) {
            const Vec3d a = world(mesh_.indices[i]);
            area += length(cross(world(mesh_.indices[i + 1]) - a, world(mesh_.indices[i + 2]) - a)) / 2;
        }
        return area / largest;
    }

    std::string too_many() const {
        return fmt::format("edges shorter than {} would take more than {} triangles; take a longer "
                           "\"displacement.edgelength\"",
                           displacement_.edge_length, displacement_.most_triangles);
    }

    // False when an edge cannot be cut.
    bool split(const Corners& corners, std::vector<Corners>& waiting) {
        const std::array<Vec3d, 3> p{world(corners[0]), world(corners[1]), world(corners[2])};
        std::size_t longest = 0;
        double most = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const double side = length(p[(i + 1) % 3] - p[i]);
            if (side > most) {
                most = side;
                longest = i;
            }
        }
        if (most < static_cast<double>(displacement_.edge_length)) {
            mesh_.indices.insert(mesh_.indices.end(), corners.begin(), corners.end());
            return true;
        }
        const int a = corners[longest], b = corners[(longest + 1) % 3], c = corners[(longest + 2) % 3];
        const int middle = middle_of(a, b);
        if (middle < 0) return false;
        waiting.push_back({middle, b, c});
        waiting.push_back({a, middle, c});
        return true;
    }

    // -1 when single precision knows no point between the two.
    int middle_of(int a, int b) {
        const auto low = static_cast<std::uint32_t>(std::min(a, b)),
                   high = static_cast<std::uint32_t>(std::max(a, b));
        const auto next = static_cast<int>(mesh_.P.size());
        auto [found, is_new] = middles_.try_emplace((std::uint64_t{low} << 32) | high, next);
        if (!is_new) return found->second;
        const Vec3 p = mesh_.P[low] * 0.5f + mesh_.P[high] * 0.5f;
        if (p == mesh_.P[low] || p == mesh_.P[high]) return -1;
        mesh_.P.push_back(p);
        mesh_.N.push_back(unit_or_zero(Vec3d(mesh_.N[low]) + Vec3d(mesh_.N[high])));
        mesh_.uv.push_back((mesh_.uv[low] + mesh_.uv[high]) * 0.5f);
        return next;
    }

    MeshData& mesh_;
    const Displacement& displacement_;
    std::unordered_map<std::uint64_t, int> middles_; ///< by the ends of the edge
};

} // namespace

std::vector<Vec3> vertex_normals(const MeshData& triangles) {
    std::vector<Vec3d> sums(triangles.P.size());
    for (std::size_t i = 0; i < triangles.indices.size(); i += 3) {
        std::array<std::size_t, 3> v;
        for (std::size_t k = 0; k < 3; ++k) v[k] = static_cast<std::size_t>(triangles.indices[i + k]);
        const Vec3d a(triangles.P[v[0]]),
            n = cross(Vec3d(triangles.P[v[1]]) - a, Vec3d(triangles.P[v[2]]) - a);
        const double size = length(n);
        if (!(size > 0)) continue;
        for (std::size_t vertex : v) sums[vertex] += n * (1 / size);
    }
    std::vector<Vec3> normals(sums.size());
    for (std::size_t i = 0; i < sums.size(); ++i) normals[i] = unit_or_zero(sums[i]);
    return normals;
}

std::string Displacement::apply(MeshData& mesh) const {
    if (mesh.uv.size() != mesh.P.size())
        return "the mesh has no texture coordinates, which \"displacement\" needs at each vertex";
    split_quads(mesh);
    mesh.face_indices = {};
    if (mesh.N.empty()) mesh.N = vertex_normals(mesh);
    for (Vec3& n : mesh.N) n = unit_or_zero(Vec3d(n));
    if (std::string problem = EdgeSplitter(mesh, *this).split(); !problem.empty()) return problem;
    auto height_at = [&](std::size_t i) {
        const Vec3 n = unit_or_zero(Vec3d(world_from_object.normal(mesh.N[i])));
        return height.eval({Vec3(world_from_object.point(Vec3d(mesh.P[i]))), n, mesh.uv[i]});
    };
    std::vector<float> heights(mesh.P.size());
    parallel_for(heights.size(), 1024, [&](std::size_t i) { heights[i] = height_at(i); });
    for (std::size_t i = 0; i < heights.size(); ++i) {
        if (!std::isfinite(heights[i]))
            return fmt::format(
                "\"displacement\" is {} at the texture coordinates ({}, {}); it must be finite", heights[i],
                mesh.uv[i].x, mesh.uv[i].y);
        mesh.P[i] += mesh.N[i] * heights[i];
    }
    mesh.N = vertex_normals(mesh);
    return "";
}

} // namespace alhazen
