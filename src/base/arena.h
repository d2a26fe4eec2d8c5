/// Memory for what lives as long as one path: BSDFs, coroutine frames.
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace alhazen {

/// A bump allocator; reset() takes everything back at once and keeps the blocks. Not for use by two threads
/// at a time. Destructors do not run, so only trivially destructible types may be made here.
class Arena {
  public:
    explicit Arena(std::size_t block_size = 16 * 1024) : block_size_(block_size) {}

    void* allocate(std::size_t size, std::size_t alignment = alignof(std::max_align_t)) {
        std::size_t start = (used_ + alignment - 1) & ~(alignment - 1);
        if (blocks_.empty() || start + size > blocks_[current_].size) return allocate_in_next_block(size);
        used_ = start + size;
        return blocks_[current_].bytes.get() + start;
    }
    template <class T, class... Args>
    T* make(Args&&... args) {
        static_assert(std::is_trivially_destructible_v<T>, "an arena runs no destructors");
        return ::new (allocate(sizeof(T), alignof(T))) T(std::forward<Args>(args)...);
    }
    void reset() {
        current_ = 0;
        used_ = 0;
    }

    /// A place to come back to: everything allocated after mark() is taken back by rewind().
    struct Mark {
        std::size_t block, used;
    };
    Mark mark() const { return {current_, used_}; }
    void rewind(Mark m) {
        current_ = m.block;
        used_ = m.used;
    }

  private:
    // Aligned so that an offset's alignment is the address's alignment.
    static constexpr std::size_t block_alignment = 64;
    struct Delete {
        void operator()(std::byte* p) const { ::operator delete[](p, std::align_val_t{block_alignment}); }
    };
    struct Block {
        std::unique_ptr<std::byte[], Delete> bytes;
        std::size_t size;
    };

    void* allocate_in_next_block(std::size_t size) {
        std::size_t next = blocks_.empty() ? 0 : current_ + 1;
        // Blocks that are too small for this request are replaced: a rewind never points into a later block.
        if (next == blocks_.size() || blocks_[next].size < size) {
            std::size_t bytes = std::max(size, block_size_);
            auto* raw = static_cast<std::byte*>(::operator new[](bytes, std::align_val_t{block_alignment}));
            Block block{std::unique_ptr<std::byte[], Delete>(raw), bytes};
            if (next == blocks_.size())
                blocks_.push_back(std::move(block));
            else
                blocks_[next] = std::move(block);
        }
        current_ = next;
        used_ = size;
        return blocks_[current_].bytes.get();
    }

    std::vector<Block> blocks_;
    std::size_t block_size_;
    std::size_t current_ = 0;
    std::size_t used_ = 0;
};

} // namespace alhazen
