/// The production walk: eight children a node, up to eight triangles a leaf, and many rays in flight (see
/// kernel_text.h).
#include <bit>
#include <stdexcept>

#include "accel/list.h"
#include "accel/wide/dispatch.h"
#include "accel/wide/layout.h"

namespace alhazen {

namespace {

// Kernels know rays and hits by these layouts.
static_assert(sizeof(WideRay) == sizeof(Ray) && offsetof(Ray, d) == offsetof(WideRay, d) &&
              offsetof(Ray, tmax) == offsetof(WideRay, tmax));
static_assert(sizeof(WideHit) == sizeof(Intersection) && offsetof(Intersection, t) == offsetof(WideHit, t) &&
              offsetof(Intersection, u) == offsetof(WideHit, u) &&
              offsetof(Intersection, v) == offsetof(WideHit, v) &&
              offsetof(Intersection, primitive) == offsetof(WideHit, primitive));

/// The rays of one question, and what is done with them between the kernel's steps.
class Batch {
  public:
    Batch(const WideLayout& layout, float extent, std::span<const Ray> rays, PrimitiveTests& tests,
          std::uint32_t first_index)
        : layout_(layout), extent_(extent), rays_(rays), tests_(tests), first_index_(first_index) {}

    std::span<Intersection> hits;    ///< closest: one a ray
    std::span<std::uint8_t> blocked; ///< any: one a ray
    WalkCounts* counts = nullptr;

    void run(void (*kernel)(const WideQuery&)) {
        if (layout_.root() == wide_done) return;
        WideQuery query;
        query.base = layout_.base();
        query.root = layout_.root();
        query.extent = extent_;
        query.rays = reinterpret_cast<const WideRay*>(rays_.data());
        query.count = static_cast<std::uint32_t>(rays_.size());
        query.hits = reinterpret_cast<WideHit*>(hits.data());
        query.blocked = blocked.data();
        query.owner = this;
        query.test = [](void* self, WideSlot& slot, std::uint32_t reference, std::uint32_t candidates) {
            return static_cast<Batch*>(self)->test(slot, reference, candidates);
        };
        query.count_visits = [](void* self, const WideSlot& slot) { static_cast<Batch*>(self)->count(slot); };
        kernel(query);
    }

  private:
    bool test(WideSlot& slot, std::uint32_t reference, std::uint32_t candidates) {
        const char* at = layout_.base() + (reference & wide_address);
        if (!(reference & wide_other))
            return test_triangles(slot, reinterpret_cast<const float*>(at),
                                  ((reference >> wide_count_shift) & 7) + 1, candidates);
        const auto* words = reinterpret_cast<const std::uint32_t*>(at);
        return *words & wide_filtered ? test_triangles(slot, reinterpret_cast<const float*>(words + 1),
                                                       *words & 0xff, candidates)
                                      : test_customs(slot, words + 1, *words);
    }

    // The ray as far as it is still searched.
    Ray ray_of(const WideSlot& slot) const {
        Ray ray = rays_[slot.ray];
        ray.tmax = slot.tmax;
        return ray;
    }
    static Intersection best_of(const WideSlot& slot) {
        Intersection best;
        best.t = slot.t;
        best.u = slot.u;
        best.v = slot.v;
        best.primitive = slot.primitive;
        return best;
    }
    static void take(WideSlot& slot, const Intersection& hit) {
        slot.t = hit.t;
        slot.u = hit.u;
        slot.v = hit.v;
        slot.primitive = hit.primitive;
        // One step more, so that a hit at the same distance is still reported.
        slot.tmax = next_up(hit.t);
    }

    bool test_triangles(WideSlot& slot, const float* leaf, std::uint32_t n, std::uint32_t candidates) {
        Ray ray = ray_of(slot);
        const RayShear shear(static_cast<int>(slot.axis[2]), slot.shear[0], slot.shear[1], slot.shear[2]);
        const auto* numbers = reinterpret_cast<const std::uint32_t*>(leaf + std::size_t{9} * n);
        bool changed = false;
        for (; candidates; candidates &= candidates - 1) {
            const auto i = static_cast<std::uint32_t>(std::countr_zero(candidates));
            auto corner = [&](std::uint32_t c) {
                return Vec3{leaf[3 * c * n + i], leaf[(3 * c + 1) * n + i], leaf[(3 * c + 2) * n + i]};
            };
            Intersection hit;
            if (!intersect_triangle(ray, shear, corner(0), corner(1), corner(2), hit)) continue;
            hit.primitive = numbers[i] & ~wide_filtered;
            if (!(hit.t < slot.t || hit.primitive < slot.primitive)) continue;
            if (numbers[i] & wide_filtered) {
                const Intersection best = best_of(slot);
                if (!tests_.accept({first_index_ + slot.ray, hit.primitive, ray, best}, hit)) continue;
            }
            take(slot, hit);
            ray.tmax = slot.tmax;
            changed = true;
        }
        return changed;
    }

    bool test_customs(WideSlot& slot, const std::uint32_t* numbers, std::uint32_t n) {
        bool changed = false;
        for (std::uint32_t i = 0; i < n; ++i) {
            const Ray ray = ray_of(slot);
            const Intersection best = best_of(slot);
            Intersection hit;
            hit.primitive = numbers[i];
            const PrimitiveTests::Question question{first_index_ + slot.ray, numbers[i], ray, best};
            if (!tests_.intersect(question, hit) || !question.would_win(hit.t)) continue;
            take(slot, hit);
            changed = true;
        }
        return changed;
    }

    void count(const WideSlot& slot) const {
        counts->nodes += slot.nodes;
        counts->leaves += slot.leaves;
        counts->max_stack = std::max(counts->max_stack, slot.highest);
    }

    const WideLayout& layout_;
    float extent_;
    std::span<const Ray> rays_;
    PrimitiveTests& tests_;
    std::uint32_t first_index_;
};

class WideStructure final : public Structure {
  public:
    WideStructure(const Primitives& primitives, const Tree& tree, const WideKernels& kernels)
        : layout_(tree, primitives), kernels_(kernels) {
        if (tree.nodes.empty()) return;
        bounds_ = tree.nodes[0].bounds;
        extent_ = max_component(max(abs(bounds_.lo), abs(bounds_.hi)));
    }

    const Bounds3& bounds() const override { return bounds_; }
    LayoutStats stats() const override { return layout_.stats(); }

    bool closest(const Ray& ray, Intersection& hit, PrimitiveTests& tests,
                 std::uint32_t ray_index) const override {
        Batch batch(layout_, extent_, {&ray, 1}, tests, ray_index);
        batch.hits = {&hit, 1};
        batch.run(kernels_.closest_one);
        return hit.found();
    }
    bool any(const Ray& ray, PrimitiveTests& tests, std::uint32_t ray_index) const override {
        Batch batch(layout_, extent_, {&ray, 1}, tests, ray_index);
        std::uint8_t blocked = 0;
        batch.blocked = {&blocked, 1};
        batch.run(kernels_.any_one);
        return blocked != 0;
    }
    void closest(std::span<const Ray> rays, std::span<Intersection> hits,
                 PrimitiveTests& tests) const override {
        Batch batch(layout_, extent_, rays, tests, 0);
        batch.hits = hits;
        batch.run(kernels_.closest);
    }
    void any(std::span<const Ray> rays, std::span<std::uint8_t> blocked,
             PrimitiveTests& tests) const override {
        std::fill(blocked.begin(), blocked.end(), std::uint8_t{0});
        Batch batch(layout_, extent_, rays, tests, 0);
        batch.blocked = blocked;
        batch.run(kernels_.any);
    }
    bool count(Query query, const Ray& ray, PrimitiveTests& tests, WalkCounts& counts) const override {
        Batch batch(layout_, extent_, {&ray, 1}, tests, 0);
        batch.counts = &counts;
        Intersection hit;
        std::uint8_t blocked = 0;
        batch.hits = {&hit, 1};
        batch.blocked = {&blocked, 1};
        batch.run(query == Query::closest ? kernels_.closest_counted : kernels_.any_counted);
        return hit.found() || blocked;
    }

  private:
    WideLayout layout_;
    const WideKernels& kernels_;
    Bounds3 bounds_;
    float extent_ = 0;
};

// An object too large for the layout's references is walked the ordinary way.
std::unique_ptr<Structure> make(const Primitives& primitives, const Tree& tree, const WalkOptions& options) {
    try {
        return std::make_unique<WideStructure>(primitives, tree, wide_kernels(options.instructions));
    } catch (const std::length_error&) {
        return stack_walk().make(primitives, tree, options);
    }
}

} // namespace

AccelWalk wide_walk() {
    return {"wide",
            "eight children a node, sixteen rays in flight: the production structure",
            {.leaf_size = 1, .joined = 8},
            make};
}

} // namespace alhazen
