/// Smooth surfaces from coarse triangle meshes (Loop 1987, "Smooth subdivision surfaces based on triangles";
/// with the boundary rules, limit positions and tangents of Hoppe et al. 1994, "Piecewise smooth surface
/// reconstruction", and Biermann et al. 2000, "Piecewise smooth subdivision surfaces with normal control").
#pragma once

#include <string>
#include <vector>

#include "base/vec.h"

namespace alhazen {

/// A control mesh: every edge belongs to one or two triangles, and these go round in the same direction.
class LoopSurface {
  public:
    /// indices holds three a triangle, each valid. What makes the triangles no such mesh is in problem()
    /// then, and nothing else may be called.
    LoopSurface(std::vector<Vec3> positions, const std::vector<int>& indices);
    /// "" when all is well.
    const std::string& problem() const { return problem_; }

    /// Each triangle becomes four.
    void refine();
    /// Moves the vertices to where endless refinement would take them (those of boundaries, near there).
    void move_to_limit();
    /// Normals of the limit surface (of any length), one a vertex; after move_to_limit(). They point to the
    /// side from which the triangles' corners go round clockwise.
    std::vector<Vec3> normals() const;

    const std::vector<Vec3>& positions() const { return positions_; }
    /// Three a triangle.
    const std::vector<int>& indices() const { return corners_; }

  private:
    static constexpr int none = -1;
    /// Half edge k of triangle f, from corner k to the next, has the number 3 f + k.
    static int next(int h) { return h % 3 == 2 ? h - 2 : h + 1; }
    static int previous(int h) { return h % 3 == 0 ? h + 2 : h - 1; }
    int from(int h) const { return corners_[static_cast<std::size_t>(h)]; }
    int to(int h) const { return from(next(h)); }
    int twin(int h) const { return twins_[static_cast<std::size_t>(h)]; }
    Vec3d position(int vertex) const { return Vec3d(positions_[static_cast<std::size_t>(vertex)]); }

    void join_edges();
    void find_fans();
    /// The vertices around, counter-clockwise; those of a boundary vertex from one end of the boundary to the
    /// other.
    void ring(int vertex, std::vector<int>& around) const;
    bool is_boundary(int vertex) const { return twin(first_[static_cast<std::size_t>(vertex)]) == none; }
    /// The vertex's own position weighed against each of its neighbours'; a boundary vertex's against those
    /// along the boundary.
    template <class Inner>
    std::vector<Vec3> blend(float boundary, Inner inner) const;

    std::string problem_;
    std::vector<Vec3> positions_;
    std::vector<int> corners_; ///< three a triangle
    std::vector<int> twins_;   ///< the half edge of the neighbour, or none at the boundary
    /// A half edge that leaves the vertex; of a boundary vertex, the one along the boundary; none where no
    /// triangle is.
    std::vector<int> first_;
};

} // namespace alhazen
