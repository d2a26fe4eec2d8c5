/// The Sobol' sequence (Sobol' 1967) and its scramblings. A point's coordinate is the product of a binary
/// matrix with the digits of the point's number. Numbers here are kept "reversed": bit 0 is the first digit
/// after the point, since the first two matrices and the fast scrambling are simplest that way; randomize()
/// turns them back.
#pragma once

#include <vector>

#include "samplers/common.h"

namespace alhazen {

constexpr std::uint32_t reverse_bits(std::uint32_t v) {
    v = ((v >> 1) & 0x55555555u) | ((v & 0x55555555u) << 1);
    v = ((v >> 2) & 0x33333333u) | ((v & 0x33333333u) << 2);
    v = ((v >> 4) & 0x0f0f0f0fu) | ((v & 0x0f0f0f0fu) << 4);
    return __builtin_bswap32(v);
}
constexpr std::uint64_t reverse_bits(std::uint64_t v) {
    v = ((v >> 1) & 0x5555555555555555u) | ((v & 0x5555555555555555u) << 1);
    v = ((v >> 2) & 0x3333333333333333u) | ((v & 0x3333333333333333u) << 2);
    v = ((v >> 4) & 0x0f0f0f0f0f0f0f0fu) | ((v & 0x0f0f0f0f0f0f0f0fu) << 4);
    return __builtin_bswap64(v);
}

/// The second dimension, reversed, in 64 digits: its matrix is Pascal's triangle modulo 2, digit i being the
/// sum of C(j, i) over the set bits j. By Lucas' theorem that splits into one step a bit of j.
constexpr std::uint64_t sobol_second(std::uint64_t index) {
    index ^= (index >> 1) & 0x5555555555555555u;
    index ^= (index >> 2) & 0x3333333333333333u;
    index ^= (index >> 4) & 0x0f0f0f0f0f0f0f0fu;
    index ^= (index >> 8) & 0x00ff00ff00ff00ffu;
    index ^= (index >> 16) & 0x0000ffff0000ffffu;
    return index ^ (index >> 32);
}
/// The first dimension, reversed: van der Corput's sequence.
constexpr std::uint64_t sobol_first(std::uint64_t index) {
    return index;
}

/// A permutation of the reversed fraction in which each digit depends on the digits before it only: a good
/// approximation of Owen scrambling (Laine and Karras 2011, with the constants of Vegdahl 2021, "Building a
/// better LK hash").
constexpr std::uint32_t hash_owen(std::uint32_t reversed, std::uint32_t seed) {
    std::uint32_t v = reversed;
    v ^= v * 0x3d20adeau;
    v += seed;
    v *= (seed >> 16) | 1;
    v ^= v * 0x05526c56u;
    v ^= v * 0x53a22864u;
    return v;
}
/// Owen scrambling of a fraction in usual order to 24 digits, which is all that a float shows.
std::uint32_t exact_owen(std::uint32_t fraction, std::uint32_t seed);

/// The reversed fraction as a number in [0, 1), randomized.
inline float randomized_float(Randomization r, std::uint32_t reversed, std::uint32_t seed) {
    switch (r) {
    case Randomization::none:
        break;
    case Randomization::permutedigits:
        reversed ^= seed;
        break;
    case Randomization::fastowen:
        reversed = hash_owen(reversed, seed);
        break;
    case Randomization::owen:
        return unit_float(exact_owen(reverse_bits(reversed), seed));
    }
    return unit_float(reverse_bits(reversed));
}

/// The first two dimensions' pair.
inline Vec2 sobol_pair(Randomization r, std::uint64_t index, std::uint64_t seeds) {
    const auto first = static_cast<std::uint32_t>(sobol_first(index));
    const auto second = static_cast<std::uint32_t>(sobol_second(index));
    const auto seed1 = static_cast<std::uint32_t>(seeds), seed2 = static_cast<std::uint32_t>(seeds >> 32);
    if (r != Randomization::fastowen)
        return {randomized_float(r, first, seed1), randomized_float(r, second, seed2)};
    // Both are reversed at once, and so change places.
    const std::uint64_t both = hash_owen(second, seed2) | (std::uint64_t{hash_owen(first, seed1)} << 32);
    const std::uint64_t reversed = reverse_bits(both);
    return {unit_float(static_cast<std::uint32_t>(reversed)),
            unit_float(static_cast<std::uint32_t>(reversed >> 32))};
}

/// The matrices of all dimensions, from Joe and Kuo's direction numbers (2008).
class SobolMatrices {
  public:
    static constexpr int dimensions = 1024;
    static constexpr int columns = 64;

    /// Computed at the first call, shared by all.
    static const SobolMatrices& get();

    /// Coordinate of the point's number `index`, reversed, 32 digits.
    std::uint32_t reversed(std::uint64_t index, int dimension) const {
        const std::uint32_t* column = &columns_[static_cast<std::size_t>(dimension) * columns];
        std::uint32_t v = 0;
        for (; index != 0; index &= index - 1) v ^= column[std::countr_zero(index)];
        return v;
    }

  private:
    SobolMatrices();
    std::vector<std::uint32_t> columns_; ///< reversed, `columns` a dimension
};

} // namespace alhazen
