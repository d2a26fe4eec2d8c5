/// The roughness parameters that metals and glasses share.
#pragma once

#include <optional>

#include "materials/material.h"
#include "materials/microfacet.h"

namespace alhazen {

/// A base of materials with microfacets.
struct RoughMaterial : Material {
    FloatTexture roughness{0};
    std::optional<FloatTexture> uroughness, vroughness;
    bool remaproughness = true;

    template <class T>
    static void describe_roughness(Fields<T>& f) {
        f.field("roughness", &T::roughness, "0: perfectly smooth; 1: dull").at_least(0);
        f.field("uroughness", &T::uroughness, "roughness along u").at_least(0).otherwise("roughness");
        f.field("vroughness", &T::vroughness, "roughness along v").at_least(0).otherwise("roughness");
        f.field("remaproughness", &T::remaproughness,
                "true: microfacet alpha is the square root of the roughness; false: it is the roughness");
    }

    bool needs_parameters() const override { return uroughness || vroughness || !roughness.is_constant(); }
    TrowbridgeReitz microfacets(const TexturePoint& at) const {
        float u = (uroughness ? *uroughness : roughness).eval(at);
        float v = (vroughness ? *vroughness : roughness).eval(at);
        if (remaproughness) {
            u = TrowbridgeReitz::roughness_to_alpha(u);
            v = TrowbridgeReitz::roughness_to_alpha(v);
        }
        return {u, v};
    }
};

} // namespace alhazen
