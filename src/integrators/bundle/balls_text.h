/// Balls met by eight rays at a time, in the operations of shapes/ball.h, scene/ball_list.cpp and
/// shapes/sphere.cpp.
#pragma once

#include "base/lanes_text.h"
#include "integrators/bundle/kernel.h"

namespace {

struct RayLanes {
    Vector3 o, d;
};

/// A point of a ball's surface.
struct SurfaceLanes {
    Vector3 p, p_error, n, wo;
};

/// The balls in each lane.
struct BallLanes {
    Vector3d centre;
    Doubles radius, radius_squared;
    Floats side;
};

/// See smaller_positive_root.
ALHAZEN_INLINE Doubles smaller_positive_root(Doubles a, Doubles h, Doubles c, Doubles discriminant) {
    const Doubles q = absolute(h) + square_root(discriminant);
    const Longs outside = c > 0, towards = h < 0;
    const Doubles dividend = outside ? c : towards ? q : -c;
    const Doubles divisor = ~outside & towards ? a : q;
    return dividend / divisor;
}

/// See is_beyond in scene/ball_list.cpp.
ALHAZEN_INLINE Longs is_beyond(Doubles t, Doubles a, Doubles h, Doubles c, double r2) {
    const Doubles at2 = a * t * t, ht = 2.0 * h * t, f = at2 + ht + c;
    const Doubles rounding = 1e-14 * (at2 + absolute(ht) + absolute(c) + r2);
    return c < 0 ? f < -rounding : (f > rounding) & (a * t < -h);
}

/// Where rays pass, in single precision, which takes half the time.
struct Passing {
    Vector3 o, d;
    Floats inverse_a, rough;

    ALHAZEN_INLINE explicit Passing(const RayLanes& rays) : o(rays.o), d(rays.d) {
        const Floats a = inner(d, d);
        const Vector3 size = absolute(o);
        const Floats rounding = alhazen::bundle_rough * (size.x + size.y + size.z);
        inverse_a = 1 / a;
        // Of directions so short or long nothing is sure.
        rough = ((a > 0x1p-80f) & (a < 0x1p80f)) ? rounding : Floats{} + infinite;
    }
    /// The rays that pass a ball by, beyond doubt.
    ALHAZEN_INLINE Ints surely_miss(const alhazen::BundleBall& ball) const {
        const Vector3 from{o.x - ball.near_x, o.y - ball.near_y, o.z - ball.near_z};
        const Floats s = -inner(from, d) * inverse_a;
        const Vector3 miss{fused(d.x, s, from.x), fused(d.y, s, from.y), fused(d.z, s, from.z)};
        const Floats reach = ball.reach + rough;
        return inner(miss, miss) > reach * reach;
    }

  private:
    ALHAZEN_INLINE static Floats inner(const Vector3& a, const Vector3& b) {
        return fused(a.x, b.x, fused(a.y, b.y, a.z * b.z));
    }
};

/// Calls visit(ball, which lanes, t) for each of the balls (a bit each) that some of the lanes meet, not
/// beyond their limits; visit returns the lanes that are still to be asked about, and may bring limits
/// nearer.
template <class Visit>
ALHAZEN_INLINE void visit_met(const alhazen::BundleScene& scene, const RayLanes& rays, Ints asked,
                              std::uint64_t balls, const Doubles& limit, const Visit& visit) {
    const Vector3d o = widen(rays.o), d = widen(rays.d);
    const Doubles a = dot(d, d), inverse_a = 1.0 / a;
    // All balls first, so that no branch has to be foreseen between them.
    const Passing passing(rays);
    std::uint64_t near = 0;
    for (; balls; balls &= balls - 1) {
        const int i = __builtin_ctzll(balls);
        near |= std::uint64_t{any(asked & ~passing.surely_miss(scene.balls[i]))} << i;
    }
    for (; near; near &= near - 1) {
        const auto i = static_cast<std::uint32_t>(__builtin_ctzll(near));
        const alhazen::BundleBall& ball = scene.balls[i];
        const Vector3d from{o.x - ball.x, o.y - ball.y, o.z - ball.z};
        const Doubles h = dot(from, d), c = dot(from, from) - ball.radius_squared;
        Longs met = widen(asked) & ~((c > 0) & (h >= 0));
        if (!any(met)) continue;
        const Doubles s = h * inverse_a;
        const Vector3d miss = from - d * s;
        const Doubles above = ball.radius_squared - dot(miss, miss);
        met &= above >= 0;
        if (!any(met)) continue;
        met &= ~is_beyond(limit, a, h, c, ball.radius_squared);
        if (!any(met)) continue;
        asked = visit(i, narrow(met), narrow(smaller_positive_root(a, h, c, a * above)));
        if (!any(asked)) return;
    }
}

/// Which ball each ray meets first (-1: none), and where.
struct Nearest {
    Floats t;
    Ints ball;
};

ALHAZEN_INLINE Nearest find_closest(const alhazen::BundleScene& scene, const RayLanes& rays, Ints active) {
    Nearest hit{Floats{} + infinite, Ints{} - 1};
    Ints primitive{};
    Doubles limit = widen(hit.t);
    visit_met(scene, rays, active, scene.all_balls, limit, [&](std::uint32_t i, Ints met, Floats t) {
        const auto number = static_cast<std::int32_t>(scene.balls[i].primitive);
        const Ints nearer =
            met & ((t < hit.t) | ((t == hit.t) & (number < primitive))) & (t > 0) & (t < infinite);
        hit.t = nearer ? t : hit.t;
        hit.ball = nearer ? Ints{} + static_cast<std::int32_t>(i) : hit.ball;
        primitive = nearer ? Ints{} + number : primitive;
        limit = widen(next_above(hit.t));
        return active;
    });
    return hit;
}

/// Where one of the balls (a bit each) stands in the way before tmax.
ALHAZEN_INLINE Ints find_any(const alhazen::BundleScene& scene, const RayLanes& rays, Ints active,
                             std::uint64_t balls, float tmax) {
    Ints blocked{};
    const Doubles limit = widen(next_above(Floats{} + tmax));
    visit_met(scene, rays, active, balls, limit, [&](std::uint32_t, Ints met, Floats t) {
        blocked |= met & (t > 0) & (t < tmax);
        return active & ~blocked;
    });
    return blocked & active;
}

/// Calls put(number, lanes) for each ball of the active lanes, with a mask of its own lanes: once, mostly.
template <class Put>
ALHAZEN_INLINE void for_each_ball(Ints ball, Ints active, const Put& put) {
    for (std::uint32_t left = bits_of(active); left;) {
        const std::int32_t number = ball[__builtin_ctz(left)];
        const Ints same = active & (ball == number);
        put(number, same);
        left &= ~bits_of(same);
    }
}

ALHAZEN_INLINE BallLanes gather_balls(const alhazen::BundleScene& scene, Ints ball, Ints active) {
    BallLanes all{};
    for_each_ball(ball, active, [&](std::int32_t number, Ints where) {
        const alhazen::BundleBall& one = scene.balls[number];
        const Longs wide = widen(where);
        all.centre.x = wide ? Doubles{} + one.x : all.centre.x;
        all.centre.y = wide ? Doubles{} + one.y : all.centre.y;
        all.centre.z = wide ? Doubles{} + one.z : all.centre.z;
        all.radius = wide ? Doubles{} + one.radius : all.radius;
        all.radius_squared = wide ? Doubles{} + one.radius_squared : all.radius_squared;
        all.side = where ? Floats{} + one.side : all.side;
    });
    return all;
}

/// See intersect_ray_sphere.
ALHAZEN_INLINE Doubles exact_root(const Vector3d& from, const Vector3d& d, Doubles r2) {
    const Doubles a = dot(d, d), h = dot(from, d), c = dot(from, from) - r2;
    const Vector3d miss = from - d * (h * (1.0 / a));
    const Doubles above = r2 - dot(miss, miss);
    const Doubles t = smaller_positive_root(a, h, c, a * above);
    return (above >= 0) & ~((c > 0) & (h >= 0)) ? t : Doubles{};
}

/// See Sphere::from_centre.
ALHAZEN_INLINE Vector3d from_centre(const RayLanes& rays, const BallLanes& balls, Floats t, Longs active) {
    const Vector3d d = widen(rays.d), from = widen(rays.o) - balls.centre;
    const Doubles r2 = balls.radius_squared;
    Vector3d v = from + d * widen(t);
    const Doubles above = dot(v, v) - r2, slope = dot(v, d);
    const Longs grazes = ~(absolute(above) * dot(d, d) < 1e-4 * (slope * slope));
    if (any(active & grazes)) {
        const Vector3d exact = from + d * exact_root(from, d, r2);
        v = select(grazes, exact, v - d * (above / (2.0 * slope)));
    } else {
        v = v - d * (above / (2.0 * slope));
    }
    const Doubles e = dot(v, v) / r2 - 1.0;
    return v * (1.0 - e / 2.0);
}

// See rounding_error.
ALHAZEN_INLINE Floats rounding_error(Doubles p, Doubles magnitude) {
    return next_above(narrow(absolute(p) * 0x1p-24 + absolute(magnitude) * 1e-15));
}

/// See Sphere::ball_plain_surface.
ALHAZEN_INLINE SurfaceLanes surface_of(const alhazen::BundleScene& scene, const RayLanes& rays,
                                       const Nearest& hit, Ints active) {
    const BallLanes balls = gather_balls(scene, hit.ball, active);
    const Vector3d from = from_centre(rays, balls, hit.t, widen(active)), p = balls.centre + from;
    SurfaceLanes surface;
    surface.p = narrow(p);
    surface.p_error = {rounding_error(p.x, absolute(balls.centre.x) + absolute(from.x)),
                       rounding_error(p.y, absolute(balls.centre.y) + absolute(from.y)),
                       rounding_error(p.z, absolute(balls.centre.z) + absolute(from.z))};
    surface.wo = normalize(-rays.d);
    surface.n = narrow(from * (1.0 / balls.radius)) * balls.side;
    return surface;
}

} // namespace
