/// Rays that go nearly the same way together, as those of a camera through neighbouring pixels do.
///
/// A node's eight boxes are tested against all rays at once by interval arithmetic (Boulos, Wald and Shirley
/// 2006, "Geometric and Arithmetic Culling Methods for Entire Ray Packets"); a child that passes is tested
/// against the rays that reached the node, eight at a time, and is pushed with the set of those that meet it.
/// Where only few are left each goes on alone. In leaves a triangle meets eight rays at a time. All rays of a
/// packet have the signs of their directions, and their longest axis, in common.
#pragma once

#include "accel/wide/kernel_leaf.h"
#include "accel/wide/kernel_single.h"

namespace {

enum : std::uint32_t {
    packet_size = 64,
    packet_groups = packet_size / 8,
    packet_least = 16, // rays for which it is worth to prepare a packet
    rays_alone = 6     // so many rays or fewer go on one by one
};

/// Whether three of the rays go nearly the same way: at most about eight degrees apart.
ALHAZEN_INLINE bool look_coherent(const WideRay* rays, std::uint32_t n) {
    if (n < packet_least) return false;
    auto dot = [](const WideRay& a, const WideRay& b) __attribute__((always_inline)) {
        return a.d[0] * b.d[0] + a.d[1] * b.d[1] + a.d[2] * b.d[2];
    };
    auto are_near = [&](const WideRay& a, const WideRay& b) __attribute__((always_inline)) {
        const float c = dot(a, b);
        return c > 0 && c * c > 0.98f * dot(a, a) * dot(b, b);
    };
    return are_near(rays[0], rays[1]) && are_near(rays[0], rays[n / 2]) && are_near(rays[0], rays[n - 1]);
}

/// Between what all rays of a packet enter and leave boxes: where they start, and the scales by which BoxRay
/// multiplies. On each axis the sign of the scales is the same.
struct PacketInterval {
    float enter_origin[3], enter_low[3], enter_high[3];
    float leave_origin[3], leave_low[3], leave_high[3];

    /// Where a ray can enter the boxes at the earliest, and leave at the latest.
    ALHAZEN_INLINE Interval test(const WideSlot& slot, const char* node, float tmax) const {
        auto planes = [&](std::size_t axis, std::uint32_t other) __attribute__((always_inline)) {
            return Lanes::load(reinterpret_cast<const float*>(node + (slot.near_plane[axis] ^ other)));
        };
        auto enter = [&](std::size_t axis) __attribute__((always_inline)) {
            const F way = Lanes::sub(planes(axis, 0), Lanes::all(enter_origin[axis]));
            return Lanes::min(Lanes::mul(way, Lanes::all(enter_low[axis])),
                              Lanes::mul(way, Lanes::all(enter_high[axis])));
        };
        auto leave = [&](std::size_t axis) __attribute__((always_inline)) {
            const F way = Lanes::sub(planes(axis, 32), Lanes::all(leave_origin[axis]));
            return Lanes::max(Lanes::mul(way, Lanes::all(leave_low[axis])),
                              Lanes::mul(way, Lanes::all(leave_high[axis])));
        };
        return {Lanes::max(Lanes::max(enter(0), enter(1)), Lanes::max(enter(2), Lanes::all(0))),
                Lanes::min(Lanes::min(leave(0), leave(1)), Lanes::min(leave(2), Lanes::all(tmax)))};
    }
};

/// What tests of eight rays at a time read; see WideSlot.
struct alignas(64) PacketRays {
    float enter_scale[3][packet_size], enter_offset[3][packet_size];
    float leave_scale[3][packet_size], leave_offset[3][packet_size];
    float origin[3][packet_size], shear[3][packet_size];
    float tmax[packet_size]; ///< negative: no ray

    ALHAZEN_INLINE void set(std::uint32_t i, const WideSlot& slot) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            enter_scale[axis][i] = slot.enter_scale[axis];
            enter_offset[axis][i] = slot.enter_offset[axis];
            leave_scale[axis][i] = slot.leave_scale[axis];
            leave_offset[axis][i] = slot.leave_offset[axis];
            origin[axis][i] = slot.origin[axis];
            shear[axis][i] = slot.shear[axis];
        }
        tmax[i] = slot.tmax;
    }
};

class PacketWalk {
  public:
    ALHAZEN_INLINE explicit PacketWalk(const WideQuery& query) : query_(query), base_(query.base) {}

    /// False when the rays have too little in common.
    bool prepare(std::uint32_t first, std::uint32_t n) {
        const WideSlot& one = slots_[0];
        float lowest[3], highest[3];
        for (std::uint32_t i = 0; i < n; ++i) {
            if (!begin(query_, slots_[i], first + i)) return false;
            const WideRay& ray = query_.rays[first + i];
            for (std::size_t axis = 0; axis < 3; ++axis) {
                if (slots_[i].near_plane[axis] != one.near_plane[axis]) return false;
                lowest[axis] = i == 0 || ray.o[axis] < lowest[axis] ? ray.o[axis] : lowest[axis];
                highest[axis] = i == 0 || ray.o[axis] > highest[axis] ? ray.o[axis] : highest[axis];
            }
            if (slots_[i].axis[2] != one.axis[2]) return false;
            // Where a ray hardly moves along an axis, BoxRay has padding that an interval knows nothing of.
            const float still = 1e-5f * __builtin_fabsf(ray.d[one.axis[2]]);
            for (float speed : ray.d)
                if (__builtin_fabsf(speed) < still) return false;
            rays_.set(i, slots_[i]);
            all_ |= std::uint64_t{1} << i;
        }
        for (std::uint32_t i = n; i < packet_size; ++i) {
            rays_.set(i, one);
            rays_.tmax[i] = -1;
        }
        return set_interval(lowest, highest, n);
    }

    void run() {
        push(query_.root, 0, all_);
        set_longest();
        while (height_ > 0) {
            const Entry e = stack_[--height_];
            if (e.t > longest_) continue;
            if (__builtin_popcountll(e.rays) <= rays_alone)
                go_on_alone(e);
            else if (e.reference & alhazen::wide_leaf)
                visit(e);
            else
                descend(e);
        }
        for (std::uint64_t rays = all_; rays; rays &= rays - 1)
            finish<false>(query_, slots_[__builtin_ctzll(rays)]);
    }

  private:
    struct Entry {
        std::uint64_t rays; ///< that meet it, a bit each
        std::uint32_t reference;
        float t; ///< no ray enters earlier
    };

    /// False when the rays start too far apart, or when one hardly moves along an axis: intervals would be
    /// wide.
    bool set_interval(const float* lowest, const float* highest, std::uint32_t n) {
        // Beside the padding of BoxRay, for the rounding of the interval's own products.
        constexpr float unit = 0x1p-24f, wider = 4 * unit;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (highest[axis] - lowest[axis] > query_.extent / 64) return false;
            const float* enter = rays_.enter_scale[axis];
            const float* leave = rays_.leave_scale[axis];
            float el = enter[0], eh = enter[0], ll = leave[0], lh = leave[0];
            for (std::uint32_t i = 1; i < n; ++i) {
                el = enter[i] < el ? enter[i] : el;
                eh = enter[i] > eh ? enter[i] : eh;
                ll = leave[i] < ll ? leave[i] : ll;
                lh = leave[i] > lh ? leave[i] : lh;
            }
            const float size = __builtin_fabsf(lowest[axis]) > __builtin_fabsf(highest[axis])
                                   ? __builtin_fabsf(lowest[axis])
                                   : __builtin_fabsf(highest[axis]);
            const float low = lowest[axis] - 8 * unit * size, high = highest[axis] + 8 * unit * size;
            const bool is_forward = slots_[0].near_plane[axis] == 64 * axis;
            interval_.enter_origin[axis] = is_forward ? high : low;
            interval_.leave_origin[axis] = is_forward ? low : high;
            interval_.enter_low[axis] = el - wider * __builtin_fabsf(el);
            interval_.enter_high[axis] = eh + wider * __builtin_fabsf(eh);
            interval_.leave_low[axis] = ll - wider * __builtin_fabsf(ll);
            interval_.leave_high[axis] = lh + wider * __builtin_fabsf(lh);
        }
        return true;
    }

    ALHAZEN_INLINE void push(std::uint32_t reference, float t, std::uint64_t rays) {
        stack_[height_++] = {rays, reference, t};
    }

    /// How far the farthest ray still goes.
    void set_longest() {
        F most = Lanes::load(rays_.tmax);
        for (std::size_t g = 1; g < packet_groups; ++g)
            most = Lanes::max(most, Lanes::load(rays_.tmax + 8 * g));
        float t[8];
        Lanes::store(t, most);
        longest_ = t[0];
        for (float one : t) longest_ = one > longest_ ? one : longest_;
    }

    void go_on_alone(const Entry& e) {
        for (std::uint64_t rays = e.rays; rays; rays &= rays - 1) {
            const auto i = static_cast<std::uint32_t>(__builtin_ctzll(rays));
            if (!(e.t <= rays_.tmax[i])) continue;
            SingleWalk<false, false>(query_, slots_[i], alone_).run(e.reference);
            rays_.tmax[i] = slots_[i].tmax;
        }
        set_longest();
    }

    void descend(const Entry& e) {
        const char* at = base_ + e.reference;
        const auto* node = reinterpret_cast<const WideNode*>(at);
        const Interval t = interval_.test(slots_[0], at, longest_);
        const std::uint32_t hits = Lanes::at_most(t.entry, t.exit);
        float entry[8];
        Lanes::store(entry, t.entry);
        const std::uint32_t order = order_of(slots_[0], at);
        for (std::uint32_t place = 0; place < 8; ++place) {
            const std::uint32_t shift = 3 * (slots_[0].is_reversed ? 7 - place : place);
            const std::uint32_t c = (order >> shift) & 7;
            if (!((hits >> c) & 1)) continue;
            const std::uint64_t rays = meeting(at, c, e.rays);
            if (rays == 0) continue;
            for (std::size_t line = 0; line < 4; ++line) Lanes::prefetch(base_ + node->child[c] + 64 * line);
            push(node->child[c], entry[c], rays);
        }
    }

    /// Which of the rays meet the node's child c.
    ALHAZEN_INLINE std::uint64_t meeting(const char* node, std::uint32_t c, std::uint64_t rays) const {
        F near[3], far[3];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::uint32_t at = slots_[0].near_plane[axis];
            near[axis] = Lanes::all(reinterpret_cast<const float*>(node + at)[c]);
            far[axis] = Lanes::all(reinterpret_cast<const float*>(node + (at ^ 32))[c]);
        }
        std::uint64_t meet = 0;
        for (std::size_t i = 0; i < packet_size; i += 8) {
            if (((rays >> i) & 0xff) == 0) continue;
            auto enter = [&](std::size_t axis) __attribute__((always_inline)) {
                return Lanes::scale(near[axis], Lanes::load(rays_.enter_scale[axis] + i),
                                    Lanes::load(rays_.enter_offset[axis] + i));
            };
            auto leave = [&](std::size_t axis) __attribute__((always_inline)) {
                return Lanes::scale(far[axis], Lanes::load(rays_.leave_scale[axis] + i),
                                    Lanes::load(rays_.leave_offset[axis] + i));
            };
            const F entry = Lanes::max(Lanes::max(enter(0), enter(1)), Lanes::max(enter(2), Lanes::all(0)));
            const F exit =
                Lanes::min(Lanes::min(leave(0), leave(1)), Lanes::min(leave(2), Lanes::load(rays_.tmax + i)));
            meet |= std::uint64_t{Lanes::at_most(entry, exit)} << i;
        }
        return meet & rays;
    }

    void visit(const Entry& e) {
        if (e.reference & alhazen::wide_other) [[unlikely]] {
            for (std::uint64_t rays = e.rays; rays; rays &= rays - 1) {
                const auto i = static_cast<std::uint32_t>(__builtin_ctzll(rays));
                if (visit_leaf<false>(query_, base_, slots_[i], e.reference)) rays_.tmax[i] = slots_[i].tmax;
            }
            return set_longest();
        }
        const auto* corners = reinterpret_cast<const float*>(base_ + (e.reference & alhazen::wide_address));
        const std::uint32_t n = ((e.reference >> alhazen::wide_count_shift) & 7) + 1;
        const auto* numbers = reinterpret_cast<const std::uint32_t*>(corners + std::size_t{9} * n);
        bool has_changed = false;
        for (std::uint32_t i = 0; i < packet_size; i += 8) {
            const auto lanes = static_cast<std::uint32_t>(e.rays >> i) & 0xff;
            if (lanes == 0) continue;
            for (std::uint32_t k = 0; k < n; ++k)
                has_changed |= test_triangle(e.reference, corners + k, n, k, numbers[k], i, lanes);
        }
        if (has_changed) set_longest();
    }

    /// Triangle k of a leaf, and eight rays from the i-th on; true when a ray's nearest hit has changed.
    ALHAZEN_INLINE bool test_triangle(std::uint32_t leaf, const float* corners, std::uint32_t n,
                                      std::uint32_t k, std::uint32_t number, std::uint32_t i,
                                      std::uint32_t lanes) {
        const std::size_t x = slots_[0].axis[0] * n, y = slots_[0].axis[1] * n, z = slots_[0].axis[2] * n;
        auto ray = [&](const float(&of)[3][packet_size], std::size_t axis) __attribute__((always_inline)) {
            return Lanes::load(of[axis] + i);
        };
        auto corner = [&](const float* p) __attribute__((always_inline)) {
            const F qz = Lanes::sub(Lanes::all(p[z]), ray(rays_.origin, 2));
            return Corner{Lanes::sub(Lanes::sub(Lanes::all(p[x]), ray(rays_.origin, 0)),
                                     Lanes::mul(ray(rays_.shear, 0), qz)),
                          Lanes::sub(Lanes::sub(Lanes::all(p[y]), ray(rays_.origin, 1)),
                                     Lanes::mul(ray(rays_.shear, 1), qz)),
                          qz};
        };
        const std::size_t next = std::size_t{3} * n;
        Candidates found;
        if (!test_corners(corner(corners), corner(corners + next), corner(corners + 2 * next),
                          ray(rays_.shear, 2), Lanes::load(rays_.tmax + i), lanes, found))
            return false;
        if (found.hit) {
            const HitLanes hits(found);
            for (std::uint32_t bits = found.hit; bits; bits &= bits - 1) {
                const auto lane = static_cast<std::uint32_t>(__builtin_ctz(bits));
                WideSlot& slot = slots_[i + lane];
                take_if_nearer(slot, hits.t[lane], hits.u[lane], hits.v[lane], number);
                shorten(slot);
                rays_.tmax[i + lane] = slot.tmax;
            }
        }
        for (std::uint32_t bits = found.special; bits; bits &= bits - 1) {
            WideSlot& slot = slots_[i + static_cast<std::uint32_t>(__builtin_ctz(bits))];
            if (query_.test(query_.owner, slot, leaf, 1u << k))
                rays_.tmax[i + static_cast<std::uint32_t>(__builtin_ctz(bits))] = slot.tmax;
        }
        return (found.hit | found.special) != 0;
    }

    const WideQuery& query_;
    const char* base_;
    WideSlot slots_[packet_size];
    PacketRays rays_;
    PacketInterval interval_;
    std::uint64_t all_ = 0;
    float longest_ = 0;
    std::uint32_t height_ = 0;
    Entry stack_[alhazen::wide_stack];
    WideStack alone_;
};

/// Traces n rays from the first on; false, and nothing is done, when they have too little in common.
inline bool trace_packet(const WideQuery& query, std::uint32_t first, std::uint32_t n) {
    PacketWalk walk(query);
    if (!walk.prepare(first, n)) return false;
    walk.run();
    return true;
}

} // namespace
