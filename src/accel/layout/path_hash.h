/// Finds nodes of a binary tree by where they stand: a perfect hash from keys to nodes.
///
/// The root's key is 1 and the children of the node with key k are 2 k and 2 k + 1: a key is a leading 1 and
/// then one bit a level, left or right. Binder and Keller 2016, "Efficient Stackless Hierarchy Traversal on
/// GPUs with Backtracking in Constant Time", look nodes up in a table H after moving each key by an entry of
/// a table of displacements D, chosen once so that no two keys meet: H[h(key) + D[g(key)]]. Nothing is
/// compared and nothing is searched: a look-up is two loads. Only keys of the tree may be asked for.
///
/// Their keys fit into a word of 32 or 64 bits and g and h are the key's low bits. A Tree may be 96 levels
/// deep, so keys have 128 bits here, and since the low bits of long keys say nothing of the upper path, the
/// key is scrambled before its bits are taken.
#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "accel/layout/binary.h"

namespace alhazen {

/// A path from the root, or a bit for each of its levels. (ISO C++ has no integer of this size; both
/// compilers do.)
__extension__ typedef unsigned __int128 PathBits;
static_assert(Tree::max_depth < 128);

/// The number of zeros below the lowest one; bits must not be 0.
inline int trailing_zeros(PathBits bits) {
    const auto low = static_cast<std::uint64_t>(bits);
    return low != 0 ? std::countr_zero(low) : 64 + std::countr_zero(static_cast<std::uint64_t>(bits >> 64));
}

class PathHash {
  public:
    struct Entry {
        PathBits key;
        BinaryChild node;
    };

    PathHash() = default;
    /// The keys must be different from each other.
    explicit PathHash(std::span<const Entry> entries);

    /// The node of a key that is in the table; that of any other key otherwise.
    const BinaryChild& find(PathBits key) const { return nodes_[place(key)]; }
    /// Where the key's node stands, less than size(); for tests.
    std::size_t place(PathBits key) const {
        const std::uint64_t h = scramble(key);
        return (home(h) + displacements_[bucket(h)]) & (nodes_.size() - 1);
    }
    std::size_t size() const { return nodes_.size(); }
    std::size_t bytes() const {
        return nodes_.size() * sizeof(BinaryChild) + displacements_.size() * sizeof(std::uint32_t);
    }

  private:
    std::uint64_t scramble(PathBits key) const {
        std::uint64_t h = (static_cast<std::uint64_t>(key) ^ seed_) * 0x9e3779b97f4a7c15u;
        h = (h ^ h >> 32 ^ static_cast<std::uint64_t>(key >> 64)) * 0xd6e8feb86659fd93u;
        return h ^ h >> 32;
    }
    std::size_t bucket(std::uint64_t h) const { return (h >> 32) & (displacements_.size() - 1); }
    static std::size_t home(std::uint64_t h) { return static_cast<std::uint32_t>(h); }

    bool try_to_place(std::span<const Entry> entries);
    bool displace(std::size_t bucket, std::span<const std::size_t> homes, std::vector<bool>& taken);

    std::uint64_t seed_ = 0;
    std::vector<std::uint32_t> displacements_; // a power of two of them, as of nodes_
    std::vector<BinaryChild> nodes_;
};

} // namespace alhazen
