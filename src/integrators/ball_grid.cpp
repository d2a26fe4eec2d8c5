#include "integrators/ball_grid.h"

#include <algorithm>
#include <atomic>
#include <bit>

#include "base/threads.h"

namespace alhazen {

template <class Visit>
void BallGrid::for_each_key(const Ball3& ball, const Visit& visit) {
    if (!(ball.radius > 0)) return;
    const int level = level_of(ball.radius);
    const Cell lo = cell_of(ball.center - Vec3(ball.radius), level),
               hi = cell_of(ball.center + Vec3(ball.radius), level);
    for (std::int64_t z = lo.z; z <= hi.z; ++z)
        for (std::int64_t y = lo.y; y <= hi.y; ++y)
            for (std::int64_t x = lo.x; x <= hi.x; ++x) visit(key_of(level, {x, y, z}));
}

// Counted, then filled in: within a bucket in whatever order threads come.
void BallGrid::build(std::span<const Ball3> balls) {
    constexpr std::size_t grain = 4096;
    balls_.assign(balls.begin(), balls.end());
    levels_.clear();
    for (const Ball3& ball : balls_)
        if (ball.radius > 0) levels_.push_back(level_of(ball.radius));
    std::sort(levels_.begin(), levels_.end());
    levels_.erase(std::unique(levels_.begin(), levels_.end()), levels_.end());

    const std::size_t buckets = std::bit_ceil(2 * balls.size() + 1);
    mask_ = buckets - 1;
    starts_.assign(buckets + 1, 0);
    auto for_all = [&](const auto& visit) {
        parallel_ranges(balls_.size(), grain, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                for_each_key(balls_[i],
                             [&](std::uint64_t key) { visit(key, static_cast<std::uint32_t>(i)); });
        });
    };
    for_all([&](std::uint64_t key, std::uint32_t) {
        std::atomic_ref(starts_[key & mask_]).fetch_add(1, std::memory_order_relaxed);
    });
    std::uint32_t sum = 0;
    for (std::uint32_t& start : starts_) start = (sum += start);
    // Each start is its bucket's end now, and goes back to the beginning as the bucket fills.
    entries_.resize(sum);
    for_all([&](std::uint64_t key, std::uint32_t ball) {
        const std::uint32_t place =
            std::atomic_ref(starts_[key & mask_]).fetch_sub(1, std::memory_order_relaxed) - 1;
        entries_[place] = {key, ball};
    });
}

} // namespace alhazen
