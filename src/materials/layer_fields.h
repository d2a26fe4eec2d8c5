/// The parameters of the layer between a coated material's border and its base.
#pragma once

#include <limits>

#include "materials/layered.h"
#include "textures/texture.h"

namespace alhazen {

/// A part of coated materials.
struct LayerFields {
    FloatTexture thickness{0.01f}, g{0};
    AlbedoTexture albedo{0};
    int maxdepth = 10, nsamples = 1;

    template <class T>
    static void describe(Fields<T>& f, LayerFields T::*part) {
        f.field("thickness", part, &LayerFields::thickness, "thickness of the layer under the coat's surface")
            .at_least(0)
            .unit("mean free paths");
        f.field("albedo", part, &LayerFields::albedo,
                "fraction of light scattered by what is in the layer; 0: it absorbs only")
            .in(0, 1);
        f.field("g", part, &LayerFields::g, "mean cosine of scattering in the layer; 0: even, 1: straight on")
            .in(-1, 1);
        f.field("maxdepth", part, &LayerFields::maxdepth, "how often light crosses the layer at most")
            .in(0, 10000);
        f.field("nsamples", part, &LayerFields::nsamples, "random walks through the layer for one evaluation")
            .in(1, 10000);
    }

    bool varies() const { return !thickness.is_constant() || !g.is_constant() || !albedo.is_constant(); }
    Layer at(const TexturePoint& at, const Wavelengths& lambda) const {
        Layer layer;
        layer.thickness = std::max(thickness.eval(at), std::numeric_limits<float>::min());
        layer.albedo = clamp(albedo.eval(at, lambda), 0, 1);
        layer.phase = HenyeyGreenstein(std::clamp(g.eval(at), -1.0f, 1.0f));
        layer.maxdepth = maxdepth;
        layer.nsamples = nsamples;
        return layer;
    }
};

} // namespace alhazen
