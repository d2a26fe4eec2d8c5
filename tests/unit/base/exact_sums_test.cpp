#include "base/exact_sums.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/hash.h"
#include "base/threads.h"

namespace alhazen {
namespace {

/// Numbers of many sizes and both signs.
std::vector<double> mixed_numbers(std::size_t count) {
    Rng rng(3);
    std::vector<double> numbers;
    for (std::size_t i = 0; i < count; ++i) {
        const double size =
            std::ldexp(1.0 + static_cast<double>(rng.uniform()), static_cast<int>(rng.below(60)) - 30);
        numbers.push_back(rng.uniform() < 0.4f ? -size : size);
    }
    return numbers;
}

TEST(ExactSums, AddUp) {
    ExactSums sums(3);
    long double expected = 0;
    for (double v : mixed_numbers(100000)) {
        sums.add(1, v);
        expected += static_cast<long double>(v);
    }
    EXPECT_NEAR(sums.sum(1) / static_cast<double>(expected), 1, 1e-12);
    EXPECT_EQ(sums.sum(0), 0);
    EXPECT_EQ(sums.sum(2), 0);
}

TEST(ExactSums, CarryBothWays) {
    ExactSums sums(1);
    // Past the middle of the low word's range, and back through zero to the other side.
    for (int i = 0; i < 1000; ++i) sums.add(0, 3.75);
    EXPECT_EQ(sums.sum(0), 3750);
    for (int i = 0; i < 2000; ++i) sums.add(0, -3.75);
    EXPECT_EQ(sums.sum(0), -3750);
    sums.add(0, 3750);
    EXPECT_EQ(sums.sum(0), 0);
    for (double v : {4.0, -4.0, 15.999, -15.999, 16.0, -16.0, 1e15, -1e15, 1e-15, -1e-15}) {
        sums.reset();
        sums.add(0, v);
        EXPECT_NEAR(sums.sum(0) / v, 1, 1e-3) << v;
    }
    sums.reset();
    sums.add(0, 1e30);
    EXPECT_GT(sums.sum(0), 1e15);
    EXPECT_TRUE(std::isfinite(sums.sum(0)));
}

TEST(ExactSums, AreTheSameInAnyOrderAndFromAnyThreads) {
    const std::vector<double> numbers = mixed_numbers(40000);
    ExactSums forward(4), backward(4), threaded(4);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        forward.add(i % 4, numbers[i]);
        const std::size_t j = numbers.size() - 1 - i;
        backward.add(j % 4, numbers[j]);
    }
    with_threads(
        4, [&] { parallel_for(numbers.size(), 7, [&](std::size_t i) { threaded.add(i % 4, numbers[i]); }); });
    for (std::size_t k = 0; k < 4; ++k) {
        EXPECT_EQ(forward.sum(k), backward.sum(k));
        EXPECT_EQ(forward.sum(k), threaded.sum(k));
    }
}

} // namespace
} // namespace alhazen
