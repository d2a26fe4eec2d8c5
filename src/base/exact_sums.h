/// Sums of floating-point numbers that come out the same to the last bit in whatever order, and from whatever
/// threads, the numbers are added.
#pragma once

#include <atomic>
#include <cstdint>

#include "base/big_array.h"

namespace alhazen {

/// Sums in fixed point of 128 bits, in units of 2^-60: integers add up in any order. Numbers are cut to whole
/// units, and none counts as more than about 2^52.
class ExactSums {
  public:
    ExactSums() = default;
    /// All zero.
    explicit ExactSums(std::size_t count);

    std::size_t size() const { return low_.size(); }
    void reset();
    void clear(std::size_t i) {
        low_[i] = low_zero;
        high_[i] = 0;
    }

    /// May be called by several threads at a time; v must be finite.
    void add(std::size_t i, double v) {
        if (std::abs(v) < low_range / 4)
            add_units(i, static_cast<std::int64_t>(v * units));
        else
            add_large(i, v);
    }
    /// Nobody may be adding meanwhile.
    double sum(std::size_t i) const;

  private:
    static constexpr double units = 0x1p60;
    static constexpr double low_range = 16; ///< 2^64 units
    /// The low words start in the middle of their range, so that sums near zero seldom carry.
    static constexpr std::uint64_t low_zero = std::uint64_t{1} << 63;

    // Relaxed: sums are read by those who have waited for all that add.
    void add_units(std::size_t i, std::int64_t n) {
        const auto step = static_cast<std::uint64_t>(n);
        const std::uint64_t before = std::atomic_ref(low_[i]).fetch_add(step, std::memory_order_relaxed);
        const std::uint64_t after = before + step;
        if (n >= 0 ? after < before : after > before)
            std::atomic_ref(high_[i]).fetch_add(n >= 0 ? 1 : -1, std::memory_order_relaxed);
    }
    void add_large(std::size_t i, double v);

    BigArray<std::uint64_t> low_;
    BigArray<std::int64_t> high_; ///< in units of low_range; hardly touched
};

} // namespace alhazen
