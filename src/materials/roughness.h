/// The roughness parameters that metals, glasses and coats share.
#pragma once

#include <optional>
#include <string>

#include "materials/microfacet.h"
#include "textures/texture.h"

namespace alhazen {

/// How rough a surface is, along and across; a part of materials with microfacets.
struct Roughness {
    FloatTexture roughness{0};
    std::optional<FloatTexture> uroughness, vroughness;

    /// Parameters of T, their names after a prefix.
    template <class T>
    static void describe(Fields<T>& f, Roughness T::*part, const std::string& prefix = "") {
        f.field(prefix + "roughness", part, &Roughness::roughness, "0: perfectly smooth; 1: dull")
            .at_least(0);
        f.field(prefix + "uroughness", part, &Roughness::uroughness, "roughness along u")
            .at_least(0)
            .otherwise(prefix + "roughness");
        f.field(prefix + "vroughness", part, &Roughness::vroughness, "roughness along v")
            .at_least(0)
            .otherwise(prefix + "roughness");
    }
    template <class T>
    static void describe_remap(Fields<T>& f) {
        f.field("remaproughness", &T::remaproughness,
                "true: microfacet alpha is the square root of the roughness; false: it is the roughness");
    }

    const FloatTexture& along_u() const { return uroughness ? *uroughness : roughness; }
    const FloatTexture& along_v() const { return vroughness ? *vroughness : roughness; }
    bool varies() const { return !along_u().is_constant() || !along_v().is_constant(); }
    /// Whether the surface differs from place to place, or in directions along it.
    bool needs_parameters() const { return varies() || along_u().constant() != along_v().constant(); }

    TrowbridgeReitz facets(const TexturePoint& at, bool is_remapped) const {
        float u = along_u().eval(at), v = along_v().eval(at);
        if (is_remapped) {
            u = TrowbridgeReitz::roughness_to_alpha(u);
            v = TrowbridgeReitz::roughness_to_alpha(v);
        }
        return {u, v};
    }
};

} // namespace alhazen
