#include "scene/ball_list.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "base/processor.h"

namespace alhazen {

namespace {

#define ALHAZEN_INLINE [[gnu::always_inline]] inline

using Pair = double __attribute__((vector_size(16)));
using Four = double __attribute__((vector_size(32)));

// What a root must be beyond, to be beyond end when rounded.
ALHAZEN_INLINE double limit_of(float end) {
    return static_cast<double>(next_up(end));
}

// Whether the root that is asked for (smaller_positive_root) is more than t beyond doubt. From inside it is
// when the point at t is still inside; from outside, when that is still outside and before the middle. (False
// where t is infinite.)
ALHAZEN_INLINE bool is_beyond(double t, double a, double h, double c, double r2) {
    const double at2 = a * t * t, ht = 2 * h * t, f = at2 + ht + c;
    const double rounding = 1e-14 * (at2 + std::abs(ht) + std::abs(c) + r2);
    return c < 0 ? f < -rounding : f > rounding && a * t < -h;
}

// A bit for each lane of a comparison that holds.
ALHAZEN_INLINE std::uint32_t bits_of(const void* lanes, std::size_t width) {
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < width; i += 2) {
        Pair pair;
        std::memcpy(&pair, static_cast<const double*>(lanes) + i, sizeof pair);
#ifdef __SSE2__
        bits |= static_cast<std::uint32_t>(__builtin_ia32_movmskpd(pair)) << i;
#else
        const auto signs = std::bit_cast<std::array<std::uint64_t, 2>>(pair);
        bits |= static_cast<std::uint32_t>(signs[0] >> 63 | (signs[1] >> 63) << 1) << i;
#endif
    }
    return bits;
}

// Calls visit(ball, h, c, h^2 / a - c) for each ball that the ray does not miss, until it returns true; in
// the operations of intersect_ray_sphere, as many balls at a time as there are lanes.
template <class Lanes, class Visit>
ALHAZEN_INLINE bool visit_met(const BallList& balls, const BallRay& ray, const Visit& visit) {
    constexpr std::size_t width = sizeof(Lanes) / sizeof(double);
    for (std::size_t first = 0; first < balls.x.size(); first += width) {
        Lanes x, y, z, r2;
        std::memcpy(&x, balls.x.data() + first, sizeof x);
        std::memcpy(&y, balls.y.data() + first, sizeof y);
        std::memcpy(&z, balls.z.data() + first, sizeof z);
        std::memcpy(&r2, balls.radius_squared.data() + first, sizeof r2);
        x = ray.o.x - x;
        y = ray.o.y - y;
        z = ray.o.z - z;
        const Lanes h = x * ray.d.x + y * ray.d.y + z * ray.d.z;
        const Lanes c = x * x + y * y + z * z - r2;
        const Lanes s = h * ray.inverse_a;
        x -= ray.d.x * s;
        y -= ray.d.y * s;
        z -= ray.d.z * s;
        const Lanes above = r2 - (x * x + y * y + z * z);
        const auto met = (above >= 0) & ~((c > 0) & (h >= 0));
        for (std::uint32_t bits = bits_of(&met, width); bits; bits &= bits - 1) {
            const auto i = static_cast<std::size_t>(std::countr_zero(bits));
            if (visit(first + i, h[i], c[i], above[i])) return true;
        }
    }
    return false;
}

template <class Lanes>
ALHAZEN_INLINE void find_closest(const BallList& balls, const Ray& ray, Intersection& hit) {
    const BallRay exact(ray);
    double limit = limit_of(std::min(hit.t, ray.tmax));
    visit_met<Lanes>(balls, exact, [&](std::size_t i, double h, double c, double above) {
        if (is_beyond(limit, exact.a, h, c, balls.radius_squared[i])) return false;
        const auto t = static_cast<float>(smaller_positive_root(exact.a, h, c, exact.a * above));
        const std::uint32_t primitive = balls.primitives[i];
        const bool is_nearer = t < hit.t || (t == hit.t && primitive < hit.primitive);
        if (!is_nearer || !(t > 0) || !(t < ray.tmax)) return false;
        hit = {t, 0, 0, primitive, 0};
        limit = limit_of(t);
        return false;
    });
}

template <class Lanes>
ALHAZEN_INLINE bool find_any(const BallList& balls, const Ray& ray) {
    const BallRay exact(ray);
    const double limit = limit_of(ray.tmax);
    return visit_met<Lanes>(balls, exact, [&](std::size_t i, double h, double c, double above) {
        if (is_beyond(limit, exact.a, h, c, balls.radius_squared[i])) return false;
        const auto t = static_cast<float>(smaller_positive_root(exact.a, h, c, exact.a * above));
        return t > 0 && t < ray.tmax;
    });
}

// Where there are no registers of four doubles these are only slower.
#ifdef __x86_64__
#define ALHAZEN_AVX2 [[gnu::target("avx2")]]
#else
#define ALHAZEN_AVX2
#endif
ALHAZEN_AVX2 void closest_of_four(const BallList& balls, const Ray& ray, Intersection& hit) {
    find_closest<Four>(balls, ray, hit);
}
ALHAZEN_AVX2 bool any_of_four(const BallList& balls, const Ray& ray) {
    return find_any<Four>(balls, ray);
}

} // namespace

int BallList::most_lanes() {
    return processor_has_avx2() ? 4 : 2;
}

BallList::BallList(std::vector<Numbered> balls, int lanes) : takes_four_(lanes == 4) {
    // Small ones are met first, so that large ones behind them need not be looked at closely.
    std::stable_sort(balls.begin(), balls.end(),
                     [](const Numbered& a, const Numbered& b) { return a.ball.radius < b.ball.radius; });
    for (const auto& [ball, primitive] : balls) {
        x.push_back(ball.centre.x);
        y.push_back(ball.centre.y);
        z.push_back(ball.centre.z);
        radius_squared.push_back(ball.radius * ball.radius);
        primitives.push_back(primitive);
    }
    const std::size_t padded = (balls.size() + 3) / 4 * 4;
    for (std::vector<double>* values : {&x, &y, &z}) values->resize(padded, 0);
    radius_squared.resize(padded, -1);
}

void BallList::closest(const Ray& ray, Intersection& hit) const {
    if (takes_four_)
        closest_of_four(*this, ray, hit);
    else
        find_closest<Pair>(*this, ray, hit);
}

bool BallList::any(const Ray& ray) const {
    return takes_four_ ? any_of_four(*this, ray) : find_any<Pair>(*this, ray);
}

} // namespace alhazen
