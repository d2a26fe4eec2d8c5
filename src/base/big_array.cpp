#include "base/big_array.h"

#include <cstdint>
#include <cstdlib>
#include <new>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace alhazen {

namespace {

constexpr std::size_t huge_page = std::size_t{2} << 20;
constexpr std::size_t cache_line = 64;

std::size_t round_up(std::size_t n, std::size_t unit) {
    return (n + unit - 1) / unit * unit;
}

} // namespace

void prefer_huge_pages(void* begin, std::size_t bytes) {
#ifdef __linux__
    auto address = reinterpret_cast<std::uintptr_t>(begin);
    std::size_t skipped = round_up(address, huge_page) - address;
    if (skipped + huge_page > bytes) return;
    std::size_t length = (bytes - skipped) / huge_page * huge_page;
    // A hint: where it fails, ordinary pages do.
    static_cast<void>(madvise(static_cast<std::byte*>(begin) + skipped, length, MADV_HUGEPAGE));
#else
    static_cast<void>(begin);
    static_cast<void>(bytes);
#endif
}

namespace big_array_detail {

void Free::operator()(void* p) const {
    std::free(p);
}

void* allocate(std::size_t bytes) {
    // The last page would be half empty on the average.
    bool is_big = bytes >= 2 * huge_page;
    std::size_t alignment = is_big ? huge_page : cache_line;
    void* p = std::aligned_alloc(alignment, round_up(bytes, alignment));
    if (!p) throw std::bad_alloc();
    if (is_big) prefer_huge_pages(p, round_up(bytes, alignment));
    return p;
}

} // namespace big_array_detail

} // namespace alhazen
