#include <gtest/gtest.h>

#include <algorithm>

#include "accel/build/morton.h"
#include "base/threads.h"
#include "tests/unit/accel/support.h"

namespace alhazen {
namespace {

using namespace accel_test;

TEST(Morton, BitsOfTheCoordinatesTakeTurns) {
    EXPECT_EQ(morton_code(0, 0, 1), 1u);
    EXPECT_EQ(morton_code(0, 1, 0), 2u);
    EXPECT_EQ(morton_code(1, 0, 0), 4u);
    EXPECT_EQ(morton_code(0b101, 0b011, 0b110), 0b101011110u);
    Rng rng(1);
    for (int i = 0; i < 100; ++i) {
        std::uint32_t cell[3] = {rng.below(1u << 21), rng.below(1u << 21), rng.below(1u << 21)};
        std::uint64_t expected = 0;
        for (int bit = 0; bit < 21; ++bit)
            for (int axis = 0; axis < 3; ++axis)
                expected |= static_cast<std::uint64_t>(cell[axis] >> bit & 1) << (3 * bit + 2 - axis);
        EXPECT_EQ(morton_code(cell[0], cell[1], cell[2]), expected);
        for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(gather_bits(expected >> (2 - axis)), cell[axis]);
    }
}

TEST(Morton, TheGridsCellsAreCubes) {
    MortonGrid grid({{0, 0, 0}, {8, 2, 1}}, 3);
    EXPECT_EQ(grid.code({0, 0, 0}), 0u);
    EXPECT_EQ(grid.code({8, 2, 1}), morton_code(7, 2, 1));
    EXPECT_EQ(grid.code({3.5f, 1.5f, 0.5f}), morton_code(3, 1, 0));
    EXPECT_EQ(grid.lower_side(morton_code(3, 1, 0), 0), 3);
    EXPECT_EQ(grid.lower_side(morton_code(3, 1, 0), 1), 1);
    EXPECT_EQ(grid.lower_side(morton_code(3, 1, 0), 2), 0);
    // Neither boxes without extent nor those whose extent is no float upset it.
    EXPECT_EQ(MortonGrid({{1, 2, 3}, {1, 2, 3}}, 21).code({1, 2, 3}), 0u);
    MortonGrid huge({{-3e38f, -3e38f, 0}, {3e38f, 3e38f, 1}}, 21);
    EXPECT_EQ(huge.code({3e38f, 0, 1}), morton_code((1 << 21) - 1, 1 << 20, 0));
}

TEST(Morton, KeysAreOfTheBoxesThatAreNotEmpty) {
    std::vector<Bounds3> boxes(50000);
    for (std::size_t i = 0; i < boxes.size(); i += 3) {
        auto x = static_cast<float>(i);
        boxes[i] = {{x, 0, 0}, {x, 0, 0}};
    }
    auto keys = morton_keys(boxes);
    ASSERT_EQ(keys.size(), 16667u);
    for (std::size_t k = 0; k < keys.size(); ++k) {
        ASSERT_EQ(keys[k].index, 3 * k);
        if (k > 0) {
            ASSERT_GT(keys[k].code, keys[k - 1].code);
        }
    }
    EXPECT_TRUE(morton_keys(std::vector<Bounds3>(10)).empty());
    EXPECT_TRUE(morton_keys({}).empty());
}

TEST(Morton, SortingIsStableWhateverTheThreads) {
    Rng rng(2);
    // All bits differ; only some in the middle do; all codes are the same.
    for (std::uint64_t mask : {~0ull, 0xff00ff0000ull, 0ull})
        for (std::size_t count : {0u, 1u, 1000u, 200000u}) {
            std::vector<MortonKey> keys(count);
            for (std::size_t i = 0; i < count; ++i) {
                std::uint64_t high = rng.below(1u << 31);
                keys[i] = {(high << 32 | rng.below(1u << 31)) & mask, static_cast<std::uint32_t>(i)};
            }
            auto expected = keys;
            std::stable_sort(expected.begin(), expected.end(),
                             [](const MortonKey& a, const MortonKey& b) { return a.code < b.code; });
            for (int threads : {1, 2, 5}) {
                auto sorted = keys;
                with_threads(threads, [&] { sort_by_code(sorted); });
                EXPECT_TRUE(sorted == expected) << count << " keys, " << threads << " threads";
            }
        }
}

} // namespace
} // namespace alhazen
