/// Eight floats for any processor.
#pragma once

#include "accel/wide/one_by_one.h"

namespace {

struct Lanes {
    struct F {
        float v[8];
    };

    static F load(const float* p) {
        F r;
        for (int i = 0; i < 8; ++i) r.v[i] = p[i];
        return r;
    }
    static void store(float* p, const F& a) {
        for (int i = 0; i < 8; ++i) p[i] = a.v[i];
    }
    static F all(float x) {
        F r;
        for (float& v : r.v) v = x;
        return r;
    }
    static F add(const F& a, const F& b) {
        F r;
        for (int i = 0; i < 8; ++i) r.v[i] = a.v[i] + b.v[i];
        return r;
    }
    static F sub(const F& a, const F& b) {
        F r;
        for (int i = 0; i < 8; ++i) r.v[i] = a.v[i] - b.v[i];
        return r;
    }
    static F mul(const F& a, const F& b) {
        F r;
        for (int i = 0; i < 8; ++i) r.v[i] = a.v[i] * b.v[i];
        return r;
    }
    static F divide(const F& a, const F& b) {
        F r;
        for (int i = 0; i < 8; ++i) r.v[i] = a.v[i] / b.v[i];
        return r;
    }
    /// a * b - c, rounded once or twice.
    static F scale(const F& a, const F& b, const F& c) { return sub(mul(a, b), c); }
    static F min(const F& a, const F& b) {
        F r;
        for (int i = 0; i < 8; ++i) r.v[i] = a.v[i] < b.v[i] ? a.v[i] : b.v[i];
        return r;
    }
    static F max(const F& a, const F& b) {
        F r;
        for (int i = 0; i < 8; ++i) r.v[i] = a.v[i] > b.v[i] ? a.v[i] : b.v[i];
        return r;
    }
    static F magnitude(const F& a) {
        F r;
        for (int i = 0; i < 8; ++i) r.v[i] = a.v[i] < 0 ? -a.v[i] : a.v[i];
        return r;
    }
    /// a with its sign turned over where s is negative.
    static F times_sign(const F& a, const F& s) {
        F r;
        for (int i = 0; i < 8; ++i) r.v[i] = s.v[i] < 0 ? -a.v[i] : a.v[i];
        return r;
    }
    /// Bits of the lanes where a <= b; NaN is not.
    static std::uint32_t at_most(const F& a, const F& b) {
        std::uint32_t bits = 0;
        for (int i = 0; i < 8; ++i) bits |= static_cast<std::uint32_t>(a.v[i] <= b.v[i]) << i;
        return bits;
    }
    /// Bits of the lanes where a < b; NaN is not.
    static std::uint32_t below(const F& a, const F& b) {
        std::uint32_t bits = 0;
        for (int i = 0; i < 8; ++i) bits |= static_cast<std::uint32_t>(a.v[i] < b.v[i]) << i;
        return bits;
    }
    /// Bits of the lanes that are 0 or NaN.
    static std::uint32_t zero_or_nan(const F& a) {
        std::uint32_t bits = 0;
        for (int i = 0; i < 8; ++i) bits |= static_cast<std::uint32_t>(!(a.v[i] < 0 || a.v[i] > 0)) << i;
        return bits;
    }

    /// Pushes the children with near <= far in the given order; returns how many.
    static std::uint32_t push_in_order(const F& near, const F& far, const std::uint32_t* child,
                                       std::uint32_t order, std::uint32_t is_reversed,
                                       std::uint32_t* reference, float* entry) {
        return OneByOne::push_in_order(at_most(near, far), near.v, child, order, is_reversed, reference,
                                       entry);
    }
    static std::uint32_t push(const F& near, const F& far, const std::uint32_t* child,
                              std::uint32_t* reference) {
        return OneByOne::push(at_most(near, far), child, reference);
    }
    /// Drops the entries from 1 to height that are farther than tmax; returns the new height.
    static std::uint32_t drop_beyond(float tmax, std::uint32_t height, std::uint32_t* reference,
                                     float* entry) {
        return OneByOne::drop_beyond(tmax, height, reference, entry);
    }
    /// Inlined by force: gcc takes a function that only prefetches for one without effect, and drops its
    /// calls.
    __attribute__((always_inline)) static void prefetch(const char* p) { __builtin_prefetch(p); }
    static float lane(const F& a, std::uint32_t i) { return a.v[i]; }
};

} // namespace
