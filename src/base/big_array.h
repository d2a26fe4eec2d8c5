/// Arrays that are large and written before they are read: the memory comes as it is, on huge pages where the
/// system has them, so that walking through it misses the TLB less and the system clears it in few big steps.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <type_traits>

namespace alhazen {

/// Asks the system to back these bytes by huge pages, as far as whole ones fit inside. It may ignore it. Pays
/// before the memory is first touched.
void prefer_huge_pages(void* begin, std::size_t bytes);

namespace big_array_detail {

struct Free {
    void operator()(void* p) const;
};
/// At least so many bytes, not initialised, aligned to 64 or, when that is worth it, to a huge page. Throws
/// std::bad_alloc.
void* allocate(std::size_t bytes);

} // namespace big_array_detail

/// A fixed number of elements that hold anything until they are written.
template <class T>
class BigArray {
    static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);
    static_assert(alignof(T) <= 64);

  public:
    BigArray() = default;
    explicit BigArray(std::size_t size)
        : data_(size ? static_cast<T*>(big_array_detail::allocate(size * sizeof(T))) : nullptr), size_(size) {
    }

    std::size_t size() const { return size_; }
    T* data() { return data_.get(); }
    const T* data() const { return data_.get(); }
    T& operator[](std::size_t i) { return data_.get()[i]; }
    const T& operator[](std::size_t i) const { return data_.get()[i]; }
    std::span<T> all() { return {data(), size_}; }
    std::span<const T> all() const { return {data(), size_}; }

  private:
    std::unique_ptr<T, big_array_detail::Free> data_;
    std::size_t size_ = 0;
};

} // namespace alhazen
