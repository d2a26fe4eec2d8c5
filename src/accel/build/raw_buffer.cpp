#include "accel/build/raw_buffer.h"

#include <cstdint>
#include <cstdlib>
#include <new>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace alhazen {

namespace {

constexpr std::size_t large_page = std::size_t{2} << 20;

} // namespace

void* allocate_raw(std::size_t bytes) {
    const bool is_large = bytes >= 2 * large_page;
    const std::size_t alignment = is_large ? large_page : 64;
    const std::size_t rounded = (bytes + alignment - 1) / alignment * alignment;
    void* memory = std::aligned_alloc(alignment, rounded > 0 ? rounded : alignment);
    if (!memory) throw std::bad_alloc();
    if (is_large) prefer_large_pages(memory, rounded);
    return memory;
}

void free_raw(void* memory) {
    std::free(memory);
}

void prefer_large_pages([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t bytes) {
#if defined(__linux__) && defined(MADV_HUGEPAGE)
    // Whole large pages inside the range; it is advice, so nothing is lost if it fails.
    auto begin = (reinterpret_cast<std::uintptr_t>(memory) + large_page - 1) / large_page * large_page;
    auto end = (reinterpret_cast<std::uintptr_t>(memory) + bytes) / large_page * large_page;
    if (begin < end) madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
#endif
}

} // namespace alhazen
