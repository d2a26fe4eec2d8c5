/// Memory for large arrays that are written before they are read.
///
/// A std::vector clears what it allocates, in one thread, and the system hands memory out in pages of 4 kB,
/// clearing each once more at its first touch; for arrays that live as long as one pass over them this is a
/// good part of the time. Here nothing is cleared but by the system, by the thread that uses it first, in
/// pages of 2 MB where there are such. These also keep scattered access cheap.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <type_traits>

namespace alhazen {

/// Memory for so many bytes, not cleared. Throws std::bad_alloc.
void* allocate_raw(std::size_t bytes);
void free_raw(void* memory);

/// Asks for large pages for memory that has not been touched yet.
void prefer_large_pages(void* memory, std::size_t bytes);

template <class T>
class RawBuffer {
    static_assert(std::is_trivially_default_constructible_v<T> && std::is_trivially_destructible_v<T>);

  public:
    RawBuffer() = default;
    explicit RawBuffer(std::size_t size)
        : data_(static_cast<T*>(allocate_raw(size * sizeof(T)))), size_(size) {}

    std::size_t size() const { return size_; }
    T* data() { return data_.get(); }
    const T* data() const { return data_.get(); }
    T& operator[](std::size_t i) { return data_.get()[i]; }
    const T& operator[](std::size_t i) const { return data_.get()[i]; }
    operator std::span<T>() { return {data(), size_}; }
    operator std::span<const T>() const { return {data(), size_}; }

  private:
    struct Free {
        void operator()(T* p) const { free_raw(p); }
    };
    std::unique_ptr<T, Free> data_;
    std::size_t size_ = 0;
};

} // namespace alhazen
