#include "accel/list.h"

namespace alhazen {

std::span<const AccelBuilder> accel_builders() {
    static const AccelBuilder all[] = {
        sah_builder(), sbvh_builder(), lbvh_builder(), octree_builder(), kdtree_builder(), ploc_builder(),
    };
    return all;
}

std::span<const AccelWalk> accel_walks() {
    static const AccelWalk all[] = {
        stack_walk(), wide_walk(), guthe_walk(), stackless_walk(), cwbvh_walk(), shortstack_walk(),
    };
    return all;
}

} // namespace alhazen
