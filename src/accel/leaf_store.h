/// The primitives in the order of a tree's leaves, triangles with their corners, so that testing a leaf reads
/// one run of memory.
#pragma once

#include <vector>

#include "accel/build/tree.h"
#include "accel/triangle.h"

namespace alhazen {

struct LeafStore {
    struct Entry {
        Corners corners; ///< of triangles
        std::uint32_t primitive;
        PrimitiveKind kind;
    };
    std::vector<Entry> entries; ///< one a place of the tree's order

    LeafStore() = default;
    LeafStore(const Tree& tree, const Primitives& primitives);
    std::size_t bytes() const { return entries.size() * sizeof(Entry); }
};

/// What is asked: the nearest hit, or whether there is any.
enum class Query { closest, any };

/// One ray's search: the nearest hit so far, and the tests that may improve it. Of hits at the same distance
/// the one with the lowest primitive number counts, so that the result does not depend on the order in which
/// primitives are met.
template <Query query>
class Nearest {
  public:
    /// hit must be as constructed; it holds the result. The ray must be traceable.
    Nearest(const LeafStore& store, const Ray& ray, Intersection& hit, PrimitiveTests& tests,
            std::uint32_t ray_index)
        : entries_(store.entries.data()), ray_(ray), shear_(ray), hit_(hit), tests_(tests),
          ray_index_(ray_index) {}

    /// Tests the primitives at count places from first on; true when the query is answered.
    bool test(std::uint32_t first, std::uint32_t count) {
        for (std::uint32_t i = 0; i < count; ++i)
            if (test_entry(entries_[first + i])) return true;
        return false;
    }
    bool found() const { return hit_.found(); }
    /// Boxes that are entered later need not be visited.
    float tmax() const { return ray_.tmax; }

  private:
    bool test_entry(const LeafStore::Entry& entry) {
        Intersection candidate;
        candidate.primitive = entry.primitive;
        const PrimitiveTests::Question question{ray_index_, entry.primitive, ray_, hit_};
        if (entry.kind == PrimitiveKind::custom) {
            if (!tests_.intersect(question, candidate)) return false;
        } else {
            const Corners& t = entry.corners;
            if (!intersect_triangle(ray_, shear_, t.a, t.b, t.c, candidate)) return false;
        }
        if (!question.would_win(candidate.t)) return false;
        if (entry.kind == PrimitiveKind::filtered_triangle && !tests_.accept(question, candidate))
            return false;
        hit_ = candidate;
        // One step more, so that a hit at the same distance is still reported.
        ray_.tmax = next_up(candidate.t);
        return query == Query::any;
    }

    const LeafStore::Entry* entries_;
    Ray ray_;
    RayShear shear_;
    Intersection& hit_;
    PrimitiveTests& tests_;
    std::uint32_t ray_index_;
};

} // namespace alhazen
