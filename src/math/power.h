/// Powers of floats, for one number or for lanes of them, with the same bits. Includes nothing, and leaves no
/// function behind: kernels that are compiled for several instruction sets may use it.
#pragma once

namespace alhazen {

/// x^n for lanes of doubles that hold floats, x > 0 and n finite: to within 1e-9 of it, relatively, where it
/// is a normal float. D is double or a vector of doubles, L long long or a vector of as many.
template <class D, class L>
[[gnu::always_inline]] inline D power_of_lanes(D x, D n) {
    // x = 2^e m with sqrt(1/2) <= m < sqrt(2); log2(m) by the series of artanh((m - 1) / (m + 1)).
    constexpr long long root_half = 0x3fe6a09e667f3bcdLL;
    // A double around 3 * 2^51 has whole numbers in its low bits.
    constexpr double whole = 0x1.8p52;
    constexpr long long whole_bits = 0x4338000000000000LL;
    const L bits = __builtin_bit_cast(L, x), e = (bits - root_half) >> 52;
    const D m = __builtin_bit_cast(D, bits - e * (1LL << 52));
    const D z = (m - 1) / (m + 1), z2 = z * z;
    // Sums in pairs, so that fewer operations wait for each other.
    const D z4 = z2 * z2;
    const D series = (z2 * (2 / 3.0) + 2) + (z2 * (2 / 7.0) + 2 / 5.0) * z4 +
                     ((z2 * (2 / 11.0) + 2 / 9.0) + z4 * (2 / 13.0)) * (z4 * z4);
    constexpr double log2_of_e = 1.4426950408889634, ln_of_2 = 0.6931471805599453;
    D y = ((__builtin_bit_cast(D, e + whole_bits) - whole) + series * z * log2_of_e) * n;
    // Beyond these, floats are 0 or infinite.
    y = y < -1000 ? D{} - 1000 : y;
    y = y > 1000 ? D{} + 1000 : y;
    // 2^y = 2^i e^f
    const D shifted = y + whole, f = (y - (shifted - whole)) * ln_of_2;
    const D f2 = f * f, f4 = f2 * f2;
    const D low = (f + 1) + (f * (1 / 6.0) + 1 / 2.0) * f2;
    const D middle = (f * (1 / 120.0) + 1 / 24.0) + (f * (1 / 5040.0) + 1 / 720.0) * f2;
    const D high = (f * (1 / 362880.0) + 1 / 40320.0) + f2 * (1 / 3628800.0);
    const D power = low + middle * f4 + high * (f4 * f4);
    const L scale = (__builtin_bit_cast(L, shifted) - whole_bits + 1023) * (1LL << 52);
    return power * __builtin_bit_cast(D, scale);
}

/// x^n of floats, x > 0, n finite: the float nearest to it, or once in ten million times its neighbour.
[[gnu::always_inline]] inline float power(float x, float n) {
    return static_cast<float>(
        power_of_lanes<double, long long>(static_cast<double>(x), static_cast<double>(n)));
}

} // namespace alhazen
