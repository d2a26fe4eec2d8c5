/// Eight numbers at a time, and vectors of them: what the kernels' text is written in. Operators work lane by
/// lane, in the order in which base/vec.h has them; comparisons give lanes of -1 (true) or 0.
#pragma once

#include <cstdint>

namespace {

#define ALHAZEN_INLINE [[gnu::always_inline]] inline

using Floats = float __attribute__((vector_size(32)));
using Ints = std::int32_t __attribute__((vector_size(32)));
using Doubles = double __attribute__((vector_size(64)));
using Longs = long long __attribute__((vector_size(64)));

constexpr int lanes = 8;
constexpr float infinite = __builtin_inff();

ALHAZEN_INLINE Doubles widen(Floats v) {
    return __builtin_convertvector(v, Doubles);
}
ALHAZEN_INLINE Longs widen(Ints v) {
    return __builtin_convertvector(v, Longs);
}
ALHAZEN_INLINE Floats narrow(Doubles v) {
    return __builtin_convertvector(v, Floats);
}
ALHAZEN_INLINE Ints narrow(Longs v) {
    return __builtin_convertvector(v, Ints);
}

// One bit a lane.
ALHAZEN_INLINE std::uint32_t bits_of(Ints mask) {
#if defined(__AVX2__)
    return static_cast<std::uint32_t>(__builtin_ia32_movmskps256(__builtin_bit_cast(Floats, mask)));
#else
    std::uint32_t bits = 0;
    for (int i = 0; i < lanes; ++i) bits |= (mask[i] ? 1u : 0u) << i;
    return bits;
#endif
}
ALHAZEN_INLINE bool any(Ints mask) {
    return bits_of(mask) != 0;
}
ALHAZEN_INLINE bool any(Longs mask) {
#if defined(__AVX512DQ__)
    return __builtin_ia32_cvtq2mask512(mask) != 0;
#else
    return any(narrow(mask));
#endif
}
ALHAZEN_INLINE std::uint32_t count(Ints mask) {
    return static_cast<std::uint32_t>(__builtin_popcount(bits_of(mask)));
}

// Compilers make one instruction of such loops over arrays, not over lanes.
ALHAZEN_INLINE double root(double v) {
    return __builtin_sqrt(v);
}
ALHAZEN_INLINE float root(float v) {
    return __builtin_sqrtf(v);
}
template <class T, class V>
ALHAZEN_INLINE V roots(V v) {
    alignas(64) T numbers[lanes];
    __builtin_memcpy(numbers, &v, sizeof v);
    for (T& number : numbers) number = root(number);
    __builtin_memcpy(&v, numbers, sizeof v);
    return v;
}
ALHAZEN_INLINE Doubles square_root(Doubles v) {
    return roots<double>(v);
}
ALHAZEN_INLINE Floats square_root(Floats v) {
    return roots<float>(v);
}
ALHAZEN_INLINE Floats absolute(Floats v) {
    return __builtin_bit_cast(Floats, __builtin_bit_cast(Ints, v) & 0x7fffffff);
}
ALHAZEN_INLINE Doubles absolute(Doubles v) {
    return __builtin_bit_cast(Doubles, __builtin_bit_cast(Longs, v) & 0x7fffffffffffffffLL);
}
// Eight numbers in memory.
ALHAZEN_INLINE Floats floats(const float* numbers) {
    Floats v;
    __builtin_memcpy(&v, numbers, sizeof v);
    return v;
}
template <class Int>
ALHAZEN_INLINE Ints ints(const Int* numbers) {
    Ints v;
    __builtin_memcpy(&v, numbers, sizeof v);
    return v;
}
template <class Number, class V>
ALHAZEN_INLINE void store(Number* numbers, V v) {
    static_assert(sizeof(Number) * lanes == sizeof v);
    __builtin_memcpy(numbers, &v, sizeof v);
}
ALHAZEN_INLINE Floats smaller(Floats a, Floats b) {
    return a < b ? a : b;
}
ALHAZEN_INLINE Floats larger(Floats a, Floats b) {
    return a > b ? a : b;
}
ALHAZEN_INLINE Ints clamp(Ints v, std::int32_t last) {
    v = v > 0 ? v : Ints{};
    return v < last ? v : Ints{} + last;
}

/// a b + c, rounded once or twice: for what is known roughly only.
ALHAZEN_INLINE Floats fused(Floats a, Floats b, Floats c) {
#if defined(__FMA__)
    return __builtin_ia32_vfmaddps256(a, b, c);
#else
    return a * b + c;
#endif
}
// v's size with s's sign.
ALHAZEN_INLINE Floats with_sign(Floats v, Floats s) {
    constexpr int sign = static_cast<int>(0x80000000u);
    return __builtin_bit_cast(Floats,
                              __builtin_bit_cast(Ints, absolute(v)) | (__builtin_bit_cast(Ints, s) & sign));
}
// The next float above numbers >= 0.
ALHAZEN_INLINE Floats next_above(Floats v) {
    return v < infinite ? __builtin_bit_cast(Floats, __builtin_bit_cast(Ints, v) + 1) : v;
}

template <class V>
struct Vector {
    V x, y, z;
};
using Vector3 = Vector<Floats>;
using Vector3d = Vector<Doubles>;

template <class V>
ALHAZEN_INLINE Vector<V> operator+(const Vector<V>& a, const Vector<V>& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class V>
ALHAZEN_INLINE Vector<V> operator-(const Vector<V>& a, const Vector<V>& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class V>
ALHAZEN_INLINE Vector<V> operator-(const Vector<V>& v) {
    return {-v.x, -v.y, -v.z};
}
template <class V>
ALHAZEN_INLINE Vector<V> operator*(const Vector<V>& v, const V& s) {
    return {v.x * s, v.y * s, v.z * s};
}
template <class V>
ALHAZEN_INLINE V dot(const Vector<V>& a, const Vector<V>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class M, class V>
ALHAZEN_INLINE Vector<V> select(const M& mask, const Vector<V>& a, const Vector<V>& b) {
    return {mask ? a.x : b.x, mask ? a.y : b.y, mask ? a.z : b.z};
}
ALHAZEN_INLINE Vector3 normalize(const Vector3& v) {
    return v * (1 / square_root(dot(v, v)));
}
ALHAZEN_INLINE Vector3d widen(const Vector3& v) {
    return {widen(v.x), widen(v.y), widen(v.z)};
}
ALHAZEN_INLINE Vector3 narrow(const Vector3d& v) {
    return {narrow(v.x), narrow(v.y), narrow(v.z)};
}
ALHAZEN_INLINE Vector3 absolute(const Vector3& v) {
    return {absolute(v.x), absolute(v.y), absolute(v.z)};
}

} // namespace
