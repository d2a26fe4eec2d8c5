/// The production walk: eight children a node, up to eight triangles a leaf, and many rays in flight (see
/// kernel_text.h).
#include <array>
#include <bit>
#include <cstring>

#include "accel/box_ray.h"
#include "accel/list.h"
#include "accel/wide/dispatch.h"
#include "accel/wide/layout.h"

namespace alhazen {

namespace {

/// The rays of one question, and what is done with them between the kernel's steps.
class Batch {
  public:
    Batch(const WideLayout& layout, const Bounds3& bounds, std::span<const Ray> rays, PrimitiveTests& tests,
          std::uint32_t first_index)
        : layout_(layout), bounds_(bounds), rays_(rays), tests_(tests), first_index_(first_index) {}

    std::span<Intersection> hits;    ///< closest: one a ray
    std::span<std::uint8_t> blocked; ///< any: one a ray
    WalkCounts* counts = nullptr;

    void run(void (*kernel)(const WideQuery&)) {
        if (layout_.root() == wide_done) return;
        WideQuery query;
        query.base = layout_.base();
        query.root = layout_.root();
        query.count = static_cast<std::uint32_t>(rays_.size());
        query.owner = this;
        query.start = [](void* self, WideSlot& slot, std::uint32_t ray) {
            return static_cast<Batch*>(self)->start(slot, ray);
        };
        query.test = [](void* self, WideSlot& slot, std::uint32_t reference, std::uint32_t candidates) {
            return static_cast<Batch*>(self)->test(slot, reference, candidates);
        };
        query.finish = [](void* self, const WideSlot& slot) { static_cast<Batch*>(self)->finish(slot); };
        kernel(query);
    }

  private:
    bool start(WideSlot& slot, std::uint32_t number) const {
        const Ray& ray = rays_[number];
        if (!is_traceable(ray)) return false;
        const BoxRay box(ray, bounds_);
        const RayShear shear(ray);
        store(slot.enter_scale, box.enter_scale);
        store(slot.enter_offset, box.enter_offset);
        store(slot.leave_scale, box.leave_scale);
        store(slot.leave_offset, box.leave_offset);
        const auto near = std::bit_cast<std::array<std::uint32_t, 4>>(box.near_side);
        for (std::uint32_t axis = 0; axis < 3; ++axis) {
            slot.origin[axis] = ray.o[static_cast<int>(axis)];
            slot.near_plane[axis] = 64 * axis + 32 * near[axis];
        }
        slot.tmax = ray.tmax;
        slot.shear[0] = shear.sx;
        slot.shear[1] = shear.sy;
        slot.shear[2] = shear.sz;
        const auto z = static_cast<std::uint32_t>(shear.z);
        slot.axis[0] = z == 2 ? 0 : z + 1;
        slot.axis[1] = z == 0 ? 2 : z - 1;
        slot.axis[2] = z;
        // Orders are for octants that go forwards in x; the others read them from the end.
        const std::uint32_t backwards = box.near_side[0] != 0;
        const std::uint32_t y = (box.near_side[1] != 0) ^ backwards,
                            z_bit = (box.near_side[2] != 0) ^ backwards;
        slot.order = static_cast<std::uint32_t>(offsetof(WideNode, order)) + 3 * (y + 2 * z_bit);
        slot.is_reversed = backwards;
        slot.ray = number;
        slot.t = infinity;
        slot.primitive = no_primitive;
        return true;
    }

    bool test(WideSlot& slot, std::uint32_t reference, std::uint32_t candidates) {
        const char* at = layout_.base() + static_cast<std::size_t>(reference & wide_address) * wide_unit;
        const std::uint32_t n = ((reference >> wide_count_shift) & 7) + 1;
        return reference & wide_custom
                   ? test_customs(slot, reinterpret_cast<const std::uint32_t*>(at), n)
                   : test_triangles(slot, reinterpret_cast<const float*>(at), n, candidates);
    }

    static void store(float* to, Lanes4 v) { std::memcpy(to, &v, sizeof v); }

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
            if (numbers[i] == no_primitive) continue;
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

    void finish(const WideSlot& slot) {
        if (counts) {
            counts->nodes += slot.nodes;
            counts->leaves += slot.leaves;
            counts->max_stack = std::max(counts->max_stack, slot.highest);
        }
        if (!blocked.empty()) blocked[slot.ray] = slot.primitive != no_primitive;
        if (!hits.empty() && slot.primitive != no_primitive) hits[slot.ray] = best_of(slot);
    }

    const WideLayout& layout_;
    const Bounds3& bounds_;
    std::span<const Ray> rays_;
    PrimitiveTests& tests_;
    std::uint32_t first_index_;
};

class WideStructure final : public Structure {
  public:
    WideStructure(const Primitives& primitives, const Tree& tree, const WideKernels& kernels)
        : layout_(tree, primitives), kernels_(kernels) {
        if (!tree.nodes.empty()) bounds_ = tree.nodes[0].bounds;
    }

    const Bounds3& bounds() const override { return bounds_; }
    LayoutStats stats() const override { return layout_.stats(); }

    bool closest(const Ray& ray, Intersection& hit, PrimitiveTests& tests,
                 std::uint32_t ray_index) const override {
        Batch batch(layout_, bounds_, {&ray, 1}, tests, ray_index);
        batch.hits = {&hit, 1};
        batch.run(kernels_.closest_one);
        return hit.found();
    }
    bool any(const Ray& ray, PrimitiveTests& tests, std::uint32_t ray_index) const override {
        Batch batch(layout_, bounds_, {&ray, 1}, tests, ray_index);
        std::uint8_t blocked = 0;
        batch.blocked = {&blocked, 1};
        batch.run(kernels_.any_one);
        return blocked != 0;
    }
    void closest(std::span<const Ray> rays, std::span<Intersection> hits,
                 PrimitiveTests& tests) const override {
        Batch batch(layout_, bounds_, rays, tests, 0);
        batch.hits = hits;
        batch.run(kernels_.closest);
    }
    void any(std::span<const Ray> rays, std::span<std::uint8_t> blocked,
             PrimitiveTests& tests) const override {
        std::fill(blocked.begin(), blocked.end(), std::uint8_t{0});
        Batch batch(layout_, bounds_, rays, tests, 0);
        batch.blocked = blocked;
        batch.run(kernels_.any);
    }
    bool count(Query query, const Ray& ray, PrimitiveTests& tests, WalkCounts& counts) const override {
        Batch batch(layout_, bounds_, {&ray, 1}, tests, 0);
        batch.counts = &counts;
        Intersection hit;
        batch.hits = {&hit, 1};
        batch.run(query == Query::closest ? kernels_.closest_counted : kernels_.any_counted);
        return hit.found();
    }

  private:
    WideLayout layout_;
    const WideKernels& kernels_;
    Bounds3 bounds_;
};

std::unique_ptr<Structure> make(const Primitives& primitives, const Tree& tree, const WalkOptions& options) {
    return std::make_unique<WideStructure>(primitives, tree, wide_kernels(options.instructions));
}

} // namespace

AccelWalk wide_walk() {
    return {"wide",
            "eight children a node, sixteen rays in flight: the production structure",
            {.leaf_size = 1},
            make};
}

} // namespace alhazen
