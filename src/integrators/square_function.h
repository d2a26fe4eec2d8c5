/// Functions over the unit square, each of integral 1, to try samplers on: edges along the axes, slanted and
/// bent ones, fine patterns, and a smooth hill. (The set is pbrt-v4's.)
#pragma once

#include <array>

#include "describe/field_types.h"

namespace alhazen {

enum class SquareFunction {
    step,                ///< 2 in the left half, else 0
    diagonal,            ///< 2 below the diagonal, else 0
    disk,                ///< 4 / pi in the largest disk, else 0
    checkerboard,        ///< 2 in every other of 10 x 10 fields, else 0
    rotatedcheckerboard, ///< that turned by 45 degrees
    gaussian,            ///< a normal distribution around the centre, of standard deviation 1/4
};
template <>
struct EnumNames<SquareFunction> {
    static constexpr std::array names{"step",    "diagonal", "disk", "checkerboard", "rotatedcheckerboard",
                                      "gaussian"};
};

/// The value at a point of the square; x and y in [0, 1].
double value_at(SquareFunction f, double x, double y);

} // namespace alhazen
