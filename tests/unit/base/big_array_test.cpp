#include "base/big_array.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace alhazen {
namespace {

TEST(BigArray, HoldsWhatIsWrittenAtAnySize) {
    for (std::size_t size : {std::size_t{1}, std::size_t{1000}, (std::size_t{5} << 20) + 3}) {
        BigArray<std::uint32_t> a(size);
        EXPECT_EQ(a.size(), size);
        EXPECT_EQ(reinterpret_cast<std::uintptr_t>(a.data()) % 64, 0u);
        for (std::size_t i = 0; i < size; ++i) a[i] = static_cast<std::uint32_t>(i * 7);
        BigArray<std::uint32_t> moved = std::move(a);
        std::uint64_t wrong = 0;
        for (std::size_t i = 0; i < size; ++i) wrong += moved.all()[i] != static_cast<std::uint32_t>(i * 7);
        EXPECT_EQ(wrong, 0u);
    }
    BigArray<std::uint32_t> none(0);
    EXPECT_EQ(none.data(), nullptr);
}

TEST(BigArray, AskingForHugePagesChangesNothing) {
    std::vector<char> bytes(8u << 20, 3);
    prefer_huge_pages(bytes.data() + 1, bytes.size() - 1);
    prefer_huge_pages(bytes.data(), 10);
    prefer_huge_pages(nullptr, 0);
    std::size_t same = 0;
    for (char c : bytes) same += c == 3;
    EXPECT_EQ(same, bytes.size());
}

} // namespace
} // namespace alhazen
