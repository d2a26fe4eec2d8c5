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

/// What tests of eight rays at a time read, and what they found; see WideRay and WideSlot.
struct alignas(64) PacketRays {
    using Lane = float[packet_size];

    Lane o[3], d[3];
    Lane tmax; ///< where the search ends by now; negative: no ray
    Lane enter_scale[3], enter_offset[3], leave_scale[3], leave_offset[3];
    Lane shear[3];
    Lane t, u, v;
    std::uint32_t primitive[packet_size];

    ALHAZEN_INLINE void set(std::uint32_t i, const WideRay& ray) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            o[axis][i] = ray.o[axis];
            d[axis][i] = ray.d[axis];
        }
        tmax[i] = ray.tmax;
        t[i] = __builtin_inff();
        primitive[i] = no_hit;
    }
    ALHAZEN_INLINE bool is_nearer(std::uint32_t i, float distance, std::uint32_t number) const {
        return distance < t[i] || (distance == t[i] && number < primitive[i]);
    }
};

/// The least and the largest of a packet's numbers.
struct Extent {
    float least, most;

    ALHAZEN_INLINE explicit Extent(const float* values) {
        F low = Lanes::load(values), high = low;
        for (std::size_t i = 8; i < packet_size; i += 8) {
            low = Lanes::min(low, Lanes::load(values + i));
            high = Lanes::max(high, Lanes::load(values + i));
        }
        float lows[8], highs[8];
        Lanes::store(lows, low);
        Lanes::store(highs, high);
        least = lows[0], most = highs[0];
        for (int i = 1; i < 8; ++i) {
            least = lows[i] < least ? lows[i] : least;
            most = highs[i] > most ? highs[i] : most;
        }
    }
    ALHAZEN_INLINE float magnitude() const {
        const float a = __builtin_fabsf(least), b = __builtin_fabsf(most);
        return a > b ? a : b;
    }
};

class PacketWalk {
  public:
    ALHAZEN_INLINE explicit PacketWalk(const WideQuery& query) : query_(query), base_(query.base) {}

    /// False when the rays have too little in common.
    bool prepare(std::uint32_t first, std::uint32_t n) {
        first_ = first;
        // The first ray tells what is common to all.
        if (!begin(query_, slots_[0], first)) return false;
        begun_ = 1;
        all_ = n == packet_size ? ~std::uint64_t{0} : (std::uint64_t{1} << n) - 1;
        for (std::uint32_t i = 0; i < packet_size; ++i) rays_.set(i, query_.rays[first + (i < n ? i : 0)]);
        if (!have_common_signs()) return false;
        for (std::uint32_t i = n; i < packet_size; ++i) rays_.tmax[i] = -1;
        for (std::size_t i = 0; i < packet_size; i += 8) set_scales(i);
        return set_interval();
    }

    void run() {
        push(query_.root, 0, all_);
        set_longest();
        while (height_ > 0) {
            const Entry e = stack_[--height_];
            if (e.t > longest_) continue;
            if (static_cast<std::uint32_t>(__builtin_popcountll(e.rays)) <= rays_alone)
                go_on_alone(e);
            else if (e.reference & alhazen::wide_leaf)
                visit(e);
            else
                descend(e);
        }
        for (std::uint64_t rays = all_; rays; rays &= rays - 1) {
            const auto i = static_cast<std::uint32_t>(__builtin_ctzll(rays));
            if (rays_.primitive[i] == no_hit) continue;
            query_.hits[first_ + i] = {rays_.t[i], rays_.u[i], rays_.v[i], rays_.primitive[i], 0};
        }
    }

  private:
    struct Entry {
        std::uint64_t rays; ///< that meet it, a bit each
        std::uint32_t reference;
        float t; ///< no ray enters earlier
    };

    /// Whether all rays are as the first one is: finite, forwards or backwards along the same axes, nowhere
    /// slow, and longest along the same axis; the numbers are such that no product overflows.
    bool have_common_signs() const {
        const std::size_t longest = slots_[0].axis[2];
        F all = Lanes::all(0);
        std::uint32_t faults = 0;
        for (std::size_t i = 0; i < packet_size; i += 8) {
            const F most = Lanes::magnitude(Lanes::load(rays_.d[longest] + i));
            // Where a ray hardly moves along an axis, BoxRay has padding that an interval knows nothing of.
            const F still = Lanes::mul(most, Lanes::all(1e-5f));
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const F d = Lanes::load(rays_.d[axis] + i), o = Lanes::load(rays_.o[axis] + i);
                const float sign = is_forward(axis) ? 1.0f : -1.0f;
                faults |= ~Lanes::below(still, Lanes::mul(d, Lanes::all(sign)));
                if (axis != longest) faults |= ~Lanes::below(Lanes::magnitude(d), most);
                all = Lanes::add(all, Lanes::sub(o, o));
            }
            faults |= ~Lanes::below(Lanes::all(0x1p-60f), most) | ~Lanes::below(most, Lanes::all(0x1p+60f)) |
                      ~Lanes::below(Lanes::all(0), Lanes::load(rays_.tmax + i));
        }
        faults |= ~Lanes::at_most(all, Lanes::all(0));
        return (faults & 0xff) == 0 && query_.extent < 0x1p+60f;
    }

    /// What set_scales does for a ray that is nowhere slow, and set_shear.
    ALHAZEN_INLINE void set_scales(std::size_t i) {
        constexpr float unit = 0x1p-24f;
        const std::uint32_t* axes = slots_[0].axis;
        const F length = Lanes::load(rays_.d[axes[2]] + i);
        const F spread = Lanes::mul(Lanes::magnitude(length), Lanes::all(16 * unit));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const F o = Lanes::load(rays_.o[axis] + i), d = Lanes::load(rays_.d[axis] + i),
                    speed = Lanes::magnitude(d);
            const F pad =
                Lanes::mul(Lanes::magnitude(o), Lanes::all(is_forward(axis) ? 4 * unit : -4 * unit));
            const F one = Lanes::all(is_forward(axis) ? 1.0f : -1.0f);
            const F enter = Lanes::divide(one, Lanes::add(speed, spread)),
                    leave = Lanes::divide(one, Lanes::sub(speed, spread));
            Lanes::store(rays_.enter_scale[axis] + i, enter);
            Lanes::store(rays_.leave_scale[axis] + i, leave);
            Lanes::store(rays_.enter_offset[axis] + i, Lanes::mul(Lanes::add(o, pad), enter));
            Lanes::store(rays_.leave_offset[axis] + i, Lanes::mul(Lanes::sub(o, pad), leave));
        }
        for (std::size_t axis = 0; axis < 2; ++axis)
            Lanes::store(rays_.shear[axis] + i, Lanes::divide(Lanes::load(rays_.d[axes[axis]] + i), length));
        Lanes::store(rays_.shear[2] + i, Lanes::divide(Lanes::all(1), length));
    }

    /// False when the rays start too far apart: intervals would be wide.
    bool set_interval() {
        // Beside the padding of BoxRay, for the rounding of the interval's own products.
        constexpr float unit = 0x1p-24f, wider = 4 * unit;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const Extent o(rays_.o[axis]), enter(rays_.enter_scale[axis]), leave(rays_.leave_scale[axis]);
            if (!(o.most - o.least <= query_.extent / 64)) return false;
            const float pad = 8 * unit * o.magnitude();
            interval_.enter_origin[axis] = is_forward(axis) ? o.most + pad : o.least - pad;
            interval_.leave_origin[axis] = is_forward(axis) ? o.least - pad : o.most + pad;
            interval_.enter_low[axis] = enter.least - wider * enter.magnitude();
            interval_.enter_high[axis] = enter.most + wider * enter.magnitude();
            interval_.leave_low[axis] = leave.least - wider * leave.magnitude();
            interval_.leave_high[axis] = leave.most + wider * leave.magnitude();
        }
        return true;
    }

    ALHAZEN_INLINE bool is_forward(std::size_t axis) const { return slots_[0].near_plane[axis] == 64 * axis; }

    ALHAZEN_INLINE void push(std::uint32_t reference, float t, std::uint64_t rays) {
        stack_[height_++] = {rays, reference, t};
    }

    /// How far the farthest ray still goes.
    void set_longest() { longest_ = Extent(rays_.tmax).most; }

    /// Ray i for what takes one ray at a time.
    ALHAZEN_INLINE WideSlot& slot_of(std::uint32_t i) {
        WideSlot& slot = slots_[i];
        if (!((begun_ >> i) & 1)) {
            begin(query_, slot, first_ + i);
            begun_ |= std::uint64_t{1} << i;
        }
        slot.tmax = rays_.tmax[i];
        slot.t = rays_.t[i];
        slot.u = rays_.u[i];
        slot.v = rays_.v[i];
        slot.primitive = rays_.primitive[i];
        return slot;
    }
    /// What was found there.
    ALHAZEN_INLINE void take(std::uint32_t i) {
        const WideSlot& slot = slots_[i];
        rays_.tmax[i] = slot.tmax;
        rays_.t[i] = slot.t;
        rays_.u[i] = slot.u;
        rays_.v[i] = slot.v;
        rays_.primitive[i] = slot.primitive;
    }

    void go_on_alone(const Entry& e) {
        for (std::uint64_t rays = e.rays; rays; rays &= rays - 1) {
            const auto i = static_cast<std::uint32_t>(__builtin_ctzll(rays));
            if (!(e.t <= rays_.tmax[i])) continue;
            SingleWalk<false, false>(query_, slot_of(i), alone_).run(e.reference);
            take(i);
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
                if (visit_leaf<false>(query_, base_, slot_of(i), e.reference)) take(i);
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
        const std::uint32_t* axes = slots_[0].axis;
        const std::size_t x = axes[0] * n, y = axes[1] * n, z = axes[2] * n;
        auto ray = [&](const PacketRays::Lane(&of)[3], std::size_t axis) __attribute__((always_inline)) {
            return Lanes::load(of[axis] + i);
        };
        auto corner = [&](const float* p) __attribute__((always_inline)) {
            const F qz = Lanes::sub(Lanes::all(p[z]), ray(rays_.o, axes[2]));
            return Corner{Lanes::sub(Lanes::sub(Lanes::all(p[x]), ray(rays_.o, axes[0])),
                                     Lanes::mul(ray(rays_.shear, 0), qz)),
                          Lanes::sub(Lanes::sub(Lanes::all(p[y]), ray(rays_.o, axes[1])),
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
                const std::uint32_t r = i + lane;
                if (!rays_.is_nearer(r, hits.t[lane], number)) continue;
                rays_.t[r] = hits.t[lane];
                rays_.u[r] = hits.u[lane];
                rays_.v[r] = hits.v[lane];
                rays_.primitive[r] = number;
                rays_.tmax[r] = one_step_beyond(hits.t[lane]);
            }
        }
        for (std::uint32_t bits = found.special; bits; bits &= bits - 1) {
            const std::uint32_t r = i + static_cast<std::uint32_t>(__builtin_ctz(bits));
            if (query_.test(query_.owner, slot_of(r), leaf, 1u << k)) take(r);
        }
        return (found.hit | found.special) != 0;
    }

    const WideQuery& query_;
    const char* base_;
    WideSlot slots_[packet_size];
    PacketRays rays_;
    PacketInterval interval_;
    std::uint32_t first_ = 0; ///< number of the packet's first ray
    std::uint64_t all_ = 0;   ///< bits of the packet's rays
    std::uint64_t begun_ = 0; ///< of those whose slot is prepared
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
