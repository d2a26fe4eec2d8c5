#include "sdf/solid_parts.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace alhazen {

namespace {

constexpr double sheet = 0.6, enclosing = 0.1;

/// Sets of numbers that are joined (Tarjan 1975), with paths halved.
class Groups {
  public:
    explicit Groups(std::size_t count) : parents_(count) { std::iota(parents_.begin(), parents_.end(), 0u); }
    std::uint32_t find(std::uint32_t i) {
        while (parents_[i] != i) i = parents_[i] = parents_[parents_[i]];
        return i;
    }
    void join(std::uint32_t a, std::uint32_t b) { parents_[find(a)] = find(b); }

  private:
    std::vector<std::uint32_t> parents_;
};

struct Sides {
    Vec3d vector;    ///< sum of area times normal
    double area = 0; ///< sum of area

    void add(const Sides& other) {
        vector += other.vector;
        area += other.area;
    }
    bool are_beyond(double share) const { return length(vector) > share * area; }
};

Sides sides_of(const Corners& t) {
    const Vec3d v = cross(Vec3d(t.b) - Vec3d(t.a), Vec3d(t.c) - Vec3d(t.a)) * 0.5;
    const double area = length(v);
    // What is not finite must not decide for what hangs on it.
    return std::isfinite(area) ? Sides{v, area} : Sides{};
}

// Triangles joined where corners are at the same place.
Groups parts_of(std::span<const Corners> triangles) {
    struct Corner {
        Vec3 p;
        std::uint32_t triangle;
        auto key() const { return std::tuple(p.x, p.y, p.z); }
    };
    std::vector<Corner> corners;
    corners.reserve(3 * triangles.size());
    for (std::uint32_t i = 0; i < triangles.size(); ++i)
        for (Vec3 p : {triangles[i].a, triangles[i].b, triangles[i].c})
            if (is_finite(p)) corners.push_back({p, i});
    std::sort(corners.begin(), corners.end(),
              [](const Corner& a, const Corner& b) { return a.key() < b.key(); });
    Groups groups(triangles.size());
    for (std::size_t i = 1; i < corners.size(); ++i)
        if (corners[i].key() == corners[i - 1].key())
            groups.join(corners[i].triangle, corners[i - 1].triangle);
    return groups;
}

} // namespace

MeshParts mesh_parts(std::span<const Corners> triangles, bool is_one_body) {
    Groups groups = parts_of(triangles);
    std::vector<Sides> parts(triangles.size());
    for (std::uint32_t i = 0; i < triangles.size(); ++i) parts[groups.find(i)].add(sides_of(triangles[i]));
    Sides sheets;
    for (const Sides& part : parts)
        if (part.are_beyond(sheet)) sheets.add(part);
    const bool are_faces = is_one_body && !sheets.are_beyond(enclosing);
    MeshParts found;
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
        const bool is_sheet = !are_faces && parts[groups.find(i)].are_beyond(sheet);
        (is_sheet ? found.sheets : found.solid).push_back(triangles[i]);
    }
    return found;
}

} // namespace alhazen
