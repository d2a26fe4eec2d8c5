/// The colour of metals, as parameters give it.
#pragma once

#include <optional>
#include <string>

#include "color/spectral.h"
#include "textures/texture.h"

namespace alhazen {

/// The index of refraction eta - i k.
struct MetalIndex {
    Spectrum eta, k;
};

/// By its index, or by its reflectance; a part of materials.
struct MetalColor {
    std::optional<UnboundedTexture> eta, k;
    std::optional<AlbedoTexture> reflectance;

    /// Parameters of T; those of the index have their names after a prefix.
    template <class T>
    static void describe(Fields<T>& f, MetalColor T::*part, const std::string& prefix = "") {
        f.field(prefix + "eta", part, &MetalColor::eta, "index of refraction of the metal")
            .otherwise("\"metal-Cu-eta\"");
        f.field(prefix + "k", part, &MetalColor::k, "absorption coefficient of the metal")
            .otherwise("\"metal-Cu-k\"");
        f.field("reflectance", part, &MetalColor::reflectance,
                "fraction of light reflected at normal incidence, instead of eta and k")
            .in(0, 1);
    }

    /// Checks and completes what was read with that prefix.
    void finish(const Node& node, BuildContext& context, std::string_view prefix = "");
    bool varies() const;
    MetalIndex index(const TexturePoint& at, const Wavelengths& lambda) const;
};

} // namespace alhazen
