#include "samplers/sobol_sequence.h"

#include <array>

namespace alhazen {

namespace {

constexpr std::uint16_t joe_kuo[] = {
#include "samplers/data/joe_kuo.inl"
};

using Column = std::array<std::uint64_t, SobolMatrices::columns>;

// The dimension's direction numbers as 64-digit fractions, first digit at the top (Joe and Kuo 2008, equation
// 2). Reads the polynomial and the first numbers at data, gives where the next dimension's are.
const std::uint16_t* direction_numbers(const std::uint16_t* data, Column& v) {
    const std::uint32_t polynomial = *data++;
    const int degree = static_cast<int>(std::bit_width(polynomial)) - 1;
    for (int k = 0; k < SobolMatrices::columns; ++k) {
        auto i = static_cast<std::size_t>(k);
        if (k < degree) {
            v[i] = static_cast<std::uint64_t>(*data++) << (63 - k);
            continue;
        }
        std::uint64_t before = v[i - static_cast<std::size_t>(degree)];
        v[i] = before ^ (before >> degree);
        for (int j = 1; j < degree; ++j)
            if ((polynomial >> (degree - j)) & 1) v[i] ^= v[i - static_cast<std::size_t>(j)];
    }
    return data;
}

} // namespace

std::uint32_t exact_owen(std::uint32_t fraction, std::uint32_t seed) {
    std::uint32_t flips = seed & 0x80000000u;
    for (int digit = 1; digit < 24; ++digit) {
        // The digits before this one name a node of the binary tree; its hash says whether its halves change
        // places.
        std::uint64_t node =
            (std::uint64_t{fraction >> (32 - digit)} << 6) | static_cast<std::uint64_t>(digit);
        std::uint64_t h = mix_bits((std::uint64_t{seed} << 32) ^ node);
        flips |= static_cast<std::uint32_t>(h & 1) << (31 - digit);
    }
    return fraction ^ flips;
}

SobolMatrices::SobolMatrices() : columns_(std::size_t{dimensions} * columns) {
    Column v{};
    const std::uint16_t* data = joe_kuo;
    for (std::size_t d = 0; d < dimensions; ++d) {
        if (d == 0)
            for (std::size_t k = 0; k < columns; ++k) v[k] = std::uint64_t{1} << (63 - k);
        else
            data = direction_numbers(data, v);
        for (std::size_t k = 0; k < columns; ++k)
            columns_[d * columns + k] = reverse_bits(static_cast<std::uint32_t>(v[k] >> 32));
    }
}

const SobolMatrices& SobolMatrices::get() {
    static const SobolMatrices matrices;
    return matrices;
}

} // namespace alhazen
