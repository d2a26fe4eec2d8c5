/// Binary radix trees over sorted Morton codes, all nodes at once.
///
/// Karras 2012, "Maximizing Parallelism in the Construction of BVHs, Octrees, and k-d Trees", section 3. A
/// radix tree branches at every bit in which the codes below a node differ first. Its n - 1 inner nodes are
/// numbered so that each node stands at one end of the range of leaves it covers: then a node finds its range
/// and the place where it splits by binary searches in the codes alone, asking nothing of other nodes. Codes
/// that are equal count as longer by their place in the order.
///
/// On a GPU every node is a thread, and that is the point: the levels of a tree are not worked off one after
/// another. On a CPU a thread takes runs of neighbouring nodes; they find the codes they compare in the
/// cache, because most ranges are short. What is lost is the reason for the method, since two threads can be
/// kept busy more cheaply by handing out subtrees; what remains is that no thread ever waits and that a scene
/// in one corner is as parallel as any.
#pragma once

#include <atomic>
#include <bit>
#include <memory>

#include "accel/build/morton.h"
#include "base/big_array.h"
#include "base/threads.h"

namespace alhazen {

class RadixTree {
  public:
    /// An inner node i splits its leaves first ... last after the leaf split: the left child covers first ...
    /// split, the right one split + 1 ... last. A child of one leaf is that leaf; else the left child is the
    /// inner node number split and the right one number split + 1.
    struct Node {
        std::uint32_t first, last, split;
        std::uint32_t count() const { return last - first + 1; }
    };
    static constexpr std::uint32_t none = ~0u;

    /// keys: sorted by code, fewer than 2^31; they must outlive the tree.
    explicit RadixTree(std::span<const MortonKey> keys);

    std::span<const MortonKey> keys() const { return keys_; }
    std::size_t leaves() const { return keys_.size(); }
    /// One less than leaves; node 0 is the root. None for a single leaf.
    std::size_t inner() const { return keys_.empty() ? 0 : keys_.size() - 1; }
    Node node(std::size_t i) const {
        Link l = nodes_[i];
        auto own = static_cast<std::uint32_t>(i);
        return {std::min(own, l.other_end), std::max(own, l.other_end), l.split};
    }
    /// The node above; none for the root.
    std::uint32_t parent_of_inner(std::size_t i) const { return inner_parent_[i]; }
    std::uint32_t parent_of_leaf(std::size_t i) const { return leaf_parent_[i]; }
    /// Leading bits, of the 64 of a code, that all codes of the node have in common; 64 if they are equal.
    int common_bits(std::size_t i) const {
        std::uint64_t difference = keys_[i].code ^ keys_[nodes_[i].other_end].code;
        return std::countl_zero(difference);
    }

    /// Calls visit(number, node) for every inner node after both of its children were visited, in parallel:
    /// from each leaf a way leads up; of the two that arrive at a node the first ends there and the second
    /// goes on (section 4).
    template <class Visit>
    void bottom_up(const Visit& visit) const {
        auto arrived = std::make_unique<std::atomic<std::uint8_t>[]>(inner());
        parallel_ranges(leaves(), grain, [&](std::size_t begin, std::size_t end) {
            for (std::size_t leaf = begin; leaf < end; ++leaf) {
                std::uint32_t number = leaf_parent_[leaf];
                while (number != none) {
                    const Node n = node(number);
                    // Where no other thread can arrive, the exchange need not be one.
                    const bool is_own = n.first >= begin && n.last < end;
                    if (!(is_own ? exchange_alone(arrived[number]) : exchange(arrived[number]))) break;
                    visit(number, n);
                    number = inner_parent_[number];
                }
            }
        });
    }

  private:
    static constexpr std::size_t grain = 8192;
    struct Link {
        std::uint32_t other_end, split;
    };

    static bool exchange(std::atomic<std::uint8_t>& flag) {
        return flag.exchange(1, std::memory_order_acq_rel) != 0;
    }
    static bool exchange_alone(std::atomic<std::uint8_t>& flag) {
        const bool before = flag.load(std::memory_order_relaxed) != 0;
        flag.store(1, std::memory_order_relaxed);
        return before;
    }
    int delta(std::int64_t i, std::int64_t j) const;
    Link find(std::int64_t i) const;

    std::span<const MortonKey> keys_;
    BigArray<Link> nodes_;
    BigArray<std::uint32_t> inner_parent_, leaf_parent_;
};

} // namespace alhazen
