/// A matte surface under a coat: plastic, lacquered wood, glazed pottery.
#include "describe/spectrum_parameter.h"
#include "materials/coat.h"
#include "materials/layer_fields.h"
#include "materials/material.h"
#include "materials/roughness.h"

namespace alhazen {

namespace {

/// Under a clear coat whose roughness is the same all around, the mean of the walks is known.
struct CoatedDiffuseBsdf final : Bsdf {
    DielectricBsdf border;
    Coat::Place coat;
    Spectrum base = 0; ///< the base's part of the BSDF, but for what is let in from wo and wi

    CoatedDiffuseBsdf(const DielectricBsdf& border_, const Coat::Place& coat_, Spectrum reflectance,
                      int maxdepth)
        : border(border_), coat(coat_) {
        Spectrum term = reflectance * (inv_pi / sqr(border.eta));
        for (int i = 0; i < maxdepth; i += 2, term *= reflectance * coat.sent_back) base += term;
    }

    Scatter eval(Vec3 wo, Vec3 wi, TransportMode mode) const override {
        if (!same_hemisphere(wo, wi)) return {};
        wo.z = std::abs(wo.z);
        wi.z = std::abs(wi.z);
        const float in_o = coat.let_in(wo.z), in_i = coat.let_in(wi.z);
        const Scatter mirror = border.eval(wo, wi, mode, Sides::same);
        return {mirror.f + base * (in_o * in_i * wi.z),
                lerp(mirror_chance(wo, in_o), cosine_hemisphere_pdf(wi.z), mirror.pdf),
                lerp(mirror_chance(wi, in_i), cosine_hemisphere_pdf(wo.z), mirror.pdf_reverse)};
    }

    std::optional<BsdfSample> sample(Vec3 wo, float u, Vec2 u2, TransportMode mode) const override {
        if (wo.z == 0) return std::nullopt;
        const Vec3 up{wo.x, wo.y, std::abs(wo.z)};
        const float chance = mirror_chance(up, coat.let_in(up.z));
        const bool is_mirrored = u < chance;
        Vec3 wi = sample_cosine_hemisphere(u2);
        if (is_mirrored) {
            auto s = border.sample(up, 0, u2, mode, Sides::same);
            if (!s) return std::nullopt;
            wi = s->wi;
            if (border.is_specular())
                return BsdfSample{{wi.x, wi.y, std::copysign(wi.z, wo.z)}, s->f, chance, chance,
                                  Lobes::reflection | Lobes::specular,     1};
        }
        const Scatter s = eval(up, wi, mode);
        if (!(s.pdf > 0)) return std::nullopt;
        wi.z = std::copysign(wi.z, wo.z);
        return BsdfSample{
            wi, s.f, s.pdf, s.pdf_reverse, Lobes::reflection | (is_mirrored ? Lobes::glossy : Lobes::diffuse),
            1};
    }

    Lobes lobes() const override {
        Lobes all = Lobes::reflection;
        if (!base.is_black()) all = all | Lobes::diffuse;
        return border.eta == 1 ? all : all | (border.is_specular() ? Lobes::specular : Lobes::glossy);
    }
    // Only the mirrored light is widened: what the base sends out hardly depends on the border's roughness.
    void regularize() override { border.regularize(); }
    WhittedTerms whitted(Vec3 wo) const override {
        return {.ambient = base * (pi * sqr(border.eta) * coat.let_out),
                .mirror = border.whitted({wo.x, wo.y, std::abs(wo.z)}).mirror};
    }

  private:
    // In proportion to the light that is mirrored, and that comes from the base.
    float mirror_chance(Vec3 w, float let_in) const {
        const float mirrored = border.specular_reflection(w);
        const float from_base = base.max() * (pi * sqr(border.eta) * coat.let_out) * let_in;
        return mirrored > 0 ? mirrored / (mirrored + from_base) : 0;
    }
};

struct CoatedDiffuse final : Material {
    AlbedoTexture reflectance{0.5f};
    UnboundedSpectrum eta{1.5f};
    Roughness rough;
    bool remaproughness = true;
    LayerFields layer;

    static void describe(Fields<CoatedDiffuse>& f) {
        f.about(
            "Matte surface under a dielectric coat: plastic, lacquered wood, glazed pottery. Light bounces "
            "between the coat's border and the base, and is absorbed or scattered on the way.");
        f.field("reflectance", &CoatedDiffuse::reflectance, "fraction of light that the base reflects")
            .in(0, 1);
        f.field("eta", &CoatedDiffuse::eta, "index of refraction of the coat").above(0);
        Roughness::describe(f, &CoatedDiffuse::rough);
        Roughness::describe_remap(f);
        LayerFields::describe(f, &CoatedDiffuse::layer);
        Relief::describe(f);
        f.example("plastic", {});
        f.example("white varnish", {make_float("reflectance", 1), make_float("thickness", 0)});
        f.example("satin", {make_rgb("reflectance", 0.7f, 0.2f, 0.1f), make_float("roughness", 0.09f)});
        f.example("dull", {make_float("reflectance", 0.9f), make_float("roughness", 0.7f),
                           make_bool("remaproughness", false), make_float("thickness", 0.3f),
                           make_float("eta", 1.8f)});
        f.example("brushed", {make_rgb("reflectance", 0.2f, 0.3f, 0.8f), make_float("uroughness", 0.3f),
                              make_float("vroughness", 0.05f)});
        f.example("milky glaze",
                  {make_rgb("reflectance", 0.1f, 0.3f, 0.5f), make_rgb("albedo", 0.9f, 0.8f, 0.7f),
                   make_float("thickness", 0.5f), make_float("g", 0.4f), make_integer("maxdepth", 30),
                   make_integer("nsamples", 2)});
        f.example("frosted haze",
                  {make_float("albedo", 0.8f), make_float("thickness", 1), make_float("roughness", 0.2f)});
        f.example("dispersive", {make_spectrum("eta", "glass-SF11")});
    }

    // The coat is worked out beforehand where it is the same everywhere but for its roughness.
    void finish(const Node&, BuildContext&) {
        if (!eta.value.is_constant() || !layer.thickness.is_constant()) return;
        const TexturePoint anywhere({}, {}, {});
        const float index = eta.eval(Wavelengths::rgb())[0];
        const float thickness = layer.at(anywhere, Wavelengths::rgb()).thickness;
        if (rough.varies()) {
            coat_.emplace(index, thickness, std::nullopt);
        } else if (auto facets = rough.facets(anywhere, remaproughness); has_coat(facets)) {
            coat_.emplace(index, thickness, facets.alpha_x());
        }
    }

    bool needs_parameters() const override {
        return rough.needs_parameters() || layer.varies() || !reflectance.is_constant();
    }
    Bsdf* at(const Hit& hit, Wavelengths& lambda, Arena& arena) const override {
        const TexturePoint at(hit);
        float index = lambda.hero(eta.eval(lambda));
        if (!eta.value.is_constant()) lambda.terminate_secondary();
        if (!(index > 0)) index = 1;
        const Spectrum matte = clamp(reflectance.eval(at, lambda), 0, 1);
        const TrowbridgeReitz facets = rough.facets(at, remaproughness);
        const Layer between = layer.at(at, lambda);
        const DielectricBsdf border(facets, index);
        if (coat_ && has_coat(facets) && !between.is_cloudy())
            return arena.make<CoatedDiffuseBsdf>(border, coat_->at(facets.alpha_x()), matte, layer.maxdepth);
        return arena.make<LayeredBsdf<DiffuseBsdf>>(border, DiffuseBsdf(matte), between, place_salt(hit));
    }

  private:
    static bool has_coat(const TrowbridgeReitz& facets) {
        return facets.alpha_x() == facets.alpha_y() && facets.alpha_x() <= Coat::largest_alpha;
    }
    std::optional<Coat> coat_;
};

} // namespace

Kind<Material> coateddiffuse_material() {
    return make_kind<Material, CoatedDiffuse>("coateddiffuse");
}

} // namespace alhazen
