/// How much light a BSDF scatters in all.
#pragma once

#include "materials/bsdf.h"

namespace alhazen {

/// Share of the light from wo that is scattered (the directional albedo), by a few samples of the BSDF: a
/// lattice with the golden ratio's relatives (Roberts 2018), moved by shift, whose components are in [0, 1).
/// In mode radiance what is refracted counts by its radiance, which is squeezed by eta^2; in mode importance
/// by its flux.
Spectrum albedo_of(const Bsdf& bsdf, Vec3 wo, int samples, TransportMode mode, Vec3 shift = {});

} // namespace alhazen
