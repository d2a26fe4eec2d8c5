/// Which runs of sorted Morton codes become one leaf each, found before the tree is.
///
/// Where a leaf costs the same whether it holds one primitive or eight, the lowest subtrees of up to eight
/// are leaves whatever they look like, and nodes inside them need not be made at all. Such a subtree ends
/// between two keys if the node that splits there covers more than eight, which is to be seen from the keys
/// around: a node reaches from its split to both sides as far as neighbours have more bits in common than the
/// two keys at the split (Karras 2012, section 3; Apetrei 2014, "Fast and Simple Agglomerative LBVH
/// Construction"). So each place is decided by itself, from bytes that stand side by side.
#pragma once

#include "accel/build/morton.h"
#include "base/big_array.h"

namespace alhazen {

class LeafRuns {
  public:
    /// The subtrees of the radix tree over the keys, which are sorted, that have at most size keys
    /// (1 ... 16) and stand below a node of more.
    LeafRuns(std::span<const MortonKey> keys, std::uint32_t size);

    std::size_t count() const { return first_.size() - 1; }
    /// The run's first key; of run count(): the number of keys.
    std::uint32_t first(std::size_t run) const { return first_[run]; }
    std::uint32_t size(std::size_t run) const { return first_[run + 1] - first_[run]; }

  private:
    BigArray<std::uint32_t> first_;
};

} // namespace alhazen
