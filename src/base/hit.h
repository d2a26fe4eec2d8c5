/// A point on a surface, as seen by a ray: all that materials, textures, lights and integrators may know of
/// it.
#pragma once

#include "base/frame.h"
#include "base/pixel_cone.h"
#include "base/ray.h"

namespace alhazen {

struct Material;        // materials/material.h
struct Light;           // lights/light.h
struct MediumInterface; // media/medium.h

/// A ray's shadow test stops this fraction short of the light, so that the light's own surface does not
/// count.
inline constexpr float shadow_epsilon = 1e-4f;

/// Plain data in world space. Directions are unit length.
struct Hit {
    Vec3 p;          ///< the point
    Vec3 p_error;    ///< bound of its absolute error, per axis
    Vec3 wo;         ///< towards where the ray came from
    Vec3 ng;         ///< geometric normal; points out of the surface (see Shape), not necessarily towards wo
    Vec3 ns;         ///< shading normal, on the same side as ng
    Vec3 dpdu, dpdv; ///< tangents of the shading surface; not unit length
    Vec2 uv;         ///< surface parameters
    float t = 0;     ///< along the ray
    float time = 0;
    std::uint32_t shape = 0;     ///< number of the shape in its object
    std::uint32_t primitive = 0; ///< number of the triangle, patch ... in the shape
    std::uint32_t instance = 0;  ///< 0 for the scene's own shapes, else the instance's number + 1
    const Material* material = nullptr;
    const Light* area_light = nullptr;
    const MediumInterface* media = nullptr; ///< where the surface is a border between media
    const PixelCone* cone = nullptr;        ///< what textures blur over; nullptr: nothing

    /// z = ns, x along dpdu: the frame BSDFs live in.
    Frame shading_frame() const { return Frame::from_z_and_tangent(ns, dpdu); }
    /// A ray from the surface along d.
    Ray spawn(Vec3 d) const { return {offset_origin(p, p_error, ng, d), d, infinity, time}; }
    /// A ray from the surface to a point q (known to within +-q_error) on a surface with normal nq (zero when
    /// q is not on a surface): t = 1 is at q, and tmax stops just before.
    Ray spawn_to(Vec3 q, Vec3 q_error, Vec3 nq) const {
        Vec3 from = offset_origin(p, p_error, ng, q - p);
        Vec3 to = offset_origin(q, q_error, nq, from - q);
        return {from, to - from, 1 - shadow_epsilon, time};
    }
};

/// How the unit shading normal changes along u and v: zero where the surface is flat.
struct NormalChange {
    Vec3 dndu, dndv;
};

} // namespace alhazen
