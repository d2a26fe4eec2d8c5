/// Eight floats in two SSE registers.
#pragma once

#include <immintrin.h>

#include "accel/wide/one_by_one.h"

namespace {

struct Lanes {
    struct F {
        __m128 a, b;
    };

    static F load(const float* p) { return {_mm_loadu_ps(p), _mm_loadu_ps(p + 4)}; }
    static void store(float* p, F x) {
        _mm_storeu_ps(p, x.a);
        _mm_storeu_ps(p + 4, x.b);
    }
    static F all(float x) { return {_mm_set1_ps(x), _mm_set1_ps(x)}; }
    static F add(F x, F y) { return {_mm_add_ps(x.a, y.a), _mm_add_ps(x.b, y.b)}; }
    static F sub(F x, F y) { return {_mm_sub_ps(x.a, y.a), _mm_sub_ps(x.b, y.b)}; }
    static F mul(F x, F y) { return {_mm_mul_ps(x.a, y.a), _mm_mul_ps(x.b, y.b)}; }
    static F divide(F x, F y) { return {_mm_div_ps(x.a, y.a), _mm_div_ps(x.b, y.b)}; }
    /// a * b - c, rounded once or twice.
    static F scale(F x, F y, F c) { return sub(mul(x, y), c); }
    static F min(F x, F y) { return {_mm_min_ps(x.a, y.a), _mm_min_ps(x.b, y.b)}; }
    static F max(F x, F y) { return {_mm_max_ps(x.a, y.a), _mm_max_ps(x.b, y.b)}; }
    static F magnitude(F x) {
        const __m128 sign = _mm_set1_ps(-0.0f);
        return {_mm_andnot_ps(sign, x.a), _mm_andnot_ps(sign, x.b)};
    }
    /// x with its sign turned over where s is negative.
    static F times_sign(F x, F s) {
        const __m128 sign = _mm_set1_ps(-0.0f);
        return {_mm_xor_ps(x.a, _mm_and_ps(sign, s.a)), _mm_xor_ps(x.b, _mm_and_ps(sign, s.b))};
    }
    /// Bits of the lanes where x <= y; NaN is not.
    static std::uint32_t at_most(F x, F y) { return bits(_mm_cmple_ps(x.a, y.a), _mm_cmple_ps(x.b, y.b)); }
    /// Bits of the lanes where x < y; NaN is not.
    static std::uint32_t below(F x, F y) { return bits(_mm_cmplt_ps(x.a, y.a), _mm_cmplt_ps(x.b, y.b)); }
    /// Bits of the lanes that are 0 or NaN.
    static std::uint32_t zero_or_nan(F x) {
        const __m128 zero = _mm_setzero_ps();
        return bits(_mm_cmpeq_ps(x.a, zero), _mm_cmpeq_ps(x.b, zero)) | nan(x);
    }

    /// Pushes the children with near <= far in the given order; returns how many.
    static std::uint32_t push_in_order(F near, F far, const std::uint32_t* child, std::uint32_t order,
                                       std::uint32_t is_reversed, std::uint32_t* reference, float* entry) {
        alignas(16) float t[8];
        store(t, near);
        return OneByOne::push_in_order(at_most(near, far), t, child, order, is_reversed, reference, entry);
    }
    static std::uint32_t push(F near, F far, const std::uint32_t* child, std::uint32_t* reference) {
        return OneByOne::push(at_most(near, far), child, reference);
    }
    /// Drops the entries from 1 to height that are farther than tmax; returns the new height.
    static std::uint32_t drop_beyond(float tmax, std::uint32_t height, std::uint32_t* reference,
                                     float* entry) {
        return OneByOne::drop_beyond(tmax, height, reference, entry);
    }
    /// Inlined by force: gcc takes a function that only prefetches for one without effect, and drops its
    /// calls.
    __attribute__((always_inline)) static void prefetch(const char* p) { _mm_prefetch(p, _MM_HINT_T0); }
    static float lane(F x, std::uint32_t i) {
        alignas(16) float t[8];
        _mm_store_ps(t, x.a);
        _mm_store_ps(t + 4, x.b);
        return t[i];
    }

  private:
    static std::uint32_t bits(__m128 a, __m128 b) {
        return static_cast<std::uint32_t>(_mm_movemask_ps(a) | _mm_movemask_ps(b) << 4);
    }
    static std::uint32_t nan(F x) { return bits(_mm_cmpunord_ps(x.a, x.a), _mm_cmpunord_ps(x.b, x.b)); }
};

} // namespace
