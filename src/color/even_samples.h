/// What some samples of a pixel have in common.
#pragma once

#include "base/vec.h"
#include "color/spectrum.h"

namespace alhazen {

/// Samples of a pixel that all show the same.
struct EvenSamples {
    Vec2i pixel;
    int count = 1;
    Spectrum L; ///< finite, in linear RGB
};

} // namespace alhazen
