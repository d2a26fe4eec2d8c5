#include "accel/build/leaf_runs.h"

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>
#include <utility>

#include "base/threads.h"

namespace alhazen {

namespace {

constexpr std::size_t grain = 4096;
constexpr std::size_t reach = 16;

// Of a stretch of keys: whether a run ends behind each of them.
class Ends {
  public:
    Ends(std::span<const MortonKey> keys, std::size_t begin, std::size_t end, std::uint32_t size)
        : keys_(keys), count_(end - begin) {
        for (std::size_t i = 0; i < count_ + 2 * reach; ++i) common_[i] = common(begin + i - reach);
        // How far the node reaches to the left, to the right, and as long as it goes on.
        std::fill_n(covered_.begin(), count_, std::uint8_t{2});
        extend(size, [](std::size_t i, std::size_t step) { return reach + i - step; });
        extend(size, [](std::size_t i, std::size_t step) { return reach + i + step; });
        for (std::size_t i = 0; i < count_; ++i) is_end_[i] = covered_[i] > size;
        if (end == keys.size()) is_end_[count_ - 1] = 1;
    }

    bool operator[](std::size_t i) const { return is_end_[i] != 0; }
    std::uint32_t total() const {
        return std::accumulate(is_end_.begin(), is_end_.begin() + static_cast<std::ptrdiff_t>(count_), 0u);
    }

  private:
    // Bits that a key and the next have in common, a key's place behind its code; -1 beyond the ends.
    std::int8_t common(std::size_t i) const {
        // Places before the first wrap around.
        if (i >= keys_.size() - 1) return -1;
        const std::uint64_t difference = keys_[i].code ^ keys_[i + 1].code;
        const int places = 64 + std::countl_zero(static_cast<std::uint32_t>(i ^ (i + 1)));
        return static_cast<std::int8_t>(difference ? std::countl_zero(difference) : places);
    }
    template <class Neighbour>
    void extend(std::uint32_t size, const Neighbour& neighbour) {
        std::fill_n(goes_on_.begin(), count_, std::uint8_t{1});
        for (std::size_t step = 1; step < size; ++step)
            for (std::size_t i = 0; i < count_; ++i) {
                goes_on_[i] &= static_cast<std::uint8_t>(common_[neighbour(i, step)] > common_[reach + i]);
                covered_[i] = static_cast<std::uint8_t>(covered_[i] + goes_on_[i]);
            }
    }

    std::span<const MortonKey> keys_;
    std::size_t count_;
    std::array<std::int8_t, grain + 2 * reach> common_;
    std::array<std::uint8_t, grain> covered_, goes_on_, is_end_;
};

} // namespace

LeafRuns::LeafRuns(std::span<const MortonKey> keys, std::uint32_t size) {
    // How many runs end in each stretch, then how many before it.
    std::vector<std::uint32_t> before((keys.size() + grain - 1) / grain);
    parallel_ranges(keys.size(), grain, [&](std::size_t begin, std::size_t end) {
        before[begin / grain] = Ends(keys, begin, end, size).total();
    });
    std::uint32_t total = 0;
    for (std::uint32_t& run : before) total += std::exchange(run, total);
    first_ = BigArray<std::uint32_t>(total + 1);
    first_[0] = 0;
    parallel_ranges(keys.size(), grain, [&](std::size_t begin, std::size_t end) {
        const Ends ends(keys, begin, end, size);
        // Each place is noted, and kept if a run ends there: that takes no branch.
        std::array<std::uint32_t, grain + 1> noted;
        std::size_t kept = 0;
        for (std::size_t i = begin; i < end; ++i) {
            noted[kept] = static_cast<std::uint32_t>(i + 1);
            kept += ends[i - begin];
        }
        std::copy_n(noted.begin(), kept, first_.data() + before[begin / grain] + 1);
    });
}

} // namespace alhazen
