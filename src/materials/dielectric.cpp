/// Glass, water and other clear matter: light is reflected and refracted, by a smooth border or by
/// microfacets.
#include "describe/spectrum_parameter.h"
#include "materials/dielectric_bsdf.h"
#include "materials/material.h"
#include "materials/roughness.h"

namespace alhazen {

namespace {

struct Dielectric final : Material {
    UnboundedSpectrum eta{1.5f};
    Roughness rough;
    bool remaproughness = true;

    static void describe(Fields<Dielectric>& f) {
        f.about(
            "Glass, water and other clear matter: a border that reflects and refracts. A spectrum as index "
            "of refraction disperses white light.");
        f.field("eta", &Dielectric::eta, "index of refraction inside over outside").above(0);
        Roughness::describe(f, &Dielectric::rough);
        Roughness::describe_remap(f);
        Relief::describe(f);
        f.example("glass", {});
        f.example("frosted", {make_float("roughness", 0.25f)});
        f.example("flint prism", {make_spectrum("eta", "glass-SF11")});
        f.example("rolled water", {make_float("eta", 1.33f), make_float("uroughness", 0.5f),
                                   make_float("vroughness", 0.2f), make_bool("remaproughness", false)});
        f.example("bubble", {make_float("eta", 0.75f), make_float("roughness", 0.1f)});
        f.example("nothing", {make_float("eta", 1), make_float("roughness", 0.1f)});
    }

    bool needs_parameters() const override { return rough.needs_parameters(); }
    Bsdf* at(const Hit& hit, Wavelengths& lambda, Arena& arena) const override {
        float index = lambda.hero(eta.eval(lambda));
        if (!eta.value.is_constant()) lambda.terminate_secondary();
        // Outside the range of a measured spectrum it says nothing.
        if (!(index > 0)) index = 1;
        return arena.make<DielectricBsdf>(rough.facets(TexturePoint(hit), remaproughness), index);
    }
};

} // namespace

Kind<Material> dielectric_material() {
    return make_kind<Material, Dielectric>("dielectric");
}

} // namespace alhazen
