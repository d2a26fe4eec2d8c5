/// Four floats or integers in the compiler's own vectors, for what is done once a ray.
#pragma once

#ifdef __SSE4_2__
#include <immintrin.h>
#endif

namespace {

using F4 = float __attribute__((vector_size(16)));
using I4 = int __attribute__((vector_size(16)));

#define ALHAZEN_INLINE __attribute__((always_inline)) inline

ALHAZEN_INLINE F4 load_four(const float* p) {
    F4 v;
    __builtin_memcpy(&v, p, sizeof v);
    return v;
}
template <class V, class T>
ALHAZEN_INLINE void store_four(T* to, V v) {
    static_assert(sizeof(T[4]) == sizeof v);
    __builtin_memcpy(to, &v, sizeof v);
}
ALHAZEN_INLINE I4 bits_of(F4 v) {
    return reinterpret_cast<I4>(v);
}
ALHAZEN_INLINE F4 with_sign(F4 v, I4 sign) {
    return reinterpret_cast<F4>(bits_of(v) ^ sign);
}
/// Of the first three.
ALHAZEN_INLINE float largest_of(F4 v) {
    const float xy = v[0] > v[1] ? v[0] : v[1];
    return xy > v[2] ? xy : v[2];
}
/// The signs, one a bit.
ALHAZEN_INLINE std::uint32_t signs_of(I4 v) {
#ifdef __SSE4_2__
    return static_cast<std::uint32_t>(_mm_movemask_ps(reinterpret_cast<__m128>(v)));
#else
    std::uint32_t bits = 0;
    for (int i = 0; i < 4; ++i) bits |= static_cast<std::uint32_t>(v[i] < 0) << i;
    return bits;
#endif
}

/// The axes in the order x, y, z of a shear along the axis z (0, 1 or 2): the two after it in turn, and
/// itself.
struct ShearOrder {
    std::uint32_t axis[4];
    std::uint8_t bytes[16]; ///< where the bytes of four floats in that order come from
};
alignas(32) constexpr ShearOrder shear_orders[3] = {
    {{1, 2, 0, 3}, {4, 5, 6, 7, 8, 9, 10, 11, 0, 1, 2, 3, 12, 13, 14, 15}},
    {{2, 0, 1, 3}, {8, 9, 10, 11, 0, 1, 2, 3, 4, 5, 6, 7, 12, 13, 14, 15}},
    {{0, 1, 2, 3}, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15}}};

ALHAZEN_INLINE F4 in_order(F4 v, const ShearOrder& order) {
#ifdef __SSE4_2__
    const __m128i control = _mm_load_si128(reinterpret_cast<const __m128i*>(order.bytes));
    return reinterpret_cast<F4>(_mm_shuffle_epi8(reinterpret_cast<__m128i>(v), control));
#else
    return F4{v[order.axis[0]], v[order.axis[1]], v[order.axis[2]], v[3]};
#endif
}

} // namespace
