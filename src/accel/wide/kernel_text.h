/// The kernels of the production structure, once for every instruction set: a file that includes this has
/// defined Lanes before (eight floats).
///
/// A ray waits most of its time: for memory, and for mispredicted branches. So a thread keeps many rays in
/// flight. They take turns: a ray advances by one node, says which memory it needs next, and goes to the back
/// of the ring; until it is its turn again the memory has arrived. The step through a node has no branch: the
/// children that are hit are compressed onto the ray's own stack, and the top is taken off again, with a
/// sentinel at the bottom. Rays that have come to a leaf wait in a list, and are served together when few are
/// left in the ring. (The idea of hiding latency with several rays a thread: Guthe 2014; sorting children by
/// octant: Ylitie, Karras and Laine 2017; the schedule is our own.)
#pragma once

namespace {

using F = Lanes::F;
using alhazen::WideNode;
using alhazen::WideQuery;
using alhazen::WideRay;
using alhazen::WideSlot;

enum : std::uint32_t {
    rays_in_flight = 16,
    rays_left = 4,      // on the way through nodes, when leaves are served
    ring_size = 64,     // a power of two above all rays in flight
    prefetched = 4 * 64 // bytes of a node, or of the beginning of a leaf
};

constexpr std::uint32_t no_hit = 0xffffffffu;
constexpr float largest_float = 0x1.fffffep127f;

#define ALHAZEN_INLINE __attribute__((always_inline)) inline

ALHAZEN_INLINE const char* address(const WideQuery& query, std::uint32_t reference) {
    return query.base + static_cast<std::size_t>(reference & alhazen::wide_address) * alhazen::wide_unit;
}

struct Interval {
    F entry, exit;
};

/// Where the ray enters and leaves the boxes of the node's children.
ALHAZEN_INLINE Interval test_boxes(const WideSlot& slot, const char* node) {
    auto planes = [&](std::size_t axis, std::uint32_t other) {
        return Lanes::load(reinterpret_cast<const float*>(node + (slot.near_plane[axis] ^ other)));
    };
    auto enter = [&](std::size_t axis) {
        return Lanes::scale(planes(axis, 0), Lanes::all(slot.enter_scale[axis]),
                            Lanes::all(slot.enter_offset[axis]));
    };
    auto leave = [&](std::size_t axis) {
        return Lanes::scale(planes(axis, 32), Lanes::all(slot.leave_scale[axis]),
                            Lanes::all(slot.leave_offset[axis]));
    };
    return {Lanes::max(Lanes::max(enter(0), enter(1)), Lanes::max(enter(2), Lanes::all(0))),
            Lanes::min(Lanes::min(leave(0), leave(1)), Lanes::min(leave(2), Lanes::all(slot.tmax)))};
}

ALHAZEN_INLINE std::uint32_t order_of(const WideSlot& slot, const char* node) {
    std::uint32_t order;
    __builtin_memcpy(&order, node + slot.order, sizeof order);
    return order;
}

/// Visits a node: pushes the children that are hit, the nearest last, and takes the last off again.
template <bool any>
ALHAZEN_INLINE std::uint32_t step(WideSlot& slot, const char* at) {
    const auto* node = reinterpret_cast<const WideNode*>(at);
    const Interval t = test_boxes(slot, at);
    std::uint32_t height = slot.height;
    if constexpr (any)
        height += Lanes::push(t.entry, t.exit, node->child, slot.reference + height);
    else
        height += Lanes::push_in_order(t.entry, t.exit, node->child, order_of(slot, at), slot.is_reversed,
                                       slot.reference + height, slot.entry + height);
    slot.height = --height;
    return slot.reference[height];
}

/// A corner of eight triangles, seen from the ray's origin and sheared so that the ray is the z axis.
struct Corner {
    F x, y, z;
};

/// The bound of t's error in intersect_triangle, times the determinant: where t is no larger than that, the
/// exact test computes it anew.
ALHAZEN_INLINE F error_of_distance(const Corner& a, const Corner& b, const Corner& c, F sz, F largest_edge) {
    auto largest = [](F p, F q, F r) {
        return Lanes::max(Lanes::max(Lanes::magnitude(p), Lanes::magnitude(q)), Lanes::magnitude(r));
    };
    // 2^-24, and a little for the rounding of this.
    constexpr float unit = 0x1.02p-24f;
    const F x = largest(a.x, b.x, c.x), y = largest(a.y, b.y, c.y),
            z = Lanes::mul(largest(a.z, b.z, c.z), Lanes::magnitude(sz));
    const F x_error = Lanes::add(x, z), y_error = Lanes::add(y, z); // in 5 units
    const F cross = Lanes::add(Lanes::mul(y_error, x), Lanes::mul(x_error, y));
    const F edge_error = Lanes::add(Lanes::mul(Lanes::all(4 * unit), Lanes::mul(x, y)),
                                    Lanes::mul(Lanes::all(10 * unit), cross));
    const F product =
        Lanes::mul(largest_edge, z); // counted three times for its rounding, three for that of z
    return Lanes::add(Lanes::mul(Lanes::all(18 * unit), product),
                      Lanes::mul(Lanes::all(3), Lanes::mul(edge_error, z)));
}

/// What a leaf's triangles have to say.
struct Candidates {
    std::uint32_t hit = 0;     ///< bits of those that are met at 0 < t < tmax
    std::uint32_t special = 0; ///< of those for which the exact test must be asked
    float t[8], u[8], v[8];    ///< of those that are met
};

/// The edge functions of Woop, Benthin and Wald, in the same operations as in intersect_triangle, so that
/// they come out the same, bit by bit. Rare cases are left to that function: edges that are met exactly,
/// which it decides in double precision, and distances no larger than their error.
ALHAZEN_INLINE Candidates test_triangles(const WideSlot& slot, const float* leaf, std::uint32_t n) {
    const std::size_t x = slot.axis[0] * n, y = slot.axis[1] * n, z = slot.axis[2] * n;
    const F ox = Lanes::all(slot.origin[slot.axis[0]]), oy = Lanes::all(slot.origin[slot.axis[1]]),
            oz = Lanes::all(slot.origin[slot.axis[2]]);
    const F sx = Lanes::all(slot.shear[0]), sy = Lanes::all(slot.shear[1]);
    auto corner = [&](const float* p) {
        const F qz = Lanes::sub(Lanes::load(p + z), oz);
        return Corner{Lanes::sub(Lanes::sub(Lanes::load(p + x), ox), Lanes::mul(sx, qz)),
                      Lanes::sub(Lanes::sub(Lanes::load(p + y), oy), Lanes::mul(sy, qz)), qz};
    };
    auto edge = [](const Corner& p, const Corner& q) {
        return Lanes::sub(Lanes::mul(p.x, q.y), Lanes::mul(p.y, q.x));
    };
    const Corner a = corner(leaf), b = corner(leaf + std::size_t{3} * n),
                 c = corner(leaf + std::size_t{6} * n);
    const F ea = edge(b, c), eb = edge(c, a), ec = edge(a, b);
    const F zero = Lanes::all(0);
    const F least = Lanes::min(Lanes::min(ea, eb), ec), most = Lanes::max(Lanes::max(ea, eb), ec);
    const std::uint32_t edge_is_met = Lanes::zero_or_nan(Lanes::mul(Lanes::mul(ea, eb), ec));
    const std::uint32_t bits =
        (Lanes::at_most(zero, least) | Lanes::at_most(most, zero) | edge_is_met) & ((1u << n) - 1);
    if (bits == 0) return {};

    // From here on as in intersect_triangle, again in the same operations.
    const F sz = Lanes::all(slot.shear[2]);
    const F determinant = Lanes::add(Lanes::add(ea, eb), ec);
    const F inverse = Lanes::divide(Lanes::all(1), determinant);
    const F sum =
        Lanes::add(Lanes::add(Lanes::mul(ea, Lanes::mul(a.z, sz)), Lanes::mul(eb, Lanes::mul(b.z, sz))),
                   Lanes::mul(ec, Lanes::mul(c.z, sz)));
    const F largest_edge = Lanes::max(Lanes::magnitude(least), Lanes::magnitude(most));
    const F error = error_of_distance(a, b, c, sz, largest_edge);
    const F t = Lanes::mul(sum, inverse);
    Candidates found;
    found.special = bits & (edge_is_met | ~Lanes::below(error, Lanes::magnitude(sum)) |
                            ~Lanes::below(Lanes::magnitude(inverse), Lanes::all(largest_float)));
    found.hit = bits & ~found.special & Lanes::below(zero, t) & Lanes::below(t, Lanes::all(slot.tmax));
    if (found.hit) {
        Lanes::store(found.t, t);
        Lanes::store(found.u, Lanes::mul(eb, inverse));
        Lanes::store(found.v, Lanes::mul(ec, inverse));
    }
    return found;
}

ALHAZEN_INLINE std::uint32_t count_of(std::uint32_t leaf) {
    return ((leaf >> alhazen::wide_count_shift) & 7) + 1;
}

/// Takes the nearest of the hits, and of those at the same distance the one with the lowest number.
ALHAZEN_INLINE void take_nearest(WideSlot& slot, const Candidates& found, const std::uint32_t* numbers) {
    for (std::uint32_t bits = found.hit; bits; bits &= bits - 1) {
        const auto i = static_cast<std::uint32_t>(__builtin_ctz(bits));
        const bool is_nearer = found.t[i] < slot.t || (found.t[i] == slot.t && numbers[i] < slot.primitive);
        if (!is_nearer) continue;
        slot.t = found.t[i];
        slot.u = found.u[i];
        slot.v = found.v[i];
        slot.primitive = numbers[i];
    }
    // One step more, so that a hit at the same distance is still found.
    std::uint32_t step_more;
    __builtin_memcpy(&step_more, &slot.t, sizeof step_more);
    ++step_more;
    __builtin_memcpy(&slot.tmax, &step_more, sizeof step_more);
}

/// Tests a leaf; true when the nearest hit has changed.
template <bool any>
ALHAZEN_INLINE bool visit_leaf(const WideQuery& query, WideSlot& slot, std::uint32_t leaf) {
    if (leaf & alhazen::wide_custom) [[unlikely]]
        return query.test(query.owner, slot, leaf, 0xff);
    const std::uint32_t n = count_of(leaf);
    const auto* corners = reinterpret_cast<const float*>(address(query, leaf));
    const auto* numbers = reinterpret_cast<const std::uint32_t*>(corners + std::size_t{9} * n);
    Candidates found = test_triangles(slot, corners, n);
    for (std::uint32_t bits = found.hit; bits; bits &= bits - 1) {
        const auto i = static_cast<std::uint32_t>(__builtin_ctz(bits));
        if (numbers[i] & alhazen::wide_filtered) [[unlikely]]
            found.hit ^= 1u << i, found.special |= 1u << i;
    }
    if (found.hit) {
        take_nearest(slot, found, numbers);
        if (any) return true;
    }
    bool has_changed = found.hit != 0;
    if (found.special) [[unlikely]]
        has_changed |= query.test(query.owner, slot, leaf, found.special);
    return has_changed;
}

ALHAZEN_INLINE void prefetch(const WideQuery& query, std::uint32_t reference) {
    const char* p = address(query, reference);
    for (std::size_t line = 0; line < prefetched; line += 64) Lanes::prefetch(p + line);
}

using F4 = float __attribute__((vector_size(16)));
using I4 = int __attribute__((vector_size(16)));

ALHAZEN_INLINE F4 with_sign(F4 v, I4 sign) {
    return reinterpret_cast<F4>(reinterpret_cast<I4>(v) ^ sign);
}
ALHAZEN_INLINE float largest_of(F4 v) {
    const float xy = v[0] > v[1] ? v[0] : v[1];
    return xy > v[2] ? xy : v[2];
}
ALHAZEN_INLINE void store(float* to, F4 v) {
    __builtin_memcpy(to, &v, sizeof v);
}

/// What RayShear holds, in the same operations.
ALHAZEN_INLINE void set_shear(WideSlot& slot, const WideRay& ray, F4 speed) {
    const std::uint32_t y_or_x = 1 - static_cast<std::uint32_t>(speed[0] > speed[1]);
    const float longer = speed[0] > speed[1] ? speed[0] : speed[1];
    const std::uint32_t z = longer > speed[2] ? y_or_x : 2;
    const std::uint32_t x = z == 2 ? 0 : z + 1, y = z == 0 ? 2 : z - 1;
    const F4 length = F4{} + ray.d[z];
    const F4 shear = F4{ray.d[x], ray.d[y], 1, 1} / length;
    slot.shear[0] = shear[0];
    slot.shear[1] = shear[1];
    slot.shear[2] = shear[2];
    slot.axis[0] = x;
    slot.axis[1] = y;
    slot.axis[2] = z;
}

/// What BoxRay holds; see there. The reach is taken from all axes, for simplicity.
ALHAZEN_INLINE void set_scales(WideSlot& slot, F4 o, F4 d, F4 speed, float extent) {
    constexpr float unit = 0x1p-24f;
    const I4 sign = reinterpret_cast<I4>(d) & static_cast<int>(0x80000000u);
    const F4 size = reinterpret_cast<F4>(reinterpret_cast<I4>(o) & 0x7fffffff);
    const float longest = largest_of(speed), farthest = largest_of(size);
    const F4 spread = F4{} + 16 * unit * longest;
    const F4 steady_pad = F4{} + 32 * unit * (farthest + extent);
    const F4 pad = 4 * unit * size + (speed < 4 * spread ? steady_pad : F4{});
    const F4 slow = speed - spread;
    const F4 backward = with_sign(pad, sign);
    F4 enter = with_sign(1 / (speed + spread), sign);
    F4 leave = with_sign(1 / (slow > spread ? slow : spread), sign);
    F4 leave_offset = (o - backward) * leave;
    // Here products overflow: all boxes are visited. No scene has such rays.
    if (!(longest > 0x1p-60f && longest < 0x1p+60f && farthest < 0x1p+60f && extent < 0x1p+60f))
        [[unlikely]] {
        enter = leave = F4{};
        leave_offset = F4{} - largest_float;
    }
    store(slot.enter_scale, enter);
    store(slot.leave_scale, leave);
    store(slot.enter_offset, (o + backward) * enter);
    store(slot.leave_offset, leave_offset);
    // Orders are for octants that go forwards in x; the others read them from the end.
    const I4 side = (sign >> 31) & 1;
    const auto x = static_cast<std::uint32_t>(side[0]), y = static_cast<std::uint32_t>(side[1]),
               z = static_cast<std::uint32_t>(side[2]);
    slot.near_plane[0] = 32 * x;
    slot.near_plane[1] = 64 + 32 * y;
    slot.near_plane[2] = 128 + 32 * z;
    slot.order = static_cast<std::uint32_t>(offsetof(WideNode, order)) + 3 * ((x ^ y) + 2 * (x ^ z));
    slot.is_reversed = x;
}

/// Whether the ray can hit anything: see is_traceable.
ALHAZEN_INLINE bool is_traceable(const WideRay& ray) {
    const float all = (ray.o[0] - ray.o[0]) + (ray.o[1] - ray.o[1]) + (ray.o[2] - ray.o[2]) +
                      (ray.d[0] - ray.d[0]) + (ray.d[1] - ray.d[1]) + (ray.d[2] - ray.d[2]);
    return all == 0 && (ray.d[0] != 0 || ray.d[1] != 0 || ray.d[2] != 0) && ray.tmax > 0;
}

/// Prepares the slot for a ray; false when the ray can hit nothing.
ALHAZEN_INLINE bool begin(const WideQuery& query, WideSlot& slot, std::uint32_t number) {
    const WideRay& ray = query.rays[number];
    if (!is_traceable(ray)) [[unlikely]]
        return false;
    const F4 o = {ray.o[0], ray.o[1], ray.o[2], 0}, d = {ray.d[0], ray.d[1], ray.d[2], 0};
    const F4 speed = reinterpret_cast<F4>(reinterpret_cast<I4>(d) & 0x7fffffff);
    set_scales(slot, o, d, speed, query.extent);
    set_shear(slot, ray, speed);
    for (std::size_t axis = 0; axis < 3; ++axis) slot.origin[axis] = ray.o[axis];
    slot.tmax = ray.tmax;
    slot.ray = number;
    slot.t = __builtin_inff();
    slot.primitive = no_hit;
    slot.reference[0] = alhazen::wide_done;
    slot.entry[0] = -__builtin_inff();
    slot.height = 1;
    slot.next = query.root;
    return true;
}

template <bool any>
ALHAZEN_INLINE void finish(const WideQuery& query, const WideSlot& slot) {
    if (slot.primitive == no_hit) return;
    if constexpr (any)
        query.blocked[slot.ray] = 1;
    else
        query.hits[slot.ray] = {slot.t, slot.u, slot.v, slot.primitive, 0};
}

/// Numbers of slots, in the order of their turns. (Of 16 bits: bytes may be anything to the compiler, which
/// would have to read the slots anew after each.)
struct Ring {
    std::uint16_t entry[ring_size];
    std::uint32_t first = 0, last = 0;

    ALHAZEN_INLINE std::uint32_t size() const { return last - first; }
    ALHAZEN_INLINE std::uint32_t take() { return entry[first++ % ring_size]; }
    /// At the end, if so (0 or 1).
    ALHAZEN_INLINE void put(std::uint32_t slot, std::uint32_t is_put) {
        entry[last % ring_size] = static_cast<std::uint16_t>(slot);
        last += is_put;
    }
};

template <bool any>
void trace_interleaved(const WideQuery& query) {
    WideSlot slots[rays_in_flight];
    Ring moving, at_leaf;
    std::uint32_t next_ray = 0;
    // Without a branch, since where a ray comes to cannot be foreseen.
    auto route = [&](std::uint32_t i, std::uint32_t reference) __attribute__((always_inline)) {
        slots[i].next = reference;
        prefetch(query, reference);
        const std::uint32_t is_leaf = reference >> 31;
        moving.put(i, 1 - is_leaf);
        at_leaf.put(i, is_leaf);
    };
    auto admit = [&](std::uint32_t i) {
        while (next_ray < query.count) {
            if (begin(query, slots[i], next_ray++)) return route(i, query.root);
        }
    };
    for (std::uint32_t i = 0; i < rays_in_flight; ++i) admit(i);
    for (;;) {
        while (moving.size() > rays_left || (at_leaf.size() == 0 && moving.size() > 0)) {
            const std::uint32_t i = moving.take();
            route(i, step<any>(slots[i], address(query, slots[i].next)));
        }
        if (at_leaf.size() == 0) return;
        for (std::uint32_t n = at_leaf.size(); n > 0; --n) {
            const std::uint32_t i = at_leaf.take();
            WideSlot& slot = slots[i];
            bool is_done = slot.next == alhazen::wide_done;
            if (!is_done && visit_leaf<any>(query, slot, slot.next)) {
                is_done = any;
                if constexpr (!any)
                    slot.height = Lanes::drop_beyond(slot.tmax, slot.height, slot.reference, slot.entry);
            }
            if (is_done) {
                finish<any>(query, slot);
                admit(i);
            } else {
                route(i, slot.reference[--slot.height]);
            }
        }
    }
}

/// From a node down to the next leaf, or to the end. Here branches pay: most rays hit no child or one.
template <bool any, bool counted>
ALHAZEN_INLINE std::uint32_t descend(const WideQuery& query, WideSlot& slot, std::uint32_t reference) {
    while (!(reference & alhazen::wide_leaf)) {
        const char* at = address(query, reference);
        const auto* node = reinterpret_cast<const WideNode*>(at);
        if (counted) ++slot.nodes;
        const Interval t = test_boxes(slot, at);
        const std::uint32_t hits = Lanes::at_most(t.entry, t.exit);
        if (hits == 0) {
            reference = slot.reference[--slot.height];
            continue;
        }
        const std::uint32_t more = hits & (hits - 1);
        const auto one = static_cast<std::uint32_t>(__builtin_ctz(hits));
        if (more == 0) {
            reference = node->child[one];
            continue;
        }
        if (!any && (more & (more - 1)) == 0) {
            const auto two = static_cast<std::uint32_t>(__builtin_ctz(more));
            const float t1 = Lanes::lane(t.entry, one), t2 = Lanes::lane(t.entry, two);
            const std::uint32_t c1 = node->child[one], c2 = node->child[two];
            const bool swapped = t2 < t1;
            slot.reference[slot.height] = swapped ? c1 : c2;
            slot.entry[slot.height++] = swapped ? t1 : t2;
            reference = swapped ? c2 : c1;
            continue;
        }
        if constexpr (any)
            slot.height += Lanes::push(t.entry, t.exit, node->child, slot.reference + slot.height);
        else
            slot.height +=
                Lanes::push_in_order(t.entry, t.exit, node->child, order_of(slot, at), slot.is_reversed,
                                     slot.reference + slot.height, slot.entry + slot.height);
        if (counted && slot.height > slot.highest) slot.highest = slot.height;
        reference = slot.reference[--slot.height];
    }
    return reference;
}

template <bool any, bool counted>
void trace_in_turn(const WideQuery& query) {
    WideSlot slot;
    for (std::uint32_t ray = 0; ray < query.count; ++ray) {
        if (!begin(query, slot, ray)) continue;
        if (counted) slot.nodes = slot.leaves = slot.highest = 0;
        std::uint32_t reference = query.root;
        for (;;) {
            reference = descend<any, counted>(query, slot, reference);
            if (reference == alhazen::wide_done) break;
            if (counted) ++slot.leaves;
            if (visit_leaf<any>(query, slot, reference)) {
                if (any) break;
                slot.height = Lanes::drop_beyond(slot.tmax, slot.height, slot.reference, slot.entry);
            }
            reference = slot.reference[--slot.height];
        }
        finish<any>(query, slot);
        if (counted) query.count_visits(query.owner, slot);
    }
}

constexpr alhazen::WideKernels make_kernels(const char* name, bool (*is_supported)()) {
    return {name,
            is_supported,
            trace_interleaved<false>,
            trace_interleaved<true>,
            trace_in_turn<false, false>,
            trace_in_turn<true, false>,
            trace_in_turn<false, true>,
            trace_in_turn<true, true>};
}

} // namespace
