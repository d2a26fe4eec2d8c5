#include "samplers/sobol_sequence.h"

#include <set>

#include <gtest/gtest.h>

#include "tests/support/density_test.h"

namespace alhazen {
namespace {

using testing_support::chi_square_test;
using testing_support::p_threshold;

TEST(SobolMatrices, FirstTwoDimensionsHaveClosedForms) {
    const SobolMatrices& m = SobolMatrices::get();
    Rng rng(1);
    for (int i = 0; i < 1000; ++i) {
        std::uint64_t index = (std::uint64_t{rng.next()} << 32) | rng.next();
        EXPECT_EQ(m.reversed(index, 0), static_cast<std::uint32_t>(sobol_first(index)));
        EXPECT_EQ(m.reversed(index, 1), static_cast<std::uint32_t>(sobol_second(index)));
    }
}

TEST(SobolMatrices, KnownPoints) {
    // Worked by hand from the direction numbers 1; 1, 3; 1, 3, 1 of dimensions 2, 3 and 4.
    const SobolMatrices& m = SobolMatrices::get();
    auto value = [&](std::uint64_t index, int d) { return unit_float(reverse_bits(m.reversed(index, d))); };
    const float expected[4][4] = {
        {0, 0, 0, 0}, {.5f, .5f, .5f, .5f}, {.25f, .75f, .75f, .75f}, {.75f, .25f, .25f, .25f}};
    for (std::uint64_t i = 0; i < 4; ++i)
        for (int d = 0; d < 4; ++d) EXPECT_EQ(value(i, d), expected[i][d]) << i << " " << d;
    EXPECT_EQ(value(4, 0), 0.125f);
    EXPECT_EQ(value(4, 1), 0.625f);
    EXPECT_EQ(value(4, 2), 0.375f); // m_3 = 2 m_2 ^ 4 m_1 ^ m_1 = 6 ^ 4 ^ 1 = 3, so 3 / 8
    EXPECT_EQ(value(4, 3), 0.125f); // m_3 = 1
}

TEST(SobolMatrices, EveryDimensionIsStratified) {
    const SobolMatrices& m = SobolMatrices::get();
    for (int d = 0; d < SobolMatrices::dimensions; ++d) {
        std::vector<bool> seen(1024);
        for (std::uint64_t i = 0; i < 1024; ++i) seen[reverse_bits(m.reversed(i, d)) >> 22] = true;
        ASSERT_EQ(std::count(seen.begin(), seen.end(), true), 1024) << "dimension " << d;
    }
}

// Owen scrambling keeps numbers that share their first k digits together, for every k, and parts those that
// do not.
TEST(OwenScrambling, KeepsElementaryIntervals) {
    auto fast = [](std::uint32_t v, std::uint32_t seed) {
        return reverse_bits(hash_owen(reverse_bits(v), seed));
    };
    Rng rng(2);
    for (int i = 0; i < 2000; ++i) {
        std::uint32_t a = rng.next(), seed = rng.next();
        const int k = static_cast<int>(rng.below(24));
        std::uint32_t b = a ^ (0x80000000u >> k); // shares exactly k digits
        for (auto scrambled : {+fast, &exact_owen}) {
            std::uint32_t difference = scrambled(a, seed) ^ scrambled(b, seed);
            EXPECT_EQ(std::countl_zero(difference), k);
        }
    }
}

TEST(OwenScrambling, MakesEachNumberUniform) {
    for (auto r : {Randomization::fastowen, Randomization::owen, Randomization::permutedigits})
        for (std::uint32_t v : {0u, 1u, 0xffffu, 0x80000000u}) {
            std::vector<double> counts(64), expected(64, 20000 / 64.0);
            for (std::uint64_t i = 0; i < 20000; ++i)
                counts[static_cast<std::size_t>(
                    64 * randomized_float(r, v, static_cast<std::uint32_t>(mix_bits(i))))] += 1;
            EXPECT_GT(chi_square_test(counts, expected).p_value, p_threshold)
                << static_cast<int>(r) << " " << v;
        }
}

TEST(PermutedIndex, IsAPermutation) {
    for (std::uint32_t n = 1; n < 150; ++n)
        for (std::uint64_t key = 0; key < 5; ++key) {
            std::set<std::uint32_t> seen;
            for (std::uint32_t i = 0; i < n; ++i) seen.insert(permuted_index(i, n, mix_bits(key)));
            ASSERT_EQ(seen.size(), n);
            ASSERT_LT(*seen.rbegin(), n);
        }
}

TEST(PermutedIndex, SendsEachThingAndPairEverywhere) {
    for (std::uint32_t n : {2u, 3u, 5u, 8u, 16u, 17u}) {
        const std::size_t size = n;
        std::vector<double> single(size * size), pair(size * size);
        std::vector<double> single_expected(size * size), pair_expected(size * size);
        const int rounds = 40000;
        for (int i = 0; i < rounds; ++i) {
            std::uint64_t key = mix_bits(static_cast<std::uint64_t>(i));
            for (std::uint32_t j = 0; j < n; ++j) {
                single[j * size + permuted_index(j, n, key)] += 1;
                single_expected[j * size + permuted_index(j, n, key)] = 0;
            }
            pair[permuted_index(0, n, key) * size + permuted_index(n - 1, n, key)] += 1;
        }
        for (std::size_t a = 0; a < size; ++a)
            for (std::size_t b = 0; b < size; ++b) {
                single_expected[a * size + b] = static_cast<double>(rounds) / n;
                pair_expected[a * size + b] = a == b ? 0 : static_cast<double>(rounds) / (n * (n - 1));
            }
        EXPECT_GT(chi_square_test(single, single_expected).p_value, p_threshold) << n;
        EXPECT_GT(chi_square_test(pair, pair_expected).p_value, p_threshold) << n;
    }
}

} // namespace
} // namespace alhazen
