/// Balls in a hashed grid, to be asked which of them hold a point. Each ball is in a grid as coarse as it is
/// large, so that it is in eight cells at most, and a point looks into one cell for each size that there is
/// (a hierarchical spatial hash, Eitz and Lixu 2007).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/hash.h"
#include "base/vec.h"

namespace alhazen {

struct Ball3 {
    Vec3 center;
    float radius = 0; ///< 0: no ball
};

class BallGrid {
  public:
    /// Replaces the balls; radii must be finite. On the threads of the enclosing with_threads.
    void build(std::span<const Ball3> balls);

    /// visit(i) for each ball i that holds the point, in an order that is not defined.
    template <class Visit>
    void for_each(Vec3 p, const Visit& visit) const {
        for (int level : levels_) {
            const std::uint64_t key = key_of(level, cell_of(p, level));
            const std::size_t bucket = key & mask_;
            for (std::uint32_t i = starts_[bucket]; i < starts_[bucket + 1]; ++i) {
                if (entries_[i].key != key) continue;
                const Ball3& ball = balls_[entries_[i].ball];
                if (length_squared(p - ball.center) <= sqr(ball.radius)) visit(entries_[i].ball);
            }
        }
    }

  private:
    struct Cell {
        std::int64_t x, y, z;
    };
    struct Entry {
        std::uint64_t key;
        std::uint32_t ball;
    };

    /// Cells of a level have the side 2^level: at least the diameters of its balls.
    static int level_of(float radius) { return std::ilogb(radius) + 2; }
    static Cell cell_of(Vec3 p, int level) {
        auto along = [&](float v) {
            return static_cast<std::int64_t>(
                std::clamp(std::floor(std::ldexp(static_cast<double>(v), -level)), -0x1p62, 0x1p62));
        };
        return {along(p.x), along(p.y), along(p.z)};
    }
    static std::uint64_t key_of(int level, Cell c) { return hash_of(level, c.x, c.y, c.z); }
    template <class Visit>
    static void for_each_key(const Ball3& ball, const Visit& visit);

    std::vector<Ball3> balls_;
    std::vector<int> levels_;
    std::uint64_t mask_ = 0;
    std::vector<std::uint32_t> starts_; ///< of the buckets' entries, and the end
    std::vector<Entry> entries_;
};

} // namespace alhazen
