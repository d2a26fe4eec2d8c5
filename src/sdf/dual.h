/// Dual numbers: a value together with its derivatives by the three coordinates of a point. What is written
/// for a scalar type S, double or Dual, gives a field's value and its exact gradient from one text.
#pragma once

#include "base/vec.h"

namespace alhazen {

/// v + d . (dx, dy, dz), to first order (Clifford 1873).
struct Dual {
    double v = 0;
    Vec3d d{};

    constexpr Dual() = default;
    constexpr Dual(double value) : v(value) {}
    constexpr Dual(double value, Vec3d derivative) : v(value), d(derivative) {}

    friend constexpr Dual operator+(Dual a, Dual b) { return {a.v + b.v, a.d + b.d}; }
    friend constexpr Dual operator-(Dual a, Dual b) { return {a.v - b.v, a.d - b.d}; }
    friend constexpr Dual operator*(Dual a, Dual b) { return {a.v * b.v, a.d * b.v + b.d * a.v}; }
    friend constexpr Dual operator/(Dual a, Dual b) {
        double q = a.v / b.v;
        return {q, (a.d - b.d * q) * (1 / b.v)};
    }
    friend constexpr Dual operator-(Dual a) { return {-a.v, -a.d}; }
    friend constexpr bool operator<(Dual a, Dual b) { return a.v < b.v; }
    friend constexpr bool operator>(Dual a, Dual b) { return a.v > b.v; }
    friend constexpr bool operator<=(Dual a, Dual b) { return a.v <= b.v; }
    friend constexpr bool operator>=(Dual a, Dual b) { return a.v >= b.v; }
};

/// A point whose coordinates know their derivatives by themselves.
inline TVec3<Dual> dual_point(Vec3d p) {
    return {{p.x, {1, 0, 0}}, {p.y, {0, 1, 0}}, {p.z, {0, 0, 1}}};
}

inline double value_of(double x) {
    return x;
}
inline double value_of(Dual x) {
    return x.v;
}
template <class S>
Vec3d values_of(TVec3<S> p) {
    return {value_of(p.x), value_of(p.y), value_of(p.z)};
}

/// The function of a point that has this value and this gradient there.
inline double with_gradient(double value, Vec3d /*gradient*/, TVec3<double> /*p*/) {
    return value;
}
inline Dual with_gradient(double value, Vec3d gradient, TVec3<Dual> p) {
    return {value, p.x.d * gradient.x + p.y.d * gradient.y + p.z.d * gradient.z};
}

inline double absolute(double x) {
    return std::abs(x);
}
inline Dual absolute(Dual x) {
    return x.v < 0 ? -x : x;
}
/// Of x >= 0; the derivative at 0, which does not exist, is taken for 0.
inline double square_root(double x) {
    return std::sqrt(x);
}
inline Dual square_root(Dual x) {
    double r = std::sqrt(x.v);
    return {r, r > 0 ? x.d * (0.5 / r) : Vec3d{}};
}
inline double sine(double x) {
    return std::sin(x);
}
inline Dual sine(Dual x) {
    return {std::sin(x.v), x.d * std::cos(x.v)};
}
inline double cosine(double x) {
    return std::cos(x);
}
inline Dual cosine(Dual x) {
    return {std::cos(x.v), x.d * -std::sin(x.v)};
}

template <class S>
S norm(S x, S y) {
    return square_root(x * x + y * y);
}
template <class S>
S norm(TVec3<S> p) {
    return square_root(p.x * p.x + p.y * p.y + p.z * p.z);
}
template <class S>
TVec3<S> absolute(TVec3<S> p) {
    return {absolute(p.x), absolute(p.y), absolute(p.z)};
}
/// The point's distance to the quarter plane x, y <= 0, negative inside.
template <class S>
S quarter_plane_distance(S x, S y) {
    S zero(0.0);
    return norm(std::max(x, zero), std::max(y, zero)) + std::min(std::max(x, y), zero);
}

} // namespace alhazen
