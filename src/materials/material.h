/// Materials: what the user edits. at() looks every texture up once and returns the BSDF of that point.
#pragma once

#include <vector>

#include "base/arena.h"
#include "base/hit.h"
#include "describe/kind.h"
#include "materials/bsdf.h"
#include "materials/relief.h"
#include "textures/texture.h"

namespace alhazen {

struct Bssrdf; // materials/bssrdf.h
struct Material;

/// A material that shows at a point, and how much of the light there is its.
struct MaterialShare {
    const Material* material;
    float share;
};

struct Material {
    static constexpr std::string_view family_name = "material";
    virtual ~Material() = default;

    /// The BSDF at the hit, made in the arena; nullptr where the surface is only a border between media,
    /// which light crosses as if it were not there. A material whose index of refraction varies with the
    /// wavelength terminates lambda's secondary wavelengths.
    virtual Bsdf* at(const Hit& hit, Wavelengths& lambda, Arena& arena) const = 0;
    /// How light spreads beneath the surface that is refracted into it at the hit; nullptr where it just goes
    /// on. Made in the arena.
    virtual const Bssrdf* subsurface(const Hit&, const Wavelengths&, Arena&) const { return nullptr; }
    /// Whether subsurface() may give anything else.
    virtual bool has_subsurface() const { return false; }
    /// Whether at() or choose() look at the hit's uv, or at() distinguishes directions along the surface.
    /// Where not, hits may come without uv and tangents.
    virtual bool needs_parameters() const { return true; }
    /// True when at() always returns nullptr.
    virtual bool is_interface() const { return false; }
    /// Whether choose() may give a material that is_interface().
    virtual bool may_be_interface() const { return is_interface(); }
    /// True when at() returns the same BSDF for every hit in RGB mode.
    virtual bool is_uniform() const { return false; }
    /// The material in effect at the hit: itself, or one of those it mixes.
    virtual const Material* choose(const Hit&) const { return this; }
    /// True when choose() may give another one.
    virtual bool is_mixture() const { return false; }
    /// Appends what choose() gives around the hit, each with its part of `share`; none of them is a mixture.
    /// What has a small part of the whole may stand for others.
    virtual void add_shares(const Hit&, float share, std::vector<MaterialShare>& shares) const {
        shares.push_back({this, share});
    }
    /// Whether the relief of some material in effect may turn the shading normal.
    virtual bool has_relief() const { return !relief.is_flat(); }

    /// Applied by the scene when it makes a hit.
    Relief relief;
};

const KindList<Material>& material_kinds();

} // namespace alhazen
