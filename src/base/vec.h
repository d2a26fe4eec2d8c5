/// Two- and three-component vectors. One type serves points, directions and normals; how each transforms is
/// said by the function of Transform that is called.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace alhazen {

template <class T>
struct TVec2 {
    T x{}, y{};

    constexpr TVec2() = default;
    constexpr TVec2(T x_, T y_) : x(x_), y(y_) {}
    template <class U>
    explicit constexpr TVec2(TVec2<U> v) : x(static_cast<T>(v.x)), y(static_cast<T>(v.y)) {}

    constexpr T operator[](int i) const { return i == 0 ? x : y; }
    constexpr T& operator[](int i) { return i == 0 ? x : y; }
    constexpr bool operator==(const TVec2&) const = default;

    friend constexpr TVec2 operator+(TVec2 a, TVec2 b) { return {a.x + b.x, a.y + b.y}; }
    friend constexpr TVec2 operator-(TVec2 a, TVec2 b) { return {a.x - b.x, a.y - b.y}; }
    friend constexpr TVec2 operator*(TVec2 a, TVec2 b) { return {a.x * b.x, a.y * b.y}; }
    friend constexpr TVec2 operator*(TVec2 a, T s) { return {a.x * s, a.y * s}; }
    friend constexpr TVec2 operator*(T s, TVec2 a) { return {a.x * s, a.y * s}; }
    friend constexpr TVec2 operator/(TVec2 a, T s) { return {a.x / s, a.y / s}; }
    friend constexpr TVec2 operator-(TVec2 a) { return {-a.x, -a.y}; }
    constexpr TVec2& operator+=(TVec2 b) { return *this = *this + b; }
    constexpr TVec2& operator*=(T s) { return *this = *this * s; }
};

template <class T>
struct TVec3 {
    T x{}, y{}, z{};

    constexpr TVec3() = default;
    constexpr TVec3(T x_, T y_, T z_) : x(x_), y(y_), z(z_) {}
    explicit constexpr TVec3(T s) : x(s), y(s), z(s) {}
    template <class U>
    explicit constexpr TVec3(TVec3<U> v)
        : x(static_cast<T>(v.x)), y(static_cast<T>(v.y)), z(static_cast<T>(v.z)) {}

    constexpr T operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
    constexpr T& operator[](int i) { return i == 0 ? x : i == 1 ? y : z; }
    constexpr bool operator==(const TVec3&) const = default;

    friend constexpr TVec3 operator+(TVec3 a, TVec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend constexpr TVec3 operator-(TVec3 a, TVec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend constexpr TVec3 operator*(TVec3 a, TVec3 b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
    friend constexpr TVec3 operator*(TVec3 a, T s) { return {a.x * s, a.y * s, a.z * s}; }
    friend constexpr TVec3 operator*(T s, TVec3 a) { return {a.x * s, a.y * s, a.z * s}; }
    friend constexpr TVec3 operator/(TVec3 a, T s) { return a * (T(1) / s); }
    friend constexpr TVec3 operator-(TVec3 a) { return {-a.x, -a.y, -a.z}; }
    constexpr TVec3& operator+=(TVec3 b) { return *this = *this + b; }
    constexpr TVec3& operator-=(TVec3 b) { return *this = *this - b; }
    constexpr TVec3& operator*=(T s) { return *this = *this * s; }
};

using Vec2 = TVec2<float>;
using Vec3 = TVec3<float>;
using Vec2d = TVec2<double>;
using Vec3d = TVec3<double>;
using Vec2i = TVec2<int>;
using Vec3i = TVec3<int>;

template <class T>
constexpr T dot(TVec2<T> a, TVec2<T> b) {
    return a.x * b.x + a.y * b.y;
}
template <class T>
constexpr T dot(TVec3<T> a, TVec3<T> b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
constexpr T abs_dot(TVec3<T> a, TVec3<T> b) {
    return std::abs(dot(a, b));
}

/// a b - c d with one rounding error instead of catastrophic cancellation (Kahan; Jeannerod et al. 2013).
inline float difference_of_products(float a, float b, float c, float d) {
    // The products are exact in double, so the difference is rounded twice at most.
    return static_cast<float>(static_cast<double>(a) * b - static_cast<double>(c) * d);
}
constexpr double difference_of_products(double a, double b, double c, double d) {
    return a * b - c * d;
}

template <class T>
constexpr TVec3<T> cross(TVec3<T> a, TVec3<T> b) {
    return {difference_of_products(a.y, b.z, a.z, b.y), difference_of_products(a.z, b.x, a.x, b.z),
            difference_of_products(a.x, b.y, a.y, b.x)};
}

template <class V>
constexpr auto length_squared(V v) {
    return dot(v, v);
}
template <class V>
auto length(V v) {
    return std::sqrt(dot(v, v));
}
/// Unit vector along v; v must not be zero.
template <class V>
V normalize(V v) {
    return v / length(v);
}

template <class T>
TVec3<T> abs(TVec3<T> v) {
    return {std::abs(v.x), std::abs(v.y), std::abs(v.z)};
}
template <class T>
constexpr TVec3<T> min(TVec3<T> a, TVec3<T> b) {
    return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}
template <class T>
constexpr TVec3<T> max(TVec3<T> a, TVec3<T> b) {
    return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}
template <class T>
constexpr T max_component(TVec3<T> v) {
    return std::max(v.x, std::max(v.y, v.z));
}
template <class T>
constexpr int max_dimension(TVec3<T> v) {
    return v.x > v.y ? (v.x > v.z ? 0 : 2) : (v.y > v.z ? 1 : 2);
}
template <class T>
bool is_finite(TVec3<T> v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// n turned to the side that v is on.
inline Vec3 face_forward(Vec3 n, Vec3 v) {
    return dot(n, v) < 0 ? -n : n;
}

template <class T>
constexpr T lerp(float t, T a, T b) {
    return a * (1 - t) + b * t;
}

inline constexpr float pi = 3.14159265358979323846f;
inline constexpr float inv_pi = 0.31830988618379067154f;
inline constexpr float infinity = __builtin_inff();
/// The largest float below one.
inline constexpr float one_minus_epsilon = 0x1.fffffep-1f;

inline constexpr float sqr(float x) {
    return x * x;
}
/// The largest whole number not above v, whose size must be that of an int. std::floor is a call where the
/// processor's instruction may not be there.
inline int floor_to_int(float v) {
    const int towards_zero = static_cast<int>(v);
    return towards_zero - (v < static_cast<float>(towards_zero) ? 1 : 0);
}
/// Square root of x, taking rounding's small negative numbers for zero.
inline float safe_sqrt(float x) {
    return std::sqrt(std::max(0.0f, x));
}
inline constexpr float radians(float degrees) {
    return degrees * (pi / 180.0f);
}
inline constexpr float degrees(float radians_) {
    return radians_ * (180.0f / pi);
}

} // namespace alhazen
