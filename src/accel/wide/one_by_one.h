/// What vectors do in one instruction where there is none for it: children pushed, and entries dropped, one
/// by one.
#pragma once

namespace {

struct OneByOne {
    /// Pushes the children whose bits are set in the given order; entry gets their t. Returns how many.
    static std::uint32_t push_in_order(std::uint32_t hits, const float* t, const std::uint32_t* child,
                                       std::uint32_t order, std::uint32_t is_reversed,
                                       std::uint32_t* reference, float* entry) {
        std::uint32_t n = 0;
        for (std::uint32_t i = 0; i < 8; ++i) {
            const std::uint32_t shift = is_reversed ? 21 - 3 * i : 3 * i;
            const std::uint32_t c = (order >> shift) & 7;
            reference[n] = child[c];
            entry[n] = t[c];
            n += (hits >> c) & 1;
        }
        return n;
    }
    static std::uint32_t push(std::uint32_t hits, const std::uint32_t* child, std::uint32_t* reference) {
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
};

} // namespace
