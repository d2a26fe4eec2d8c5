/// From points on surfaces to texture coordinates (s, t): by the surface's own parameters, or by projecting
/// the point from a sphere, a cylinder or a plane around the origin of texture space. As pbrt-v4 defines
/// them.
#pragma once

#include "describe/fields.h"
#include "textures/parameter_step.h"
#include "textures/texture.h"

namespace alhazen {

enum class MappingKind { uv, spherical, cylindrical, planar };
template <>
struct EnumNames<MappingKind> {
    static constexpr std::array names{"uv", "spherical", "cylindrical", "planar"};
};

/// What a pixel covers in texture coordinates: an ellipse with these axes, each as long as the pixel is wide.
struct TextureFootprint {
    Vec2 a, b;
};

/// A base of textures that vary over two coordinates.
struct TextureMapping {
    MappingKind mapping = MappingKind::uv;
    float uscale = 1, vscale = 1;
    float udelta = 0, vdelta = 0;
    Vec3 v1{1, 0, 0}, v2{0, 1, 0};
    Transform texture_from_world;

    template <class T>
    static void describe_mapping(Fields<T>& f) {
        f.field("mapping", &T::mapping, "how points become texture coordinates");
        f.field("uscale", &T::uscale, "uv: factor of u");
        f.field("vscale", &T::vscale, "uv: factor of v");
        f.field("udelta", &T::udelta, "uv and planar: added to u");
        f.field("vdelta", &T::vdelta, "uv and planar: added to v");
        f.field("v1", &T::v1,
                "planar: the first coordinate is the dot product with this vector, in texture space");
        f.field("v2", &T::v2, "planar: the same for the second coordinate");
    }
    void place(const BuildContext& context) { texture_from_world = context.world_from_node.inverse(); }

    Vec3 texture_point(const TexturePoint& at) const { return texture_from_world.point(at.p); }
    Vec2 map(const TexturePoint& at) const {
        switch (mapping) {
        case MappingKind::uv:
            break;
        case MappingKind::spherical:
            return map_spherical(texture_point(at));
        case MappingKind::cylindrical:
            return map_cylindrical(texture_point(at));
        case MappingKind::planar: {
            Vec3 p = texture_point(at);
            return {udelta + dot(p, v1), vdelta + dot(p, v2)};
        }
        }
        return {uscale * at.uv.x + udelta, vscale * at.uv.y + vdelta};
    }

    /// Zero where it is not known.
    TextureFootprint footprint(const TexturePoint& at) const {
        if (!at.hit || !at.hit->cone) return {};
        const PixelCone::Ellipse ellipse = at.hit->cone->on_surface(at.p, at.ng);
        return {step(at, ellipse.narrow), step(at, ellipse.wide)};
    }

    /// s: angle from +z over pi; t: angle about z from +x over 2 pi, 0 to 1.
    static Vec2 map_spherical(Vec3 p) {
        float theta = std::atan2(std::hypot(p.x, p.y), p.z);
        float phi = std::atan2(p.y, p.x);
        return {theta * inv_pi, (phi < 0 ? phi + 2 * pi : phi) * (inv_pi / 2)};
    }
    /// s: angle about z from -x over 2 pi; t: z.
    static Vec2 map_cylindrical(Vec3 p) { return {(pi + std::atan2(p.y, p.x)) * (inv_pi / 2), p.z}; }

  private:
    /// How the coordinates change when the point moves by d over the surface.
    Vec2 step(const TexturePoint& at, Vec3 d) const {
        switch (mapping) {
        case MappingKind::uv:
            break;
        case MappingKind::planar: {
            const Vec3 moved = texture_from_world.vector(d);
            return {dot(moved, v1), dot(moved, v2)};
        }
        case MappingKind::spherical:
            return difference(map_spherical, texture_point(at), texture_from_world.vector(d), 1);
        case MappingKind::cylindrical:
            return difference(map_cylindrical, texture_point(at), texture_from_world.vector(d), 0);
        }
        const Vec2 duv = parameter_step(*at.hit, d);
        return {uscale * duv.x, vscale * duv.y};
    }
    /// By a tenth of the way; one coordinate is an angle, 0 again at 1.
    template <class Map>
    static Vec2 difference(Map map, Vec3 p, Vec3 d, int angle) {
        constexpr float part = 0.1f;
        Vec2 change = map(p + d * part) - map(p);
        float& turned = angle == 0 ? change.x : change.y;
        turned -= std::round(turned);
        return change * (1 / part);
    }
};

} // namespace alhazen
