/// Skin, marble, milk, wax: clear borders around matter that scatters light so often that only its spread
/// beneath the surface counts (Jensen et al. 2001; Pharr et al. 2016, section 11.4.3). The BSDF is the
/// border's alone; what it lets in is handed to the Bssrdf by integrators that know of it.
#include <memory>

#include <fmt/format.h>

#include "materials/bssrdf.h"
#include "materials/dielectric_bsdf.h"
#include "materials/material_set.h"
#include "materials/material_tables.h"
#include "materials/presets.h"
#include "materials/roughness.h"

namespace alhazen {

namespace {

struct Subsurface final : Material {
    std::string name;
    std::optional<UnboundedTexture> sigma_a, sigma_s;
    std::optional<AlbedoTexture> reflectance;
    std::optional<UnboundedTexture> mfp;
    float g = 0, eta = 1.33f, scale = 1;
    Roughness rough;
    bool remaproughness = true;
    std::shared_ptr<const DiffusionTable> table;

    static void describe(Fields<Subsurface>& f) {
        f.about(
            "Skin, marble, milk, wax: matter beneath a clear border, in which light spreads before it comes "
            "out elsewhere. What it is made of is said by `name`, by `sigma_a` and `sigma_s`, or by "
            "`reflectance` and `mfp`; else it is whole milk. Only the integrators path and volpath see the "
            "spread; others take it for clear matter, and say so. The method is photon beam diffusion "
            "(Habel, "
            "Christensen and Jarosz 2013), tabulated and sampled as in pbrt-v4. Its limits: light spreads as "
            "it would beneath a plane of the same matter everywhere, whatever stands inside, so that things "
            "thinner than light spreads are too bright (a sheet up to twice, since each of its faces gives "
            "out all of the light); the farthest thousandth of the light is left out; and matter that "
            "absorbs more than it scatters (juice) is better given as a "
            "dielectric around a medium.");
        f.field("name", &Subsurface::name, "name of measured matter; its coefficients are per mm");
        f.field("sigma_a", &Subsurface::sigma_a, "how much light is absorbed per length")
            .at_least(0)
            .otherwise("whole milk's, per mm");
        f.field("sigma_s", &Subsurface::sigma_s, "how much light is scattered per length")
            .at_least(0)
            .otherwise("whole milk's, per mm");
        f.field("reflectance", &Subsurface::reflectance,
                "fraction of the light beneath the border that comes out again")
            .in(0, 1);
        f.field("mfp", &Subsurface::mfp, "with reflectance: mean length between collisions")
            .above(0)
            .otherwise("1");
        f.field("scale", &Subsurface::scale, "factor on sigma_a and sigma_s, or else on mfp").above(0);
        f.field("g", &Subsurface::g,
                "mean cosine of the angle by which light is scattered; 0 for matter with a name")
            .in(-0.99, 0.99);
        f.field("eta", &Subsurface::eta, "index of refraction inside over outside").at_least(1);
        Roughness::describe(f, &Subsurface::rough);
        Roughness::describe_remap(f);
        Relief::describe(f);
        f.example("milk", {});
        f.example("skin", {make_string("name", "Skin1"), make_float("scale", 10), make_float("eta", 1.4f),
                           make_float("roughness", 0.1f)});
        f.example("wax", {make_rgb("reflectance", 0.9f, 0.7f, 0.4f), make_float("mfp", 0.05f),
                          make_float("g", 0.5f)});
    }

    void finish(const Node& node, BuildContext& context) {
        choose_source(node, context);
        if (!name.empty())
            use_name(node, context);
        else if (!sigma_a && !reflectance)
            use_preset({{2.55f, 3.21f, 3.77f}, {0.0011f, 0.0024f, 0.014f}});
        table = shared_tables(context)->diffusion(g, eta);
    }

    bool needs_parameters() const override {
        auto varies = [](const auto& texture) { return texture && !texture->is_constant(); };
        return rough.needs_parameters() || varies(sigma_a) || varies(sigma_s) || varies(reflectance) ||
               varies(mfp);
    }
    Bsdf* at(const Hit& hit, Wavelengths&, Arena& arena) const override {
        return arena.make<DielectricBsdf>(rough.facets(TexturePoint(hit), remaproughness), eta);
    }

    bool has_subsurface() const override { return true; }
    const Bssrdf* subsurface(const Hit& hit, const Wavelengths& lambda, Arena& arena) const override {
        const TexturePoint point(hit);
        if (sigma_a)
            return arena.make<Bssrdf>(*table, clamp(sigma_a->eval(point, lambda) * scale, 0, infinity),
                                      clamp(sigma_s->eval(point, lambda) * scale, 0, infinity), lambda);
        const Spectrum albedo =
            map(reflectance->eval(point, lambda), [&](float r) { return table->albedo_for(r); });
        // Textures may have no light spread at all, which would take infinite coefficients.
        const Spectrum sigma_t =
            1.0f / clamp((mfp ? mfp->eval(point, lambda) : Spectrum(1)) * scale, 1e-12f, infinity);
        return arena.make<Bssrdf>(*table, (1.0f - albedo) * sigma_t, albedo * sigma_t, lambda);
    }

  private:
    /// Says what is given twice or by half.
    void choose_source(const Node& node, BuildContext& context) const {
        auto error = [&](const char* at, const std::string& text) {
            context.messages.add_error(node.find(at)->place, "material \"subsurface\" " + text);
        };
        auto exclude = [&](const char* chosen, std::initializer_list<const char*> others) {
            for (const char* other : others)
                if (node.find(other))
                    error(other,
                          fmt::format("has both \"{}\" and \"{}\"; it takes one of them", chosen, other));
        };
        if (!name.empty()) return exclude("name", {"sigma_a", "sigma_s", "reflectance", "mfp"});
        if (sigma_a && !sigma_s) error("sigma_a", "has \"sigma_a\", but not \"sigma_s\"");
        if (sigma_s && !sigma_a) error("sigma_s", "has \"sigma_s\", but not \"sigma_a\"");
        if (sigma_a) return exclude("sigma_a", {"reflectance", "mfp"});
        if (mfp && !reflectance && !sigma_s) error("mfp", "has \"mfp\", but not \"reflectance\"");
    }
    void use_name(const Node& node, BuildContext& context) {
        if (const Parameter* p = node.find("g"); p && g != 0)
            context.messages.add_warning(p->place, "\"g\" is ignored, since the coefficients of \"name\" are "
                                                   "those of even scattering");
        g = 0;
        if (auto found = find_medium_preset(*node.find("name"), name, context)) use_preset(*found);
    }
    void use_preset(const MediumPreset& preset) {
        sigma_a = UnboundedTexture(SpectrumValue::unbounded_rgb(srgb_space(), preset.sigma_a));
        sigma_s = UnboundedTexture(SpectrumValue::unbounded_rgb(srgb_space(), preset.sigma_s));
    }
};

} // namespace

Kind<Material> subsurface_material() {
    return make_kind<Material, Subsurface>("subsurface");
}

} // namespace alhazen
