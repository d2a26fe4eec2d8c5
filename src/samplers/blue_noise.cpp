#include "samplers/blue_noise.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/hash.h"

namespace alhazen {

namespace {

constexpr int side = BlueNoise::side;
constexpr int radius = 7; // where the bell has fallen to 2e-5

/// The void-and-cluster method (Ulichney 1993): points in a repeating square, and around each a bell of
/// crowding.
class VoidAndCluster {
  public:
    VoidAndCluster() {
        constexpr float deviation = 1.5f;
        for (int y = -radius; y <= radius; ++y)
            for (int x = -radius; x <= radius; ++x)
                bell_[bell_index(x, y)] =
                    std::exp(-static_cast<float>(x * x + y * y) / (2 * deviation * deviation));
        rows_.resize(side);
        for (int y = 0; y < side; ++y) scan(y);
    }

    bool has(int place) const { return is_set_[at(place)]; }
    void set(int place, bool on) {
        is_set_[at(place)] = on;
        const int px = place % side, py = place / side;
        for (int dy = -radius; dy <= radius; ++dy) {
            const int y = (py + dy + side) % side;
            for (int dx = -radius; dx <= radius; ++dx) {
                float& crowding = crowding_[at(y * side + (px + dx + side) % side)];
                crowding += on ? bell_[bell_index(dx, dy)] : -bell_[bell_index(dx, dy)];
            }
            scan(y);
        }
    }
    /// The most crowded of the points.
    int cluster() const {
        int best = rows_[0].cluster;
        for (const Row& row : rows_)
            if (row.cluster >= 0 && (best < 0 || crowding_[at(row.cluster)] > crowding_[at(best)]))
                best = row.cluster;
        return best;
    }
    /// The least crowded of the free places.
    int largest_void() const {
        int best = rows_[0].empty;
        for (const Row& row : rows_)
            if (row.empty >= 0 && (best < 0 || crowding_[at(row.empty)] < crowding_[at(best)]))
                best = row.empty;
        return best;
    }

  private:
    /// The extremes of a row; -1: there is none.
    struct Row {
        int cluster = -1, empty = -1;
    };

    static std::size_t at(int place) { return static_cast<std::size_t>(place); }
    static std::size_t bell_index(int x, int y) {
        return static_cast<std::size_t>((y + radius) * (2 * radius + 1) + x + radius);
    }
    void scan(int y) {
        Row row;
        float most = -1, least = 1e9f;
        for (int place = y * side; place < (y + 1) * side; ++place) {
            const float c = crowding_[at(place)];
            if (has(place)) {
                if (c > most) {
                    most = c;
                    row.cluster = place;
                }
            } else if (c < least) {
                least = c;
                row.empty = place;
            }
        }
        rows_[at(y)] = row;
    }

    std::array<float, (2 * radius + 1) * (2 * radius + 1)> bell_{};
    std::vector<float> crowding_ = std::vector<float>(side * side);
    std::vector<std::uint8_t> is_set_ = std::vector<std::uint8_t>(side * side);
    std::vector<Row> rows_;
};

// A tenth of the places, at first by chance, then from the tightest cluster to the largest void until that is
// the same place.
std::vector<int> even_points(VoidAndCluster& pattern) {
    constexpr int count = side * side / 10;
    Rng rng(1);
    for (int i = 0; i < count;) {
        const auto place = static_cast<int>(rng.below(side * side));
        if (pattern.has(place)) continue;
        pattern.set(place, true);
        ++i;
    }
    // It ends by itself after some hundred moves; rounding might make it go in circles.
    for (int moves = 0; moves < side * side; ++moves) {
        const int from = pattern.cluster();
        pattern.set(from, false);
        const int to = pattern.largest_void();
        pattern.set(to, true);
        if (to == from) break;
    }
    std::vector<int> points;
    for (int place = 0; place < side * side; ++place)
        if (pattern.has(place)) points.push_back(place);
    return points;
}

} // namespace

// The even points get their ranks in the order in which the tightest cluster is taken away, the others in the
// order in which the largest void is filled. (With more points than voids Ulichney fills clusters of voids:
// where all bells add up to the same everywhere, that is the same.)
BlueNoise::BlueNoise() : ranks_(side * side) {
    VoidAndCluster pattern;
    const std::vector<int> points = even_points(pattern);
    VoidAndCluster shrinking = pattern;
    for (std::size_t rank = points.size(); rank-- > 0;) {
        const int place = shrinking.cluster();
        ranks_[static_cast<std::size_t>(place)] = static_cast<std::uint16_t>(rank);
        shrinking.set(place, false);
    }
    for (std::size_t rank = points.size(); rank < ranks_.size(); ++rank) {
        const int place = pattern.largest_void();
        ranks_[static_cast<std::size_t>(place)] = static_cast<std::uint16_t>(rank);
        pattern.set(place, true);
    }
}

const BlueNoise& BlueNoise::get() {
    static const BlueNoise noise;
    return noise;
}

float BlueNoise::at(Vec2i pixel, std::uint32_t dimension, std::uint32_t key) const {
    // Corners as far from each other as places of the sequence R2 (Roberts 2018): powers of the inverse of
    // the plastic number, in 32 digits.
    constexpr std::uint32_t step_x = 3242174889u, step_y = 2447445414u;
    constexpr int shift = 32 - 7;
    static_assert(side == 1 << 7);
    auto x = static_cast<std::uint32_t>(pixel.x) + ((dimension * step_x) >> shift) + (key & 0xffffu);
    auto y = static_cast<std::uint32_t>(pixel.y) + ((dimension * step_y) >> shift) + (key >> 16);
    constexpr std::uint32_t dimensions_a_turn = 48;
    const std::uint32_t turn = dimension / dimensions_a_turn;
    if (turn & 1) x = ~x;
    if (turn & 2) y = ~y;
    if (turn & 4) std::swap(x, y);
    const int rank_here = rank(static_cast<int>(x % side), static_cast<int>(y % side));
    return (static_cast<float>(rank_here) + 0.5f) / static_cast<float>(side * side);
}

} // namespace alhazen
