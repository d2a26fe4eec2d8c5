#include "math/power.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace alhazen {
namespace {

// Both are near the exact value; where they round to different floats, these are neighbours.
TEST(Power, IsTheFloatNearestToTheExactPower) {
    int different = 0, compared = 0;
    for (float x = 1e-30f; x < 1e30f; x *= 1.37f)
        for (float n : {0.0f, 1e-3f, 0.5f, 1.0f, 2.0f, 3.7f, 50.0f, 500.0f, 1e5f, -1.5f}) {
            const double exact = std::pow(static_cast<double>(x), static_cast<double>(n));
            const auto nearest = static_cast<float>(exact);
            const float found = power(x, n);
            ++compared;
            if (found == nearest) continue;
            ++different;
            EXPECT_EQ(std::nextafter(found, nearest), nearest) << x << ' ' << n;
        }
    EXPECT_LT(different, 3) << "of " << compared;
}

TEST(Power, OfNumbersNearOne) {
    int different = 0;
    for (int i = 1; i < 2000; ++i) {
        const float x = 1 - static_cast<float>(i) * 0x1p-24f * static_cast<float>(i);
        for (float n : {10.0f, 500.0f, 20000.0f}) {
            const auto nearest = static_cast<float>(std::pow(static_cast<double>(x), static_cast<double>(n)));
            const float found = power(x, n);
            if (found != nearest) ++different;
            EXPECT_LE(std::abs(found - nearest), std::abs(nearest) * 0x1p-23f) << x << ' ' << n;
        }
    }
    EXPECT_LT(different, 3);
}

TEST(Power, AtTheEndsOfTheRange) {
    EXPECT_EQ(power(1, 500), 1);
    EXPECT_EQ(power(0.5f, 3), 0.125f);
    EXPECT_EQ(power(0.25f, 0.5f), 0.5f);
    EXPECT_EQ(power(0.5f, 1e30f), 0);
    EXPECT_EQ(power(2, 1e30f), std::numeric_limits<float>::infinity());
    EXPECT_EQ(power(1e-40f, 0), 1);
    EXPECT_EQ(power(0.5f, 149), std::numeric_limits<float>::denorm_min());
}

using Two = double __attribute__((vector_size(16)));
using TwoLongs = long long __attribute__((vector_size(16)));

TEST(Power, HasTheSameBitsInLanes) {
    for (float x = 0.001f; x < 5; x += 0.0137f) {
        const Two both = power_of_lanes<Two, TwoLongs>(Two{static_cast<double>(x), 0.5}, Two{37.5, 2});
        EXPECT_EQ(both[0], (power_of_lanes<double, long long>(static_cast<double>(x), 37.5)));
        EXPECT_EQ(both[1], 0.25);
    }
}

} // namespace
} // namespace alhazen
