/// Metal under a coat: varnished brass, car paint.
#include "describe/spectrum_parameter.h"
#include "materials/layer_fields.h"
#include "materials/material.h"
#include "materials/metal.h"
#include "materials/roughness.h"

namespace alhazen {

namespace {

struct CoatedConductor final : Material {
    UnboundedSpectrum eta{1.5f};
    Roughness border, metal;
    MetalColor color;
    bool remaproughness = true;
    LayerFields layer;

    static void describe(Fields<CoatedConductor>& f) {
        f.about("Metal under a dielectric coat: varnished brass, car paint. Light bounces between the coat's "
                "surface and the metal, and is absorbed or scattered on the way.");
        f.field("interface.eta", &CoatedConductor::eta, "index of refraction of the coat").above(0);
        Roughness::describe(f, &CoatedConductor::border, "interface.");
        MetalColor::describe(f, &CoatedConductor::color, "conductor.");
        Roughness::describe(f, &CoatedConductor::metal, "conductor.");
        Roughness::describe_remap(f);
        LayerFields::describe(f, &CoatedConductor::layer);
        Relief::describe(f);
        f.example("varnished copper", {});
        f.example("brass",
                  {make_spectrum("conductor.eta", "metal-CuZn-eta"),
                   make_spectrum("conductor.k", "metal-CuZn-k"), make_float("conductor.roughness", 0.1f)});
        f.example("satin coat", {make_float("reflectance", 0.8f), make_float("interface.roughness", 0.1f)});
        f.example("dull coat",
                  {make_rgb("reflectance", 0.9f, 0.6f, 0.3f), make_float("interface.uroughness", 0.4f),
                   make_float("interface.vroughness", 0.2f), make_bool("remaproughness", false),
                   make_float("conductor.uroughness", 0.3f), make_float("conductor.vroughness", 0.5f),
                   make_float("interface.eta", 1.8f), make_float("thickness", 0.2f)});
        f.example("car paint",
                  {make_rgb("reflectance", 0.9f, 0.2f, 0.1f), make_float("conductor.roughness", 0.3f),
                   make_rgb("albedo", 0.8f, 0.3f, 0.2f), make_float("g", -0.3f),
                   make_float("thickness", 0.4f), make_integer("maxdepth", 20), make_integer("nsamples", 2)});
        f.example("hazy mirror",
                  {make_float("reflectance", 1), make_float("albedo", 0.9f), make_float("thickness", 0.5f)});
        f.example("dispersive coat", {make_spectrum("interface.eta", "glass-SF11")});
    }
    void finish(const Node& node, BuildContext& context) { color.finish(node, context, "conductor."); }

    bool needs_parameters() const override {
        return border.needs_parameters() || metal.needs_parameters() || color.varies() || layer.varies();
    }
    Bsdf* at(const Hit& hit, Wavelengths& lambda, Arena& arena) const override {
        const TexturePoint at(hit);
        float coat = lambda.hero(eta.eval(lambda));
        if (!eta.value.is_constant()) lambda.terminate_secondary();
        if (!(coat > 0)) coat = 1;
        const MetalIndex index = color.index(at, lambda);
        // Light comes to the metal from within the coat.
        return arena.make<LayeredBsdf<ConductorBsdf>>(
            DielectricBsdf(border.facets(at, remaproughness), coat),
            ConductorBsdf(metal.facets(at, remaproughness), index.eta / coat, index.k / coat),
            layer.at(at, lambda), place_salt(hit));
    }
};

} // namespace

Kind<Material> coatedconductor_material() {
    return make_kind<Material, CoatedConductor>("coatedconductor");
}

} // namespace alhazen
