/// The test of a leaf's triangles.
#pragma once

#include "accel/wide/kernel_boxes.h"

namespace {

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

/// What came of it, a lane each.
struct Candidates {
    std::uint32_t hit = 0;     ///< bits of those that are met at 0 < t < tmax
    std::uint32_t special = 0; ///< of those for which the exact test must be asked
    F t, u, v;
};

/// The edge functions of Woop, Benthin and Wald, in the same operations as in intersect_triangle, so that
/// they come out the same, bit by bit. Rare cases are left to that function: edges that are met exactly,
/// which it decides in double precision, and distances no larger than their error. Lanes are triangles, or
/// rays; those whose bits are not set are not looked at. False when nothing can be met.
ALHAZEN_INLINE bool test_corners(const Corner& a, const Corner& b, const Corner& c, F sz, F tmax,
                                 std::uint32_t lanes, Candidates& found) {
    auto edge = [](const Corner& p, const Corner& q) __attribute__((always_inline)) {
        return Lanes::sub(Lanes::mul(p.x, q.y), Lanes::mul(p.y, q.x));
    };
    const F ea = edge(b, c), eb = edge(c, a), ec = edge(a, b);
    const F zero = Lanes::all(0);
    const F least = Lanes::min(Lanes::min(ea, eb), ec), most = Lanes::max(Lanes::max(ea, eb), ec);
    const std::uint32_t bits = (Lanes::at_most(zero, least) | Lanes::at_most(most, zero)) & lanes;
    if (bits == 0) return false;

    const F determinant = Lanes::add(Lanes::add(ea, eb), ec);
    const F inverse = Lanes::divide(Lanes::all(1), determinant);
    const F sum =
        Lanes::add(Lanes::add(Lanes::mul(ea, Lanes::mul(a.z, sz)), Lanes::mul(eb, Lanes::mul(b.z, sz))),
                   Lanes::mul(ec, Lanes::mul(c.z, sz)));
    const F largest_edge = Lanes::max(Lanes::magnitude(least), Lanes::magnitude(most));
    const F error = error_of_distance(a, b, c, sz, largest_edge);
    const std::uint32_t edge_is_met = Lanes::zero_or_nan(Lanes::mul(Lanes::mul(ea, eb), ec));
    const std::uint32_t is_certain = Lanes::below(error, Lanes::magnitude(sum)) & ~edge_is_met &
                                     Lanes::below(Lanes::magnitude(inverse), Lanes::all(largest_float));
    found.t = Lanes::mul(sum, inverse);
    found.special = bits & ~is_certain;
    found.hit = bits & is_certain & Lanes::below(zero, found.t) & Lanes::below(found.t, tmax);
    found.u = Lanes::mul(eb, inverse);
    found.v = Lanes::mul(ec, inverse);
    return true;
}

/// One ray, and a leaf's n triangles.
ALHAZEN_INLINE bool test_triangles(const WideSlot& slot, const float* leaf, std::uint32_t n,
                                   Candidates& found) {
    const std::size_t x = slot.axis[0] * n, y = slot.axis[1] * n, z = slot.axis[2] * n;
    const F ox = Lanes::all(slot.origin[0]), oy = Lanes::all(slot.origin[1]), oz = Lanes::all(slot.origin[2]);
    const F sx = Lanes::all(slot.shear[0]), sy = Lanes::all(slot.shear[1]);
    auto corner = [&](const float* p) __attribute__((always_inline)) {
        const F qz = Lanes::sub(Lanes::load(p + z), oz);
        return Corner{Lanes::sub(Lanes::sub(Lanes::load(p + x), ox), Lanes::mul(sx, qz)),
                      Lanes::sub(Lanes::sub(Lanes::load(p + y), oy), Lanes::mul(sy, qz)), qz};
    };
    const std::size_t next = std::size_t{3} * n;
    return test_corners(corner(leaf), corner(leaf + next), corner(leaf + 2 * next), Lanes::all(slot.shear[2]),
                        Lanes::all(slot.tmax), (1u << n) - 1, found);
}

/// Of candidates whose distance is in doubt, those that are met at t < 0 for certain: the triangle that a ray
/// has just left, mostly. The plane's side follows from the corners as they are, whose differences are exact
/// but for their last digit; x y z and a b c may change places without changing it.
[[gnu::noinline]] std::uint32_t surely_behind(const WideRay& ray, const float* leaf, std::uint32_t n) {
    struct Along {
        F from_a, ab, ac, d; ///< from the origin to a, and so on
    };
    auto along = [&](std::size_t axis) __attribute__((always_inline)) {
        const F a = Lanes::load(leaf + axis * n), b = Lanes::load(leaf + (axis + 3) * n),
                c = Lanes::load(leaf + (axis + 6) * n);
        return Along{Lanes::sub(a, Lanes::all(ray.o[axis])), Lanes::sub(b, a), Lanes::sub(c, a),
                     Lanes::all(ray.d[axis])};
    };
    const Along x = along(0), y = along(1), z = along(2);
    // Smaller numbers lose digits.
    const F least = Lanes::all(0x1p-126f);
    // n . (a - o) and n . d, with n = ab x ac, and the sums of all products' sizes.
    F distance = Lanes::all(0), speed = distance, distance_size = distance, speed_size = distance;
    auto add = [&](const Along& p, const Along& q, const Along& r) __attribute__((always_inline)) {
        const F left = Lanes::mul(p.ab, q.ac), right = Lanes::mul(q.ab, p.ac);
        const F normal = Lanes::sub(left, right),
                size = Lanes::add(Lanes::add(Lanes::magnitude(left), Lanes::magnitude(right)), least);
        distance = Lanes::add(distance, Lanes::mul(normal, r.from_a));
        speed = Lanes::add(speed, Lanes::mul(normal, r.d));
        distance_size = Lanes::add(distance_size, Lanes::mul(size, Lanes::magnitude(r.from_a)));
        speed_size = Lanes::add(speed_size, Lanes::mul(size, Lanes::magnitude(r.d)));
    };
    add(x, y, z);
    add(y, z, x);
    add(z, x, y);
    // Eight roundings of each product, at most.
    const F error = Lanes::all(0x1p-20f);
    auto is_certain = [&](F value, F size) __attribute__((always_inline)) {
        return Lanes::below(Lanes::add(Lanes::mul(size, error), least), Lanes::magnitude(value));
    };
    return is_certain(distance, distance_size) & is_certain(speed, speed_size) &
           Lanes::below(Lanes::times_sign(distance, speed), Lanes::all(0));
}

/// Takes a hit if it is nearer than the one so far, or as near with a lower number.
ALHAZEN_INLINE void take_if_nearer(WideSlot& slot, float t, float u, float v, std::uint32_t number) {
    const bool is_nearer = t < slot.t || (t == slot.t && number < slot.primitive);
    if (!is_nearer) return;
    slot.t = t;
    slot.u = u;
    slot.v = v;
    slot.primitive = number;
}

/// Where the search goes on to: one step beyond the nearest hit, so that a hit at the same distance is still
/// found.
ALHAZEN_INLINE float one_step_beyond(float t) {
    std::uint32_t bits;
    __builtin_memcpy(&bits, &t, sizeof bits);
    ++bits;
    __builtin_memcpy(&t, &bits, sizeof t);
    return t;
}

/// The hits' numbers, lane by lane.
struct HitLanes {
    alignas(32) float t[8], u[8], v[8];

    ALHAZEN_INLINE explicit HitLanes(const Candidates& found) {
        Lanes::store(t, found.t);
        Lanes::store(u, found.u);
        Lanes::store(v, found.v);
    }
};

ALHAZEN_INLINE void take_nearest(WideSlot& slot, const Candidates& found, const std::uint32_t* numbers) {
    const HitLanes lanes(found);
    for (std::uint32_t bits = found.hit; bits; bits &= bits - 1) {
        const auto i = static_cast<std::uint32_t>(__builtin_ctz(bits));
        take_if_nearer(slot, lanes.t[i], lanes.u[i], lanes.v[i], numbers[i]);
    }
    slot.tmax = one_step_beyond(slot.t);
}

/// Hits of filtered triangles are for the callback as well.
ALHAZEN_INLINE void set_filtered_aside(Candidates& found, const std::uint32_t* numbers) {
    for (std::uint32_t bits = found.hit; bits; bits &= bits - 1) {
        const auto i = static_cast<std::uint32_t>(__builtin_ctz(bits));
        if (numbers[i] & alhazen::wide_filtered) found.hit ^= 1u << i, found.special |= 1u << i;
    }
}

/// Tests a leaf; true when the nearest hit has changed, or, for any, when there is a hit.
template <bool any>
ALHAZEN_INLINE bool visit_leaf(const WideQuery& query, const char* base, WideSlot& slot, std::uint32_t leaf) {
    const auto* corners = reinterpret_cast<const float*>(base + (leaf & alhazen::wide_address));
    std::uint32_t n = ((leaf >> alhazen::wide_count_shift) & 7) + 1;
    const bool is_other = leaf & alhazen::wide_other;
    if (is_other) [[unlikely]] {
        std::uint32_t word;
        __builtin_memcpy(&word, corners++, sizeof word);
        if (!(word & alhazen::wide_filtered)) return query.test(query.owner, slot, leaf, 0xff);
        n = word & 0xff;
    }
    const auto* numbers = reinterpret_cast<const std::uint32_t*>(corners + std::size_t{9} * n);
    Candidates found;
    if (!test_triangles(slot, corners, n, found)) return false;
    if (is_other) [[unlikely]]
        set_filtered_aside(found, numbers);
    if (found.hit) {
        if constexpr (any) return true;
        take_nearest(slot, found, numbers);
    }
    bool has_changed = found.hit != 0;
    if (found.special) [[unlikely]] {
        found.special &= ~surely_behind(query.rays[slot.ray], corners, n);
        if (found.special) has_changed |= query.test(query.owner, slot, leaf, found.special);
    }
    return has_changed;
}

} // namespace
