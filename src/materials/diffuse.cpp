/// Ideal matte surfaces (Lambert 1760): reflected light does not depend on the direction of view.
#include "materials/diffuse_bsdf.h"
#include "materials/material.h"

namespace alhazen {

namespace {

struct Diffuse final : Material {
    AlbedoTexture reflectance{0.5f};

    static void describe(Fields<Diffuse>& f) {
        f.about("Ideal matte surface: reflected light does not depend on the viewing direction.");
        f.field("reflectance", &Diffuse::reflectance, "fraction of light reflected").in(0, 1);
        Relief::describe(f);
        f.example("grey", {});
        f.example("clay", {make_rgb("reflectance", 0.6f, 0.4f, 0.3f)});
        f.example("white", {make_float("reflectance", 1)});
        f.example("black", {make_float("reflectance", 0)});
    }
    bool needs_parameters() const override { return !reflectance.is_constant(); }
    Bsdf* at(const Hit& hit, Wavelengths& lambda, Arena& arena) const override {
        return arena.make<DiffuseBsdf>(clamp(reflectance.eval(TexturePoint(hit), lambda), 0, 1));
    }
    bool is_uniform() const override { return reflectance.is_constant(); }
};

} // namespace

Kind<Material> diffuse_material() {
    return make_kind<Material, Diffuse>("diffuse");
}

} // namespace alhazen
