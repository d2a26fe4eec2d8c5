/// A structure made of a layout and a walk that takes one ray at a time: what most walks of the list are.
#pragma once

#include "accel/box_ray.h"
#include "accel/structure.h"

namespace alhazen {

/// Counts nothing, and costs nothing.
struct NoCounts {
    void node() {}
    void leaf() {}
    void restart() {}
    void stack(int /*entries*/) {}
};

/// Adds to WalkCounts.
struct Counting {
    WalkCounts& counts;

    void node() { ++counts.nodes; }
    void leaf() { ++counts.leaves; }
    void restart() { ++counts.restarts; }
    void stack(int entries) {
        counts.max_stack = std::max(counts.max_stack, static_cast<std::uint32_t>(entries));
    }
};

/// Walk is a stateless class with
///     using Layout = ...;                                    made from (const Tree&), with members stats()
///     template <Query query, class Counter>
///     static void walk(const Layout&, const BoxRay&, Nearest<query>&, Counter&);
/// The walk offers leaves to the search (nearest.test(first, count)) until that says true or no box is left
/// whose entry is <= nearest.tmax().
template <class Walk>
class WalkStructure : public Structure {
  public:
    WalkStructure(const Primitives& primitives, const Tree& tree, typename Walk::Layout layout)
        : layout_(std::move(layout)), store_(tree, primitives) {
        if (!tree.nodes.empty()) bounds_ = tree.nodes[0].bounds;
    }

    const Bounds3& bounds() const override { return bounds_; }
    LayoutStats stats() const override {
        LayoutStats stats = layout_.stats();
        stats.bytes += store_.bytes();
        return stats;
    }

    using Structure::any;
    using Structure::closest;
    bool closest(const Ray& ray, Intersection& hit, PrimitiveTests& tests,
                 std::uint32_t ray_index) const override {
        NoCounts none;
        return run<Query::closest>(ray, hit, tests, ray_index, none);
    }
    bool any(const Ray& ray, PrimitiveTests& tests, std::uint32_t ray_index) const override {
        NoCounts none;
        Intersection hit;
        return run<Query::any>(ray, hit, tests, ray_index, none);
    }
    bool count(Query query, const Ray& ray, PrimitiveTests& tests, WalkCounts& counts) const override {
        Counting counting{counts};
        Intersection hit;
        return query == Query::closest ? run<Query::closest>(ray, hit, tests, 0, counting)
                                       : run<Query::any>(ray, hit, tests, 0, counting);
    }

  protected:
    const typename Walk::Layout& layout() const { return layout_; }
    const LeafStore& store() const { return store_; }

  private:
    template <Query query, class Counter>
    bool run(const Ray& ray, Intersection& hit, PrimitiveTests& tests, std::uint32_t ray_index,
             Counter& counter) const {
        if (store_.entries.empty() || !is_traceable(ray)) return false;
        Nearest<query> nearest(store_, ray, hit, tests, ray_index);
        Walk::template walk<query>(layout_, BoxRay(ray, bounds_), nearest, counter);
        return nearest.found();
    }

    typename Walk::Layout layout_;
    LeafStore store_;
    Bounds3 bounds_;
};

} // namespace alhazen
