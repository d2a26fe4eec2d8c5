/// Trees from Morton codes; see lbvh.cpp.
#pragma once

#include "accel/build/tree.h"

namespace alhazen {

/// How many bits of Morton code tell primitives apart.
enum class MortonBits {
    bits_30 = 30, ///< 1024 cells along the longest axis
    bits_63 = 63, ///< two million
};

/// Builds a linear bounding volume hierarchy (Karras 2012). boxes: as padded_boxes gives them.
Tree build_lbvh(std::span<const Bounds3> boxes, const BuildOptions& options,
                MortonBits bits = MortonBits::bits_63);

} // namespace alhazen
