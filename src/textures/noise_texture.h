/// A base of textures whose value is a number made of noise in space.
#pragma once

#include "textures/noise.h"
#include "textures/texture_node.h"

namespace alhazen {

/// How wide a pixel is at the point, in texture space; 0 where it is not known.
inline float pixel_width(const TexturePoint& at, const Transform& texture_from_world) {
    if (!at.hit || !at.hit->cone) return 0;
    const PixelCone::Ellipse ellipse = at.hit->cone->on_surface(at.p, at.ng);
    return std::max(length(texture_from_world.vector(ellipse.narrow)),
                    length(texture_from_world.vector(ellipse.wide)));
}

/// Noise::number(p, width) takes a point of texture space and the width of a pixel there. As a colour the
/// number is a grey, held between 0 and 1.
template <class Family, class Noise>
struct NoiseTexture : TextureNodeOf<Family, Noise> {
    Transform texture_from_world;

    void finish(const Node&, BuildContext& context) {
        texture_from_world = context.world_from_node.inverse();
    }

    float value(const TexturePoint& at) const {
        return static_cast<const Noise*>(this)->number(texture_from_world.point(at.p),
                                                       pixel_width(at, texture_from_world));
    }
    Spectrum value(const TexturePoint& at, const Wavelengths&) const {
        return Spectrum(std::clamp(value(at), 0.0f, 1.0f));
    }
};

/// Octaves of noise, and how much weaker each is than the one before.
template <class Family, class Noise>
struct OctavesTexture : NoiseTexture<Family, Noise> {
    int octaves = 8;
    float roughness = 0.5f;

  protected:
    static void describe_octaves(Fields<Noise>& f) {
        f.field("octaves", &Noise::octaves, "how many frequencies, each about twice the one before")
            .in(1, 64);
        f.field("roughness", &Noise::roughness, "strength of each frequency over that of the one before")
            .in(0, 1);
        f.example("coarse", {make_integer("octaves", 2)});
        f.example("fine", {make_float("roughness", 0.8f)});
    }
};

} // namespace alhazen
