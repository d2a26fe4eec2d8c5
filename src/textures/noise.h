/// Smooth random numbers over space (Perlin 2002, "Improving noise"), and sums of them over octaves.
///
/// Space is cut into unit cubes. Each corner has a gradient, picked by hashing its whole coordinates; the
/// noise at a point is interpolated between what the eight gradients around it say, so it is 0 at every
/// corner.
#pragma once

#include "base/vec.h"

namespace alhazen {

/// In about [-1, 1], 0 where all coordinates are whole; repeats every 256 units. Finite for finite points.
float noise(Vec3 p);

/// Fractional Brownian motion (Perlin 1985; Pharr et al. 2018, section 10.6.3): the noise, plus the same
/// at 1.99 times the frequency and roughness times the strength, and so on, but for octaves that are finer
/// than what covers the given width, whose mean is 0; the last fades in.
float fractal_noise(Vec3 p, float roughness, int octaves, float width = 0);
/// The same sum of the noise's magnitude, which has creases. Octaves that are too fine count as their mean.
float turbulence(Vec3 p, float roughness, int octaves, float width = 0);

} // namespace alhazen
