/// Eight floats in one AVX register; with AVX-512, masks and compression beside it.
#pragma once

#include <immintrin.h>

namespace {

#ifndef __AVX512VL__
/// The numbers of a mask's set bits, one a byte.
struct CompressTable {
    std::uint64_t places[256];
};
constexpr CompressTable make_compress_table() {
    CompressTable table{};
    for (std::uint32_t mask = 0; mask < 256; ++mask) {
        std::uint32_t n = 0;
        for (std::uint64_t i = 0; i < 8; ++i)
            if (mask >> i & 1) table.places[mask] |= i << (8 * n++);
    }
    return table;
}
alignas(64) constexpr CompressTable compress_table = make_compress_table();
#endif

/// How far an order is shifted for each place: read from its start, and from its end.
alignas(32) constexpr std::uint32_t order_shifts[2][8] = {{0, 3, 6, 9, 12, 15, 18, 21},
                                                          {21, 18, 15, 12, 9, 6, 3, 0}};

struct Lanes {
    using F = __m256;

    static F load(const float* p) { return _mm256_loadu_ps(p); }
    static void store(float* p, F a) { _mm256_storeu_ps(p, a); }
    static F all(float x) { return _mm256_set1_ps(x); }
    static F add(F a, F b) { return _mm256_add_ps(a, b); }
    static F sub(F a, F b) { return _mm256_sub_ps(a, b); }
    static F mul(F a, F b) { return _mm256_mul_ps(a, b); }
    static F divide(F a, F b) { return _mm256_div_ps(a, b); }
    /// a * b - c, rounded once or twice.
    static F scale(F a, F b, F c) { return _mm256_fmsub_ps(a, b, c); }
    static F min(F a, F b) { return _mm256_min_ps(a, b); }
    static F max(F a, F b) { return _mm256_max_ps(a, b); }
    static F magnitude(F a) { return _mm256_andnot_ps(_mm256_set1_ps(-0.0f), a); }
    /// a with its sign turned over where s is negative.
    static F times_sign(F a, F s) { return _mm256_xor_ps(a, _mm256_and_ps(_mm256_set1_ps(-0.0f), s)); }
    /// Inlined by force: gcc takes a function that only prefetches for one without effect, and drops its
    /// calls.
    __attribute__((always_inline)) static void prefetch(const char* p) { _mm_prefetch(p, _MM_HINT_T0); }
    static float lane(F a, std::uint32_t i) {
        return _mm256_cvtss_f32(_mm256_permutevar8x32_ps(a, _mm256_set1_epi32(static_cast<int>(i))));
    }

#ifdef __AVX512VL__
    /// Bits of the lanes where a <= b; NaN is not.
    static std::uint32_t at_most(F a, F b) { return _mm256_cmp_ps_mask(a, b, _CMP_LE_OQ); }
    /// Bits of the lanes where a < b; NaN is not.
    static std::uint32_t below(F a, F b) { return _mm256_cmp_ps_mask(a, b, _CMP_LT_OQ); }
    /// Bits of the lanes that are 0 or NaN.
    static std::uint32_t zero_or_nan(F a) { return _mm256_cmp_ps_mask(a, _mm256_setzero_ps(), _CMP_EQ_UQ); }
#else
    static std::uint32_t at_most(F a, F b) { return bits(_mm256_cmp_ps(a, b, _CMP_LE_OQ)); }
    static std::uint32_t below(F a, F b) { return bits(_mm256_cmp_ps(a, b, _CMP_LT_OQ)); }
    static std::uint32_t zero_or_nan(F a) { return bits(_mm256_cmp_ps(a, _mm256_setzero_ps(), _CMP_EQ_UQ)); }
#endif

    /// Pushes the children with near <= far in the given order; returns how many.
    static std::uint32_t push_in_order(F near, F far, const std::uint32_t* child, std::uint32_t order,
                                       std::uint32_t is_reversed, std::uint32_t* reference, float* entry) {
        const __m256i places = _mm256_srlv_epi32(_mm256_set1_epi32(static_cast<int>(order)),
                                                 load_integers(order_shifts[is_reversed]));
        const F t = _mm256_permutevar8x32_ps(near, places), out = _mm256_permutevar8x32_ps(far, places);
        const __m256i c = _mm256_permutevar8x32_epi32(load_integers(child), places);
        const std::uint32_t hits = at_most(t, out);
        store(reference, compress(hits, c));
        _mm256_storeu_ps(entry, _mm256_castsi256_ps(compress(hits, _mm256_castps_si256(t))));
        return count(hits);
    }
    static std::uint32_t push(F near, F far, const std::uint32_t* child, std::uint32_t* reference) {
        const std::uint32_t hits = at_most(near, far);
        store(reference, compress(hits, load_integers(child)));
        return count(hits);
    }
    /// Drops the entries from 1 to height that are farther than tmax; returns the new height.
    static std::uint32_t drop_beyond(float tmax, std::uint32_t height, std::uint32_t* reference,
                                     float* entry) {
        const F limit = all(tmax);
        std::uint32_t n = 1;
        for (std::uint32_t i = 1; i < height; i += 8) {
            const F t = load(entry + i);
            const __m256i r = load_integers(reference + i);
            const std::uint32_t keep = at_most(t, limit) & ((height - i < 8 ? 1u << (height - i) : 256u) - 1);
            store(reference + n, compress(keep, r));
            _mm256_storeu_ps(entry + n, _mm256_castsi256_ps(compress(keep, _mm256_castps_si256(t))));
            n += count(keep);
        }
        return n;
    }

  private:
    static std::uint32_t bits(F a) { return static_cast<std::uint32_t>(_mm256_movemask_ps(a)); }
    static std::uint32_t count(std::uint32_t mask) {
        return static_cast<std::uint32_t>(__builtin_popcount(mask));
    }
    static __m256i load_integers(const std::uint32_t* p) {
        return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(p));
    }
    static void store(std::uint32_t* p, __m256i v) { _mm256_storeu_si256(reinterpret_cast<__m256i*>(p), v); }
    /// The lanes whose bits are set, together at the front.
    static __m256i compress(std::uint32_t mask, __m256i v) {
#ifdef __AVX512VL__
        return _mm256_maskz_compress_epi32(static_cast<__mmask8>(mask), v);
#else
        const auto* places = reinterpret_cast<const __m128i*>(&compress_table.places[mask]);
        return _mm256_permutevar8x32_epi32(v, _mm256_cvtepu8_epi32(_mm_loadl_epi64(places)));
#endif
    }
};

} // namespace
