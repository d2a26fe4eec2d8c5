// The numbers that Markov chains of paths are made of.
#include "integrators/chain_numbers.h"

#include <gtest/gtest.h>

namespace alhazen {
namespace {

std::vector<float> read(const ChainNumbers& numbers, int count, std::uint32_t from = 0) {
    SampleStream stream(numbers, {}, 0);
    stream.skip(from);
    std::vector<float> values;
    for (int i = 0; i < count; ++i) values.push_back(stream.next1());
    return values;
}

TEST(ChainNumbers, AreTheSameUntilAStepIsTaken) {
    ChainNumbers numbers(1, 2, 0.01f);
    const auto first = read(numbers, 20);
    EXPECT_EQ(read(numbers, 20), first);
    EXPECT_EQ(read(numbers, 5, 3), std::vector<float>(first.begin() + 3, first.begin() + 8));
    SampleStream pairs(numbers, {}, 0);
    EXPECT_EQ(pairs.next2(), Vec2(first[0], first[1]));
    for (float v : first) EXPECT_TRUE(v >= 0 && v < 1);
    EXPECT_EQ(read(ChainNumbers(1, 7, 0.3f), 20), first); // other steps, the same beginning
    EXPECT_NE(read(ChainNumbers(2, 2, 0.01f), 20), first);
}

TEST(ChainNumbers, RejectionTakesEverythingBack) {
    ChainNumbers numbers(1, 2, 0.05f);
    auto current = read(numbers, 10);
    int larger = 0;
    for (int i = 0; i < 200; ++i) {
        numbers.propose(0.3f);
        const auto proposed = read(numbers, 10 + i % 7);
        ASSERT_NE(std::vector<float>(proposed.begin(), proposed.begin() + 10), current);
        larger += std::abs(proposed[0] - current[0]) > 0.2f && std::abs(proposed[0] - current[0]) < 0.8f;
        if (i % 3 == 0) {
            numbers.accept();
            current.assign(proposed.begin(), proposed.begin() + 10);
        } else {
            numbers.reject();
        }
        ASSERT_EQ(read(numbers, 10), current) << i;
    }
    EXPECT_GT(larger, 10); // large steps, of which a third are so large
    EXPECT_LT(larger, 60);
}

// A number that nobody asks for through n accepted small steps has moved by sigma sqrt(n).
TEST(ChainNumbers, UnreadNumbersMoveAllTheSame) {
    constexpr float sigma = 0.01f;
    constexpr int steps = 9, count = 4000;
    double asked = 0, unasked = 0;
    ChainNumbers numbers(1, 2, sigma);
    const auto before = read(numbers, 2 * count);
    for (int i = 0; i < steps; ++i) {
        numbers.propose(0);
        read(numbers, count);
        numbers.accept();
    }
    const auto after = read(numbers, 2 * count);
    for (std::size_t i = 0; i < 2 * count; ++i) {
        double d = static_cast<double>(after[i] - before[i]);
        d -= std::round(d); // around the ends
        (i < count ? asked : unasked) += d * d / count;
    }
    // The variance's own standard deviation is sqrt(2 / 4000) = 2.2 %. The last step is not taken for unasked
    // numbers before it is asked for: they are read at its time, so all steps count.
    EXPECT_NEAR(asked / static_cast<double>(sigma * sigma * steps), 1, 0.15);
    EXPECT_NEAR(unasked / static_cast<double>(sigma * sigma * steps), 1, 0.15);
}

TEST(ChainNumbers, LargeStepsReachNumbersThatAreReadLater) {
    ChainNumbers numbers(1, 2, 0.0f);
    const auto before = read(numbers, 4);
    numbers.propose(1);
    read(numbers, 2);
    numbers.accept();
    numbers.propose(0);
    const auto after = read(numbers, 4);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NE(after[i], before[i]) << i;
}

// Metropolis sampling of 2 x over [0, 1] by one number: the mean is 2/3. Chains of 200 steps, whose means are
// independent; five standard deviations.
TEST(ChainNumbers, SampleWhatTheyAreKeptFor) {
    double sum = 0, squares = 0;
    constexpr int chains = 2000;
    for (std::uint64_t c = 0; c < chains; ++c) {
        ChainNumbers numbers(c, c + 1000000, 0.05f);
        double mean = 0;
        float current = read(numbers, 1)[0];
        for (int i = 0; i < 400; ++i) {
            numbers.propose(0.2f);
            const float proposed = read(numbers, 1)[0];
            if (numbers.acceptance() * current < proposed) {
                numbers.accept();
                current = proposed;
            } else {
                numbers.reject();
            }
            if (i >= 200) mean += static_cast<double>(current) / 200;
        }
        sum += mean / chains;
        squares += mean * mean / chains;
    }
    EXPECT_NEAR(sum, 2 / 3.0, 5 * std::sqrt((squares - sum * sum) / chains));
}

} // namespace
} // namespace alhazen
