/// Lights that make shapes glow. An AreaLightSource directive gives a description; attach() makes one light
/// of it for each primitive of each shape that it is applied to.
#pragma once

#include <cstdint>
#include <memory>

#include "lights/light.h"
#include "shapes/shape.h"

namespace alhazen {

/// As built from its node, an area light is only a description: it has no place and emits nothing.
struct AreaLight : Light {
    static constexpr std::string_view family_name = "area light";

    /// Whether neighbouring primitives may as well be one light: not where each has a flux of its own.
    virtual bool may_join() const = 0;
    /// The light that one primitive of the shape becomes; the shape must outlive it. A shape whose alpha is
    /// the constant 0 gives an invisible light: is_delta(), so that it lights the scene through sample()
    /// only.
    virtual std::unique_ptr<AreaLight> attach(const Shape& shape, std::uint32_t primitive) const = 0;
};

/// Lights that an AreaLightSource directive names.
const KindList<AreaLight>& area_light_kinds();

} // namespace alhazen
