/// Structures over primitives that move from one picture to the next.
///
/// The tree is kept. When primitives have moved its boxes are fitted to them from the leaves up (refit), and
/// it is laid out in memory again, so that every walk can follow motion without knowing of it, and wide nodes
/// are chosen anew for the boxes as they are now. What is saved is the building of the tree: the sort of lbvh
/// or the many passes of sah. What is paid is memory for the tree, 32 bytes a node, and quality, for a tree
/// that was good where things were gets worse the more they move apart: expected_cost() says by how much, and
/// once it has doubled it is time to build anew.
#pragma once

#include "accel/accel.h"

namespace alhazen {

class MovingStructure {
  public:
    explicit MovingStructure(const Primitives& primitives, AccelChoice choice = {});

    const Structure& structure() const { return *structure_; }
    /// In tests of primitives a ray (TreeStats::sah_cost), as of now.
    double expected_cost() const { return stats_of(tree_).sah_cost; }

    /// After primitives have moved; as many as before, of the same kinds. Nobody may be asking the structure
    /// meanwhile, and references to it end. True when it was refitted; false when it had to be built anew,
    /// because a primitive that could not be hit before (without area, or not finite) can be now, or none can
    /// be any more.
    bool update(const Primitives& primitives);
    /// Builds anew in any case.
    void rebuild(const Primitives& primitives);

  private:
    AccelChoice choice_;
    Tree tree_;
    std::unique_ptr<Structure> structure_;
};

} // namespace alhazen
