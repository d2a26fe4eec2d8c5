/// Metals, polished or rough.
#include "materials/conductor_bsdf.h"
#include "materials/material.h"
#include "materials/metal.h"
#include "materials/roughness.h"

namespace alhazen {

namespace {

struct Conductor final : Material {
    MetalColor color;
    Roughness rough;
    bool remaproughness = true;

    static void describe(Fields<Conductor>& f) {
        f.about("Metal. Its colour comes from its index of refraction eta - i k, or from the reflectance at "
                "normal incidence; rough metal is a landscape of microfacets.");
        MetalColor::describe(f, &Conductor::color);
        Roughness::describe(f, &Conductor::rough);
        Roughness::describe_remap(f);
        Relief::describe(f);
        f.example("copper mirror", {});
        f.example("rough gold", {make_spectrum("eta", "metal-Au-eta"), make_spectrum("k", "metal-Au-k"),
                                 make_float("roughness", 0.3f)});
        f.example("brushed aluminium",
                  {make_spectrum("eta", "metal-Al-eta"), make_spectrum("k", "metal-Al-k"),
                   make_float("uroughness", 0.04f), make_float("vroughness", 0.25f)});
        f.example("blue foil", {make_rgb("reflectance", 0.2f, 0.3f, 0.8f), make_float("roughness", 0.5f),
                                make_bool("remaproughness", false)});
        f.example("perfect mirror", {make_float("reflectance", 1)});
    }
    void finish(const Node& node, BuildContext& context) { color.finish(node, context); }

    bool needs_parameters() const override { return rough.needs_parameters() || color.varies(); }
    Bsdf* at(const Hit& hit, Wavelengths& lambda, Arena& arena) const override {
        const TexturePoint at(hit);
        const MetalIndex index = color.index(at, lambda);
        return arena.make<ConductorBsdf>(rough.facets(at, remaproughness), index.eta, index.k);
    }
};

} // namespace

Kind<Material> conductor_material() {
    return make_kind<Material, Conductor>("conductor");
}

} // namespace alhazen
