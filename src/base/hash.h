/// Integer hashes: the source of every random number, so that each is a pure function of where it is used.
#pragma once

#include <bit>
#include <cstdint>

namespace alhazen {

/// Bijective 64-bit mixer (Stafford 2011, variant 13, as in SplitMix64).
constexpr std::uint64_t mix_bits(std::uint64_t v) {
    v ^= v >> 30;
    v *= 0xbf58476d1ce4e5b9u;
    v ^= v >> 27;
    v *= 0x94d049bb133111ebu;
    v ^= v >> 31;
    return v;
}

/// A hash of several integers; the order matters.
template <class... Ints>
constexpr std::uint64_t hash_of(Ints... values) {
    std::uint64_t h = 0x9e3779b97f4a7c15u;
    ((h = mix_bits(h + 0x9e3779b97f4a7c15u + static_cast<std::uint64_t>(values))), ...);
    return h;
}

/// Uniform float in [0, 1) from the upper 24 bits of a hash.
constexpr float unit_float(std::uint64_t h) {
    return static_cast<float>(h >> 40) * 0x1p-24f;
}
constexpr float unit_float(std::uint32_t h) {
    return static_cast<float>(h >> 8) * 0x1p-24f;
}

/// A small random number generator for code that needs a stream (PCG32, O'Neill 2014).
class Rng {
  public:
    explicit constexpr Rng(std::uint64_t seed, std::uint64_t stream = 0) : increment_((stream << 1) | 1) {
        next();
        state_ += mix_bits(seed);
        next();
    }
    constexpr std::uint32_t next() {
        std::uint64_t old = state_;
        state_ = old * 0x5851f42d4c957f2du + increment_;
        auto shifted = static_cast<std::uint32_t>(((old >> 18) ^ old) >> 27);
        return std::rotr(shifted, static_cast<int>(old >> 59));
    }
    /// Uniform in [0, 1).
    constexpr float uniform() { return unit_float(next()); }
    /// Uniform in 0 ... n - 1 (n > 0), without bias.
    constexpr std::uint32_t below(std::uint32_t n) {
        std::uint32_t threshold = (0u - n) % n;
        for (;;) {
            std::uint32_t r = next();
            if (r >= threshold) return r % n;
        }
    }

  private:
    std::uint64_t state_ = 0;
    std::uint64_t increment_;
};

} // namespace alhazen
