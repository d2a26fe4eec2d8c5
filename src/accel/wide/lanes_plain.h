/// Eight floats for any processor.
#pragma once

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
        const std::uint32_t hits = at_most(near, far);
        std::uint32_t n = 0;
        for (std::uint32_t i = 0; i < 8; ++i) {
            const std::uint32_t shift = is_reversed ? 21 - 3 * i : 3 * i;
            const std::uint32_t c = (order >> shift) & 7;
            reference[n] = child[c];
            entry[n] = near.v[c];
            n += (hits >> c) & 1;
        }
        return n;
    }
    static std::uint32_t push(const F& near, const F& far, const std::uint32_t* child,
                              std::uint32_t* reference) {
        const std::uint32_t hits = at_most(near, far);
        std::uint32_t n = 0;
        for (std::uint32_t c = 0; c < 8; ++c) {
            reference[n] = child[c];
            n += (hits >> c) & 1;
        }
        return n;
    }
    /// Drops the entries from 1 to height that are farther than tmax; returns the new height.
    static std::uint32_t drop_beyond(float tmax, std::uint32_t height, std::uint32_t* reference,
                                     float* entry) {
        std::uint32_t n = 1;
        for (std::uint32_t i = 1; i < height; ++i) {
            const float t = entry[i];
            reference[n] = reference[i];
            entry[n] = t;
            n += t <= tmax;
        }
        return n;
    }
    /// Inlined by force: gcc takes a function that only prefetches for one without effect, and drops its
    /// calls.
    __attribute__((always_inline)) static void prefetch(const char* p) { __builtin_prefetch(p); }
    static float lane(const F& a, std::uint32_t i) { return a.v[i]; }
};

} // namespace
