/// The baseline walk: depth first, nearer child first, the farther one put on a stack.
#pragma once

#include "accel/intersection.h"
#include "accel/walk/slabs.h"

namespace alhazen {

/// What is asked: the nearest hit, or whether there is any.
enum class Query { closest, any };

/// The nearest hit so far. Of hits at the same distance the one with the lowest primitive number counts, so
/// that the result does not depend on the order in which primitives are met.
template <Query query, class Leaf>
class Nearest {
  public:
    Nearest(const Ray& ray, Intersection& hit, Leaf& leaf) : ray_(ray), hit_(hit), leaf_(leaf) {}

    /// Tests one primitive; true when the query is answered.
    bool test(std::uint32_t primitive) {
        Intersection candidate;
        candidate.primitive = primitive;
        if (!leaf_(primitive, ray_, candidate)) return false;
        bool nearer = candidate.t < t_ || (candidate.t == t_ && primitive < primitive_);
        if (!nearer) return false;
        hit_ = candidate;
        t_ = candidate.t;
        primitive_ = primitive;
        // One step more, so that a hit at the same distance is still reported.
        ray_.tmax = next_up(t_);
        return query == Query::any;
    }
    bool found() const { return primitive_ != no_primitive; }
    float tmax() const { return ray_.tmax; }

  private:
    Ray ray_;
    Intersection& hit_;
    Leaf& leaf_;
    float t_ = infinity;
    std::uint32_t primitive_ = no_primitive;
};

/// Answers the query; true when there is a hit, and then hit is set. leaf is
///     bool leaf(std::uint32_t primitive, Ray& ray, Intersection& candidate)
/// and tells whether the ray meets the primitive at 0 < t < ray.tmax, setting candidate's t, u and v (and
/// primitive and instance, where they are not the number and 0). The ray's tmax shrinks from hit to hit.
template <Query query, class Leaf>
bool walk(const BinaryLayout& layout, const Ray& ray, Intersection& hit, Leaf&& leaf) {
    if (layout.order.empty() || !is_traceable(ray)) return false;
    // Without defaults, since setting the whole stack to zero would take longer than a short walk.
    struct Entry {
        std::uint32_t index, count;
        float t;
    };
    Entry stack[Tree::max_depth];
    int height = 0;
    const SlabRay slabs(ray, layout.bounds);
    Nearest<query, Leaf> nearest(ray, hit, leaf);
    BinaryChild current = layout.root;
    for (;;) {
        if (current.count > 0) {
            for (std::uint32_t i = 0; i < current.count; ++i)
                if (nearest.test(layout.order[current.index + i])) return true;
        } else {
            const BinaryNode& node = layout.nodes[current.index];
            Lanes4 t = slabs.test(node, nearest.tmax());
            bool left = t[0] <= -t[2], right = t[1] <= -t[3];
            if (left && right) {
                int far = t[1] < t[0] ? 0 : 1;
                stack[height++] = {node.index[far], node.count[far], far ? t[1] : t[0]};
                current = node.child(1 - far);
                continue;
            }
            if (left || right) {
                current = node.child(right);
                continue;
            }
        }
        do {
            if (height == 0) return nearest.found();
            --height;
        } while (stack[height].t > nearest.tmax());
        current = {stack[height].index, stack[height].count};
    }
}

} // namespace alhazen
