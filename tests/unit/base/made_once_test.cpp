/// What is made once: how often, for whom, and what happens when it fails.
#include "base/made_once.h"

#include <atomic>
#include <condition_variable>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/threads.h"

namespace alhazen {
namespace {

using Squares = MadeOnce<int, int>;

std::shared_ptr<const int> square(int x) {
    return std::make_shared<const int>(x * x);
}

TEST(MadeOnce, IsSharedByAKeyAlone) {
    Squares squares;
    EXPECT_EQ(squares.find(3), nullptr);
    const auto nine = squares.get(3, [] { return square(3); });
    EXPECT_EQ(*nine, 9);
    EXPECT_EQ(squares.get(3, [] { return square(100); }), nine);
    EXPECT_EQ(squares.find(3), nine);
    EXPECT_EQ(*squares.get(2, [] { return square(2); }), 4);
    std::vector<int> seen;
    squares.for_each([&](int s) { seen.push_back(s); });
    EXPECT_THAT(seen, ::testing::ElementsAre(4, 9));
}

TEST(MadeOnce, WhatIsForgottenIsMadeAnewAndStaysWithWhoHoldsIt) {
    Squares squares;
    const auto nine = squares.get(3, [] { return square(3); });
    squares.get(2, [] { return square(2); });
    squares.forget(3);
    EXPECT_EQ(squares.find(3), nullptr);
    EXPECT_NE(squares.find(2), nullptr);
    EXPECT_EQ(*nine, 9);
    EXPECT_NE(squares.get(3, [] { return square(3); }), nine);
    squares.forget_all();
    EXPECT_EQ(squares.find(2), nullptr);
    EXPECT_EQ(squares.find(3), nullptr);
}

TEST(MadeOnce, AFailureIsToldToEachWhoAsks) {
    Squares squares;
    int asked = 0;
    auto fail = [&]() -> std::shared_ptr<const int> {
        ++asked;
        throw std::runtime_error("no");
    };
    for (int i = 0; i < 3; ++i) EXPECT_THROW(squares.get(1, fail), std::runtime_error);
    EXPECT_EQ(asked, 3);
    EXPECT_EQ(squares.find(1), nullptr);
    squares.for_each([](int) { ADD_FAILURE(); });
    EXPECT_EQ(*squares.get(1, [] { return square(1); }), 1);
}

TEST(MadeOnce, ThreadsMakeItOnce) {
    Squares squares;
    std::atomic<int> made = 0;
    std::vector<std::shared_ptr<const int>> found(200);
    with_threads(4, [&] {
        parallel_for(found.size(), 1, [&](std::size_t i) {
            const int x = static_cast<int>(i) % 2;
            found[i] = squares.get(x, [&] {
                ++made;
                std::atomic<int> sum = 0;
                parallel_ranges(64, 1, [&](std::size_t, std::size_t) { ++sum; });
                return square(10 * x + sum);
            });
        });
    });
    EXPECT_EQ(made, 2);
    for (std::size_t i = 0; i < found.size(); ++i) EXPECT_EQ(found[i], found[i % 2]);
    EXPECT_EQ(*found[0], 64 * 64);
    EXPECT_EQ(*found[1], 74 * 74);
}

// Each of the two is made only when the other is being made, so neither would be if one waited for the other.
TEST(MadeOnce, OtherKeysDoNotWait) {
    Squares squares;
    std::mutex mutex;
    std::condition_variable changed;
    int under_way = 0;
    auto make = [&](int x) {
        std::unique_lock lock(mutex);
        ++under_way;
        changed.notify_all();
        EXPECT_TRUE(changed.wait_for(lock, std::chrono::seconds(60), [&] { return under_way == 2; }));
        return square(x);
    };
    std::thread other([&] { squares.get(1, [&] { return make(1); }); });
    squares.get(2, [&] { return make(2); });
    other.join();
    EXPECT_EQ(*squares.find(1), 1);
    EXPECT_EQ(*squares.find(2), 4);
}

} // namespace
} // namespace alhazen
