/// Loops over threads: every index once, sums that do not depend on the threads, locks held around a loop.
#include "base/threads.h"

#include <atomic>
#include <mutex>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace alhazen {
namespace {

// More threads than most machines of a test have cores, so that they take turns in odd ways.
constexpr int many_threads = 4;

TEST(Threads, ALoopTakesEveryIndexOnce) {
    for (const std::size_t count : std::vector<std::size_t>{0, 1, 7, 1000})
        for (const std::size_t grain : std::vector<std::size_t>{0, 1, 3, 5000}) {
            std::vector<int> times(count);
            with_threads(many_threads,
                         [&] { parallel_for(count, grain, [&](std::size_t i) { ++times[i]; }); });
            EXPECT_THAT(times, ::testing::Each(1)) << count << " in runs of " << grain;
        }
}

TEST(Threads, RangesStartAtMultiplesOfTheGrain) {
    std::vector<int> times(1001);
    with_threads(many_threads, [&] {
        parallel_ranges(times.size(), 10, [&](std::size_t begin, std::size_t end) {
            EXPECT_EQ(begin % 10, 0u);
            EXPECT_EQ(end, std::min<std::size_t>(begin + 10, 1001));
            for (std::size_t i = begin; i < end; ++i) ++times[i];
        });
    });
    EXPECT_THAT(times, ::testing::Each(1));
}

// Sums of floats depend on their order: 0.1 a thousand times, in parts.
TEST(Threads, ASumIsTheSameOnAnyNumberOfThreads) {
    auto sum_on = [](int threads) {
        float sum = 0;
        with_threads(threads, [&] {
            sum = parallel_sum(
                1000, 7, 0.0f,
                [](float& s, std::size_t begin, std::size_t end) {
                    for (std::size_t i = begin; i < end; ++i) s += 0.1f * static_cast<float>(i % 3);
                },
                [](float& s, float part) { s += part; });
        });
        return sum;
    };
    float one = sum_on(1);
    EXPECT_NEAR(one, 99.9f, 1e-3f); // 333 of 0.1 and of 0.2
    for (int repeat = 0; repeat < 20; ++repeat)
        for (int threads : {2, 3, many_threads}) EXPECT_EQ(sum_on(threads), one);
}

TEST(Threads, PartsAreJoinedFromFirstToLast) {
    std::string letters;
    with_threads(many_threads, [&] {
        letters = parallel_sum(
            26, 4, std::string(),
            [](std::string& s, std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) s += static_cast<char>('a' + i);
            },
            [](std::string& s, const std::string& part) { s += part; });
    });
    EXPECT_EQ(letters, "abcdefghijklmnopqrstuvwxyz");
}

TEST(Threads, BothAreInvoked) {
    int first = 0, second = 0;
    with_threads(many_threads, [&] { parallel_invoke([&] { first = 1; }, [&] { second = 2; }); });
    EXPECT_EQ(first, 1);
    EXPECT_EQ(second, 2);
}

// A thread that waited for its ranges and meanwhile took up another turn of the outer loop would lock twice.
TEST(Threads, ALockMayBeHeldAroundRanges) {
    std::mutex mutex;
    std::vector<int> times(100);
    with_threads(many_threads, [&] {
        parallel_for(64, 1, [&](std::size_t) {
            std::scoped_lock lock(mutex);
            parallel_ranges(times.size(), 1, [&](std::size_t begin, std::size_t) { ++times[begin]; });
        });
    });
    EXPECT_THAT(times, ::testing::Each(64));
}

TEST(Threads, WhatABodyThrowsReachesTheCaller) {
    EXPECT_THROW(with_threads(many_threads,
                              [] {
                                  parallel_for(100, 1, [](std::size_t i) {
                                      if (i == 50) throw std::runtime_error("fifty");
                                  });
                              }),
                 std::runtime_error);
}

} // namespace
} // namespace alhazen
