/// Participating media: matter spread through space (fog, smoke, milk) that absorbs light, scatters it and
/// may glow by itself. Media are tracked by fictitious collisions: along a ray, a bound of the density (the
/// majorant) is known cell by cell, tentative collisions are drawn from it, and what is really there decides
/// what each of them was (Woodcock et al. 1965; Pharr et al. 2023, section 11.4).
#pragma once

#include "base/hit.h"
#include "base/transform.h"
#include "color/wavelengths.h"
#include "describe/kind.h"
#include "math/phase.h"
#include "media/majorant_grid.h"

namespace alhazen {

/// Coefficients per unit length of the world, however the medium is scaled (as in pbrt-v4), and the radiance
/// that what absorbs there emits: sigma_a * Le per unit length.
struct MediumPoint {
    Spectrum sigma_a = 0, sigma_s = 0, Le = 0;
};

/// What a medium is made of, at the wavelengths of one path: per unit of density.
struct MediumColors {
    Spectrum sigma_a = 0, sigma_s = 0, Le = 0;
    Spectrum sigma_t() const { return sigma_a + sigma_s; }
};

struct Medium {
    static constexpr std::string_view family_name = "medium";
    virtual ~Medium() = default;

    virtual MediumColors colors(const Wavelengths& lambda) const = 0;
    /// What is at a point of the medium's own space; colors as it gave them. sigma_a + sigma_s is at most
    /// colors.sigma_t() times the majorant there.
    virtual MediumPoint at(Vec3 p, const MediumColors& colors, const Wavelengths& lambda) const = 0;
    virtual bool is_emissive() const = 0;

    /// Whether the same is everywhere: at() is what colors() says.
    bool is_homogeneous() const { return majorants_.is_everywhere(); }
    const MajorantGrid& majorants() const { return majorants_; }
    const HenyeyGreenstein& phase() const { return phase_; }
    /// From the world to the medium's own space.
    Ray to_medium(const Ray& ray) const { return world_from_medium_.inverse_ray(ray); }
    Bounds3 to_medium(const Bounds3& box) const {
        Bounds3 around;
        for (int i = 0; i < 8; ++i) around.extend(world_from_medium_.inverse_point(box.corner(i)));
        return around;
    }

    float scale = 1;
    float g = 0;

  protected:
    template <class T>
    static void describe_common(Fields<T>& f) {
        f.field("scale", &T::scale, "factor on sigma_a and sigma_s").at_least(0);
        f.field("g", &T::g,
                "mean cosine of the angle by which light is scattered: 0 evenly, towards 1 straight on, "
                "towards -1 back")
            .in(-1, 1);
    }
    MajorantGrid majorants_;
    HenyeyGreenstein phase_;
    Transform world_from_medium_;
};

/// What is on the two sides of a surface; nullptr: nothing.
struct MediumInterface {
    const Medium* inside = nullptr; ///< on the side that the normal points away from
    const Medium* outside = nullptr;

    bool is_border() const { return inside != outside; }
};

/// The medium of a ray that leaves the hit along d, having come through `current`: a surface that is no
/// border of media lies within one.
inline const Medium* medium_beyond(const Hit& hit, Vec3 d, const Medium* current) {
    if (!hit.media) return current;
    return dot(d, hit.ng) > 0 ? hit.media->outside : hit.media->inside;
}

/// Parameter "type" of MakeNamedMedium; context.world_from_node places them, context.grid_reader reads files.
const KindList<Medium>& medium_kinds();

} // namespace alhazen
