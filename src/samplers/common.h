/// What several samplers share: the declared count and seed, keys for hashing, the ways to randomize.
#pragma once

#include <bit>

#include "base/hash.h"
#include "samplers/sampler.h"

namespace alhazen {

inline constexpr int max_pixel_samples = 1 << 24;

/// How a Sobol' sequence's points are made random without losing their even spread.
enum class Randomization {
    none,
    permutedigits, ///< each binary digit flipped or not, alike for all points
    fastowen,      ///< Owen scrambling by a hash (Laine and Karras 2011)
    owen,          ///< Owen scrambling, each digit's flip chosen by all digits before it (Owen 1995)
};
template <>
struct EnumNames<Randomization> {
    static constexpr std::array names{"none", "permutedigits", "fastowen", "owen"};
};

/// A sampler with a number of samples per pixel and a seed.
struct CountedSampler : Sampler {
    int pixelsamples = 16;
    int seed = 0;

    int samples_per_pixel() const override { return pixelsamples; }
    /// What every kind needs; those that need more do this first.
    void prepare(Vec2i /*resolution*/, int samples_per_pixel, std::uint64_t seed_of_render) override {
        pixelsamples = samples_per_pixel;
        seed_ = full_seed(seed_of_render);
    }

  protected:
    template <class T>
    static void describe_count(Fields<T>& f, std::string meaning = "samples taken in each pixel") {
        f.field("pixelsamples", &T::pixelsamples, std::move(meaning)).in(1, max_pixel_samples);
    }
    template <class T>
    static void describe_seed(Fields<T>& f) {
        f.field("seed", &T::seed, "another number gives another, equally good, set of random choices");
    }
    /// The scene's seed and the command line's as one.
    std::uint64_t full_seed(std::uint64_t seed_of_render) const {
        return hash_of(static_cast<std::uint64_t>(static_cast<std::uint32_t>(seed)), seed_of_render);
    }

    std::uint64_t seed_ = full_seed(0);
};

/// A pixel as one number.
inline std::uint64_t pixel_key(Vec2i pixel) {
    return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(pixel.y)) << 32) |
           static_cast<std::uint32_t>(pixel.x);
}
/// A fresh hash for the i-th use of a key.
inline std::uint64_t sub_key(std::uint64_t key, std::uint64_t i) {
    return mix_bits(key + (i + 1) * 0x9e3779b97f4a7c15u);
}
/// Two independent numbers in [0, 1) of one hash.
inline Vec2 unit_pair(std::uint64_t h) {
    return {unit_float(static_cast<std::uint32_t>(h >> 32)), unit_float(static_cast<std::uint32_t>(h))};
}
/// Keep the keys of a pixel's column and row apart from those of dimensions.
inline constexpr std::uint64_t column_salt = 0xbb67ae8584caa73bu, row_salt = 0x3c6ef372fe94f82bu;

/// Smallest b with 2^b >= n; n > 0.
inline int log2_ceil(int n) {
    return static_cast<int>(std::bit_width(static_cast<unsigned>(n) - 1));
}

/// Where i goes in a random order of 0 ... n - 1 that key chooses (i < n): a bijection on the next power of
/// two is walked until it comes back inside n, then the order is turned by a random amount. Constant memory
/// (the idea is Kensler's 2013, "Correlated multi-jittered sampling").
inline std::uint32_t permuted_index(std::uint32_t i, std::uint32_t n, std::uint64_t key) {
    if (n <= 1) return 0;
    const int bits = static_cast<int>(std::bit_width(n - 1));
    const std::uint32_t mask = bits == 32 ? ~0u : (1u << bits) - 1;
    const int shift = std::max(1, bits / 2);
    const std::uint64_t k1 = mix_bits(key), k2 = mix_bits(key ^ 0x6a09e667f3bcc909u);
    auto round = [&](std::uint32_t add, std::uint32_t factor) {
        // Each step can be undone modulo 2^bits.
        i = (i + add) & mask;
        i ^= i >> shift;
        i = (i * (factor | 1)) & mask;
        i ^= i >> 1;
    };
    do {
        round(static_cast<std::uint32_t>(k1), static_cast<std::uint32_t>(k1 >> 32));
        round(static_cast<std::uint32_t>(k2), static_cast<std::uint32_t>(k2 >> 32));
        round(static_cast<std::uint32_t>(k1 >> 16), static_cast<std::uint32_t>(k2 >> 16));
        round(static_cast<std::uint32_t>(k2 >> 48), static_cast<std::uint32_t>(k1 >> 8));
    } while (i >= n);
    const auto turn = static_cast<std::uint32_t>(mix_bits(k1 + k2) % n);
    return i < n - turn ? i + turn : i - (n - turn);
}

} // namespace alhazen
